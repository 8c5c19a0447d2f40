"""The demonstrator's body: a person's size and stance, and where all joints are in camera space."""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from studio.engine.skeleton import FRAME_RATE, JOINT_COUNT, FloatArray, Joint
from studio.engine.standing import (
    DISTANCE,
    FOREARM,
    SENSOR_TO_HIP,
    TO_HAND,
    TO_TIP,
    TRUNK,
    UPPER_ARM,
)


@dataclass(frozen=True)
class DemonstratorBody:
    """A person's size relative to 1.75 m, and how the person stands before the sensor."""

    scale: float
    offset: tuple[float, float]  # [m] to the side of the sensor's axis, and away from it
    yaw: float  # [rad]

    @classmethod
    def of(cls, rng: np.random.Generator) -> Self:
        """Return somebody of usual size, who stands about where one should."""
        scale, x, z, yaw = rng.normal(
            [1.0, 0.0, DISTANCE, 0.0], [0.04, 0.08, 0.08, math.radians(5)]
        )
        return cls(float(scale), (float(x), float(z)), float(yaw))


# The right arm while it hangs [m], in the torso's frame.
_RIGHT_ARM: dict[Joint, tuple[float, float, float]] = {
    Joint.ELBOW_RIGHT: (0.0, -0.24, 0.20),
    Joint.WRIST_RIGHT: (0.05, -0.27, -0.02),
    Joint.HAND_RIGHT: (0.07, -0.27, -0.09),
    Joint.HAND_TIP_RIGHT: (0.08, -0.27, -0.16),
    Joint.THUMB_RIGHT: (0.11, -0.24, -0.09),
}


def in_camera(
    body: DemonstratorBody, left: FloatArray, right: FloatArray | None, rng: np.random.Generator
) -> FloatArray:
    """Return all joints (T, 25, 3) [m] in camera space, the person swaying a little.

    ``left`` and ``right`` (T, 4) [rad] are the arms' angles; without ``right`` that arm hangs.
    """
    count = len(left)
    points = np.zeros((count, JOINT_COUNT, 3))
    for joint, point in (TRUNK | _RIGHT_ARM).items():
        points[:, joint] = point
    _hold_arm(points, left, "LEFT", 1.0)
    if right is not None:
        _hold_arm(points, right, "RIGHT", -1.0)
    phase = rng.uniform(0.0, 2.0 * math.pi, 2)
    clock = np.arange(count) / FRAME_RATE
    sway = np.radians(1.5) * np.sin(2.0 * math.pi * 0.2 * clock + phase[0])
    cosine, sine = np.cos(body.yaw + sway)[:, None], np.sin(body.yaw + sway)[:, None]
    forward = cosine * points[..., 0] - sine * points[..., 1]
    sideways = sine * points[..., 0] + cosine * points[..., 1]
    lean = 0.005 * np.sin(2.0 * math.pi * 0.15 * clock + phase[1])[:, None]
    return np.stack(
        [
            body.offset[0] - body.scale * sideways + lean,
            SENSOR_TO_HIP + body.scale * points[..., 2],
            body.offset[1] - body.scale * forward,
        ],
        axis=-1,
    )


def _hold_arm(points: FloatArray, angles: FloatArray, side: str, left: float) -> None:
    """Put the joints of one arm; ``left`` is 1 for the left one, -1 for the right one."""
    outward = np.array([1.0, left, 1.0])
    upper_arm = outward * direction(angles[:, 0], angles[:, 1])
    forearm = outward * direction(angles[:, 2], angles[:, 3])
    elbow = points[:, Joint[f"SHOULDER_{side}"]] + UPPER_ARM * upper_arm
    wrist = elbow + FOREARM * forearm
    points[:, Joint[f"ELBOW_{side}"]], points[:, Joint[f"WRIST_{side}"]] = elbow, wrist
    points[:, Joint[f"HAND_{side}"]] = wrist + TO_HAND * forearm
    points[:, Joint[f"HAND_TIP_{side}"]] = wrist + TO_TIP * forearm
    thumb = outward * np.array([0.0, -0.03, 0.03])
    points[:, Joint[f"THUMB_{side}"]] = wrist + TO_HAND * forearm + thumb


def direction(elevation: ArrayLike, azimuth: ArrayLike) -> FloatArray:
    """Return unit vectors (..., 3) for an elevation above level and an azimuth, both [rad]."""
    up, outward = np.asarray(elevation, dtype=float), np.asarray(azimuth, dtype=float)
    return np.stack(
        [np.cos(up) * np.cos(outward), np.cos(up) * np.sin(outward), np.sin(up)], axis=-1
    )
