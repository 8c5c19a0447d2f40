"""From the directions of a human arm to Baxter's joint angles: two mappings, pure and total.

The rotation of each shoulder mount and the two joint offsets are Baxter's own, from Rethink
Robotics' description: shoulder to elbow (s1 to e1) is (0.36442, 0, -0.069) m, elbow to wrist
(e1 to w1) is (0.37429, 0, -0.010) m, and the mounts are yawed by ±0.7854 rad.
"""

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from studio.engine.errors import StudioError
from studio.engine.skeleton import FloatArray, Side
from studio.engine.vectors import Vector, cross, dot, norm, unit

Mapping = Literal["exact", "paper"]
MAPPINGS: tuple[Mapping, Mapping] = ("exact", "paper")
Angles = tuple[float, float, float, float]  # s0, s1, e0, e1 [rad]
DRIVEN_JOINTS = ("s0", "s1", "e0", "e1")
LEARNED_JOINTS: dict[Mapping, tuple[str, ...]] = {
    "exact": DRIVEN_JOINTS,
    "paper": ("s0", "s1", "e1"),
}
MEDIAN_PAPER_FOREARM_ERROR = math.radians(48)  # of the paper mapping, on real recordings

_MOUNT_YAW: dict[Side, float] = {"left": 0.7854, "right": -0.7854}  # the URDF's number, not π/4
# Worked out once: this runs for every frame.
_MOUNT = {side: (math.cos(yaw), math.sin(yaw)) for side, yaw in _MOUNT_YAW.items()}
_UPPER_ARM_OFFSET = math.atan2(0.069, 0.36442)
_OFFSET_COSINE, _OFFSET_SINE = math.cos(_UPPER_ARM_OFFSET), math.sin(_UPPER_ARM_OFFSET)
_FOREARM_OFFSET = math.atan2(0.010, 0.37429)


def arm_angles(
    upper_arm: ArrayLike, forearm: ArrayLike, side: Side, mapping: Mapping = "exact"
) -> FloatArray:
    """Return Baxter's joint angles for a human arm's directions, not yet brought inside the limits.

    Parameters
    ----------
    upper_arm, forearm : (3,)
        Directions shoulder to elbow and elbow to wrist, in the torso's frame (x forward, y left,
        z up). Their length does not matter.
    side : "left" or "right"
    mapping : "exact" or "paper"
        ``exact`` turns the lines between the robot's joint centers to the given directions.
        ``paper`` is the source paper's space vector approach (its Section II-E): e0 stays zero, and
        s0, s1, e1 follow shoulder yaw, shoulder pitch and elbow pitch, so that the joint axes
        match but the forearm swings in one plane only.

    Returns
    -------
    (4,)
        s0, s1, e0, e1 [rad].

    Raises
    ------
    StudioError
        Where a direction is not three finite numbers, is zero, or side or mapping is unknown.
    """
    if side not in _MOUNT_YAW or mapping not in MAPPINGS:
        raise StudioError(f"unknown side {side!r} or mapping {mapping!r}; see arm_angles")
    u, f = _direction(upper_arm, "upper_arm"), _direction(forearm, "forearm")
    return np.array(solve_arm(u, f, side, mapping))


def solve_arm(upper_arm: Vector, forearm: Vector, side: Side, mapping: Mapping) -> Angles:
    """Do as `arm_angles` does, on unit vectors and without checks: the live loop's version."""
    u, f = _into_mount(upper_arm, side), _into_mount(forearm, side)
    across = cross(u, f)
    normal = _plane_normal(u, across)
    opening = math.atan2(norm(across), dot(u, f))
    if mapping == "paper":
        s0, s1 = _shoulder(u)
        return (s0, s1, 0.0, opening)
    lifted = cross(normal, u)
    axis: Vector = (
        _OFFSET_COSINE * u[0] - _OFFSET_SINE * lifted[0],
        _OFFSET_COSINE * u[1] - _OFFSET_SINE * lifted[1],
        _OFFSET_COSINE * u[2] - _OFFSET_SINE * lifted[2],
    )
    s0, s1 = _shoulder(axis)
    return (s0, s1, _roll(normal, s0, s1), opening + _UPPER_ARM_OFFSET - _FOREARM_OFFSET)


def solve_elbow(forearm: Vector, side: Side, s0: float, s1: float) -> tuple[float, float] | None:
    """Return the (e0, e1) [rad] that point the forearm along ``forearm``, the shoulder fixed.

    None where the forearm lies along the upper arm's axis: e0 is anyone's choice then.
    """
    f = _into_mount(forearm, side)
    axis: Vector = (math.cos(s0) * math.cos(s1), math.sin(s0) * math.cos(s1), -math.sin(s1))
    product = cross(axis, f)
    normal = unit(product)
    if normal is None:
        return None
    return _roll(normal, s0, s1), math.atan2(norm(product), dot(axis, f)) - _FOREARM_OFFSET


def _shoulder(axis: Vector) -> tuple[float, float]:
    return math.atan2(axis[1], axis[0]), math.atan2(-axis[2], math.hypot(axis[0], axis[1]))


def _roll(normal: Vector, s0: float, s1: float) -> float:
    """Return e0: the angle of the elbow's axis about the upper arm, m = Ry(-s1) Rz(-s0) normal."""
    along = math.cos(s0) * normal[0] + math.sin(s0) * normal[1]
    m_y = -math.sin(s0) * normal[0] + math.cos(s0) * normal[1]
    m_z = math.sin(s1) * along + math.cos(s1) * normal[2]
    return math.atan2(m_z, m_y)


def _into_mount(vector: Vector, side: Side) -> Vector:
    cosine, sine = _MOUNT[side]
    x, y, z = vector
    return (cosine * x + sine * y, -sine * x + cosine * y, z)


def _plane_normal(u: Vector, across: Vector) -> Vector:
    """Return the arm's plane's unit normal, along u × f; of a straight arm, any plane's."""
    normal = unit(across) or _any_normal(u)
    # Of a nearly straight arm the cross product is mostly rounding, and may lean towards the arm.
    lean = dot(normal, u)
    across = (normal[0] - lean * u[0], normal[1] - lean * u[1], normal[2] - lean * u[2])
    return unit(across) or _any_normal(u)


def _any_normal(axis: Vector) -> Vector:
    """Return a unit vector across ``axis``: the elbow's axis where the arm is straight."""
    level = unit(cross((0.0, 0.0, 1.0), axis))
    return level if level is not None else (0.0, 1.0, 0.0)


def _direction(values: ArrayLike, name: str) -> Vector:
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise StudioError(f"{name} must be three finite numbers, not {values!r}")
    direction = unit((float(array[0]), float(array[1]), float(array[2])))
    if direction is None:
        raise StudioError(f"{name} has no length, so no direction")
    return direction
