"""The numbers that people see, each defined once: errors of joints, of the hand, along time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from studio.engine.arms import Arms, sides_of
from studio.engine.hands import HandTrack
from studio.engine.performance import Performance, joint_columns, whole_body
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE, load_robot
from studio.engine.skeleton import FloatArray, Side


@dataclass(frozen=True, eq=False)
class Deviation:
    """How far a measured performance is from the commands that it should follow."""

    joint_rmse: FloatArray  # (D,) [rad]
    hand_mean: float  # [m] mean distance at equal times
    hand_max: float  # [m]
    hand_dtw: float  # [m] mean distance along the best warping of time


def deviation(
    performance: Performance,
    rows: FloatArray,
    joints: tuple[str, ...],
    hands: HandTrack | None = None,
) -> Deviation:
    """Compare what was measured with ``rows`` (T, D) [rad], at the T stamps over the duration.

    The hand is the origin of the link ``left_hand`` or ``right_hand``; of both arms, both hands
    count alike. Wrists are meant to be where ``hands`` have them, without that at zero.
    """
    stamps = np.linspace(0.0, performance.duration, len(rows))
    meant = body_as_meant(rows, joints, performance.arms, performance.duration, hands)
    return deviation_between(performance.measured_at(stamps), meant, joints, performance.arms)


def body_as_meant(
    rows: FloatArray,
    joints: Sequence[str],
    arms: Arms,
    duration: float,
    hands: HandTrack | None,
) -> FloatArray:
    """Return all joints (T, 15) [rad] that rows (T, D) of some mean, evenly over ``duration`` [s].

    Wrists are where ``hands`` have them; all else that the rows lack is at zero.
    """
    body = whole_body(rows, joints)
    if hands is not None:
        wrists = joint_columns(hands.options.wrist_joints(arms))
        stamps = np.linspace(0.0, duration, len(rows))
        body[:, wrists] = [hands.at(stamp).wrist for stamp in stamps]
    return body


def deviation_between(
    measured: FloatArray, meant: FloatArray, joints: Sequence[str], arms: Arms
) -> Deviation:
    """Compare two motions of all joints (T, 15) [rad], row by row; see `deviation`."""
    columns = joint_columns(joints)
    error = measured[:, columns] - meant[:, columns]
    paths = [(hand_path(measured, side), hand_path(meant, side)) for side in sides_of(arms)]
    distance = np.array([np.linalg.norm(reached - intended, axis=1) for reached, intended in paths])
    return Deviation(
        joint_rmse=np.sqrt(np.mean(error**2, axis=0)),
        hand_mean=float(distance.mean()),
        hand_max=float(distance.max()),
        hand_dtw=float(np.mean([dtw_distance(*pair) for pair in paths])),
    )


def hand_acceleration(joint_positions: FloatArray, arms: Arms) -> float:
    """Return the hands' root mean square acceleration [m/s²], for joints (T, 15) [rad] at 30 Hz.

    By second differences, so that a jerky motion shows; NaN for fewer than three rows.
    """
    if len(joint_positions) < 3:
        return float("nan")
    bends = [np.diff(hand_path(joint_positions, side), 2, axis=0) for side in sides_of(arms)]
    squares = np.sum(np.square(bends), axis=-1)
    return float(np.sqrt(squares.mean())) * CONTROL_RATE**2


def acceleration_alone(performance: Performance) -> float:
    """Return that of the hands [m/s²] over a performance's motion, tick by tick."""
    count = motion_ticks(performance) + 1
    stamps = np.linspace(0.0, (count - 1) * CONTROL_PERIOD, count)
    return hand_acceleration(performance.measured_at(stamps), performance.arms)


def motion_ticks(performance: Performance) -> int:
    """Return how many ticks a performance's motion takes, the settling left out."""
    return round(performance.duration * CONTROL_RATE)


def hand_path(joint_positions: FloatArray, side: Side) -> FloatArray:
    """Return the hand's positions (T, 3) [m] in the base's frame, for joints (T, 15) [rad]."""
    poses = load_robot().forward_kinematics(f"{side}_hand", joint_positions)
    return poses[..., :3, 3]


def dtw_distance(a: FloatArray, b: FloatArray) -> float:
    """Return the mean distance of matched points along the best warping of two paths (T, d).

    Dynamic time warping (Sakoe and Chiba 1978, symmetric steps of weight 1): the path with the
    least summed distance, divided by its number of matches; among equal sums the shortest.
    """
    cost = cdist(a, b)
    best = [(0.0, 0)] + [(np.inf, 0)] * len(b)
    for row in cost.tolist():
        previous, best = best, [(np.inf, 0)]
        for j, distance in enumerate(row):
            total, matches = min(previous[j], previous[j + 1], best[j])
            best.append((total + distance, matches + 1))
    total, matches = best[-1]
    return float(total / matches)
