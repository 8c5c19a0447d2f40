"""The demonstrator: a synthetic person who does the paper's task, for whoever has no Kinect.

The person signs Lasso, Open, Closed with the left hand, sweeps the left arm inward so that Baxter
pushes the block down, brings it back, and signs Lasso to end. Every take differs a little in
timing, height and speed, as in the paper's Fig. 9, and a sensor's faults are laid over it
(`studio.engine.sources.sensor_faults`). What comes out are skeletons like any others.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.skeleton import FRAME_RATE, JOINT_COUNT, FloatArray, HandState, Joint
from studio.engine.sources.recording import SkeletonRecording, from_skeletons
from studio.engine.sources.sensor_faults import sense
from studio.engine.standing import (
    DISTANCE,
    FOREARM,
    SENSOR_TO_HIP,
    TO_HAND,
    TO_TIP,
    TRUNK,
    UPPER_ARM,
)

FULL_SEQUENCE = (HandState.LASSO, HandState.OPEN, HandState.CLOSED)


@dataclass(frozen=True)
class ArmPose:
    """Where the left arm points [deg]: elevation above level, azimuth to the left of forward."""

    upper_elevation: float
    upper_azimuth: float
    fore_elevation: float
    fore_azimuth: float


@dataclass(frozen=True)
class Phase:
    """A stretch of the performance: the pose it ends in, its length [s], the left hand's state."""

    pose: ArmPose
    seconds: float
    hand: HandState


REST = ArmPose(-50.0, 60.0, -60.0, 30.0)
READY = ArmPose(20.0, 45.0, -48.0, 15.0)
SWEPT = ArmPose(20.0, -20.0, -48.0, -50.0)


def demonstrate(
    seed: int, take: int = 1, signs: Sequence[HandState] = FULL_SEQUENCE
) -> SkeletonRecording:
    """Return one performance as a sensor would see it: about thirteen seconds of skeletons.

    Parameters
    ----------
    seed : int
        The person and the day; the same seed and take give the same bytes.
    take : int
        Which performance, counted from 1.
    signs : sequence of HandState
        What the left hand signs before the arm moves; anything but Lasso, Open, Closed never arms.

    Raises
    ------
    StudioError
        Where seed or take is below zero.
    """
    if seed < 0 or take < 0:
        raise StudioError(f"the demonstrator's seed and take are 0 or more, not {seed} and {take}")
    rng = np.random.default_rng([seed, take])
    phases = _vary(_script(signs), rng)
    times = np.arange(0.0, sum(phase.seconds for phase in phases), 1.0 / FRAME_RATE)
    poses = _poses(phases, times)
    positions = _in_camera(_Body.of(rng), poses, rng)
    ends = np.cumsum([phase.seconds for phase in phases])
    hands = [phases[min(int(np.searchsorted(ends, t)), len(phases) - 1)].hand for t in times]
    return from_skeletons(
        sense(positions, hands, rng),
        path=f"demonstrator:{take}",
        format=f"demonstrator, seed {seed}",
    )


def _script(signs: Sequence[HandState]) -> list[Phase]:
    """Return the paper's task: sign, push the block down, return to where it began."""
    last = signs[-1] if signs else HandState.OPEN
    return [
        Phase(REST, 0.5, HandState.OPEN),
        Phase(READY, 1.2, HandState.OPEN),
        *(Phase(READY, 1.2, sign) for sign in signs),
        Phase(SWEPT, 2.2, last),
        Phase(SWEPT, 0.4, last),
        Phase(READY, 2.2, last),
        Phase(READY, 0.4, last),
        Phase(READY, 1.6, HandState.LASSO),
        Phase(REST, 1.2, HandState.OPEN),
    ]


def _vary(phases: Sequence[Phase], rng: np.random.Generator) -> list[Phase]:
    """Return the script as a person would do it this time: a few percent and degrees off."""
    pace = rng.normal(1.0, 0.04)
    drift = {pose: ArmPose(*_off(pose, rng)) for pose in (REST, READY, SWEPT)}
    return [
        Phase(
            drift[phase.pose],
            phase.seconds * float(np.clip(rng.normal(pace, 0.04), 0.85, 1.15)),
            phase.hand,
        )
        for phase in phases
    ]


def _off(pose: ArmPose, rng: np.random.Generator) -> list[float]:
    spread = np.array([1.5, 2.5, 1.5, 3.0])  # [deg]
    exact = np.array(
        [pose.upper_elevation, pose.upper_azimuth, pose.fore_elevation, pose.fore_azimuth]
    )
    varied: list[float] = (exact + spread * np.clip(rng.normal(size=4), -2.0, 2.0)).tolist()
    return varied


def _poses(phases: Sequence[Phase], times: FloatArray) -> FloatArray:
    """Return the four angles [rad] at each time (T, 4), by minimum jerk from pose to pose."""
    ends = np.cumsum([phase.seconds for phase in phases])
    starts = np.concatenate([[0.0], ends[:-1]])
    keys = np.radians(
        [
            [p.upper_elevation, p.upper_azimuth, p.fore_elevation, p.fore_azimuth]
            for p in (phases[0].pose, *(phase.pose for phase in phases))
        ]
    )
    index = np.minimum(np.searchsorted(ends, times, side="right"), len(phases) - 1)
    s = np.clip((times - starts[index]) / (ends - starts)[index], 0.0, 1.0)[:, None]
    blend = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    between: FloatArray = keys[index] * (1.0 - blend) + keys[index + 1] * blend
    return between


@dataclass(frozen=True)
class _Body:
    """A person's size relative to 1.75 m, and how the person stands before the sensor."""

    scale: float
    offset: tuple[float, float]  # [m] to the side of the sensor's axis, and away from it
    yaw: float  # [rad]

    @classmethod
    def of(cls, rng: np.random.Generator) -> "_Body":
        scale, x, z, yaw = rng.normal(
            [1.0, 0.0, DISTANCE, 0.0], [0.04, 0.08, 0.08, math.radians(5)]
        )
        return cls(float(scale), (float(x), float(z)), float(yaw))


# The right arm, which hangs [m], in the torso's frame.
_RIGHT_ARM: dict[Joint, tuple[float, float, float]] = {
    Joint.ELBOW_RIGHT: (0.0, -0.24, 0.20),
    Joint.WRIST_RIGHT: (0.05, -0.27, -0.02),
    Joint.HAND_RIGHT: (0.07, -0.27, -0.09),
    Joint.HAND_TIP_RIGHT: (0.08, -0.27, -0.16),
    Joint.THUMB_RIGHT: (0.11, -0.24, -0.09),
}


def _in_camera(body: _Body, poses: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Return all joints (T, 25, 3) [m] in camera space, the person swaying a little."""
    count = len(poses)
    points = np.zeros((count, JOINT_COUNT, 3))
    for joint, point in (TRUNK | _RIGHT_ARM).items():
        points[:, joint] = point
    upper_arm, forearm = _direction(poses[:, 0], poses[:, 1]), _direction(poses[:, 2], poses[:, 3])
    elbow = points[:, Joint.SHOULDER_LEFT] + UPPER_ARM * upper_arm
    wrist = elbow + FOREARM * forearm
    points[:, Joint.ELBOW_LEFT], points[:, Joint.WRIST_LEFT] = elbow, wrist
    points[:, Joint.HAND_LEFT] = wrist + TO_HAND * forearm
    points[:, Joint.HAND_TIP_LEFT] = wrist + TO_TIP * forearm
    points[:, Joint.THUMB_LEFT] = wrist + TO_HAND * forearm + (0.0, -0.03, 0.03)
    phase = rng.uniform(0.0, 2.0 * math.pi, 2)
    clock = np.arange(count) / FRAME_RATE
    sway = np.radians(1.5) * np.sin(2.0 * math.pi * 0.2 * clock + phase[0])
    cosine, sine = np.cos(body.yaw + sway)[:, None], np.sin(body.yaw + sway)[:, None]
    forward = cosine * points[..., 0] - sine * points[..., 1]
    left = sine * points[..., 0] + cosine * points[..., 1]
    lean = 0.005 * np.sin(2.0 * math.pi * 0.15 * clock + phase[1])[:, None]
    return np.stack(
        [
            body.offset[0] - body.scale * left + lean,
            SENSOR_TO_HIP + body.scale * points[..., 2],
            body.offset[1] - body.scale * forward,
        ],
        axis=-1,
    )


def _direction(elevation: FloatArray, azimuth: FloatArray) -> FloatArray:
    return np.stack(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ],
        axis=-1,
    )
