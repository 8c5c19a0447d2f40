"""The wrist: at zero, held level, or turned to where the person's hand points.

Baxter's w0, w1 and w2 turn the hand about z, y and z in turn: R_base_hand = F Rz(w0) Ry(w1) Rz(w2),
where F is the forearm's rotation (of its link upper_forearm at w0 = 0). Two triples give the same
rotation, (w0, w1, w2) and (w0 + π, -w1, w2 + π). The one that is nearer to where the wrist is
counts, unless the limits keep it much shorter, so that the wrist does not swing round. Where the
hand lies along the forearm, w0 is anyone's choice and is held.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from studio.engine.human import TorsoFrame
from studio.engine.retarget import DRIVEN_JOINTS, Angles
from studio.engine.robot import Robot
from studio.engine.skeleton import FloatArray, Joint, Side, Skeleton, Tracking
from studio.engine.vectors import Vector, norm, subtract, unit

WristMode = Literal["zero", "level", "follow"]
WRIST_MODES: tuple[WristMode, ...] = ("zero", "level", "follow")
WRIST_JOINTS = ("w0", "w1", "w2")
WristAngles = tuple[float, float, float]  # w0, w1, w2 [rad]

AT_REST: WristAngles = (0.0, 0.0, 0.0)
SHORTEST_HAND = 0.02  # [m] from wrist to tip; a shorter one has no direction worth following
_STEEP = math.sin(math.radians(10))  # a forearm within 10° of the vertical has no heading to keep
_ALONG = math.sin(math.radians(5))  # of a hand within 5° of the forearm's line w0 is held
_SHORT = math.radians(30)  # by which a limit may keep the wrist short before it swings round
_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Wrist:
    """One wrist; build it by `for_robot`."""

    robot: Robot
    side: Side
    lower: FloatArray  # (3,) [rad]
    upper: FloatArray  # (3,) [rad]

    @classmethod
    def for_robot(cls, robot: Robot, side: Side) -> "Wrist":
        """Return a wrist with the robot's limits."""
        limits = robot.limits_of([f"{side}_{joint}" for joint in WRIST_JOINTS])
        return cls(robot, side, limits.lower, limits.upper)

    def level(self, arm: Angles, before: WristAngles) -> WristAngles:
        """Return what holds the hand level, pointing where the forearm heads.

        Level is the plane of the direction in which it points and of that in which its fingers
        open. Where the limits do not allow it, as near to it as they do; under a forearm that
        stands on end the wrist stays as it is.
        """
        forearm = self._forearm(arm)
        heading = forearm[:, 2] - forearm[2, 2] * _UP
        length = float(np.linalg.norm(heading))
        if length < _STEEP:
            return before
        pointing = heading / length
        found = []
        for up in (_UP, -_UP):  # fingers open to both sides alike
            hand = np.column_stack([up, np.cross(pointing, up), pointing])
            found += self._solutions(forearm.T @ hand, before)
        return self._nearest(found, before)

    def follow(self, arm: Angles, direction: Vector, before: WristAngles) -> WristAngles:
        """Return what points the hand along ``direction``, in the base's frame, without twisting.

        As near to it as the limits allow.
        """
        x, y, z = (self._forearm(arm).T @ np.array(direction)).tolist()
        across = math.hypot(x, y)
        if across < _ALONG:
            return self._nearest([(before[0], math.atan2(across, z), -before[0])], before)
        w0, w1 = math.atan2(y, x), math.atan2(across, z)
        turned = _opposite(w0)
        return self._nearest([(w0, w1, -w0), (turned, -w1, -turned)], before)

    def _forearm(self, arm: Angles) -> FloatArray:
        """Return the forearm's rotation (3, 3) at w0 = 0."""
        body = np.zeros(len(self.robot.joint_names))
        body[[self.robot.joint_index(f"{self.side}_{joint}") for joint in DRIVEN_JOINTS]] = arm
        T: FloatArray = self.robot.forward_kinematics(f"{self.side}_upper_forearm", body)
        return T[:3, :3]

    def _solutions(self, turn: FloatArray, before: WristAngles) -> list[WristAngles]:
        """Return both triples that turn the hand by ``turn`` (3, 3) against the forearm."""
        across = math.hypot(turn[0, 2], turn[1, 2])
        if across < _ALONG:
            return [self._along(turn, before[0])]
        w0, w1 = math.atan2(turn[1, 2], turn[0, 2]), math.atan2(across, turn[2, 2])
        w2 = math.atan2(turn[2, 1], -turn[2, 0])
        return [(w0, w1, w2), (_opposite(w0), -w1, _opposite(w2))]

    def _along(self, turn: FloatArray, w0: float) -> WristAngles:
        """Return the triple of a hand that lies almost along the forearm, with w0 held."""
        cosine, sine = math.cos(w0), math.sin(w0)
        tilt = math.atan2(cosine * turn[0, 2] + sine * turn[1, 2], turn[2, 2])
        whole = math.atan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
        return (w0, tilt, math.remainder(whole - w0, math.tau))

    def _nearest(self, found: list[WristAngles], before: WristAngles) -> WristAngles:
        """Return, inside the limits, the nearest triple that they do not keep much too short."""

        def cost(angles: WristAngles) -> tuple[float, float]:
            inside = np.clip(angles, self.lower, self.upper)
            short = float(np.abs(np.subtract(angles, inside)).max())
            return max(short - _SHORT, 0.0), float(np.abs(np.subtract(inside, before)).max())

        w0, w1, w2 = np.clip(min(found, key=cost), self.lower, self.upper).tolist()
        return (w0, w1, w2)


def turning_alike(angles: FloatArray, near: FloatArray) -> FloatArray:
    """Return w0, w1, w2 (..., 3) [rad] that turn the hand as ``angles`` do, nearest to ``near``.

    Without regard to the limits: by whole turns and to the other one of the two triples.
    """
    other = angles * (1.0, -1.0, 1.0) + (math.pi, 0.0, math.pi)
    found = np.stack([angles, other])
    for turning in (0, 2):
        apart = found[..., turning] - near[..., turning]
        found[..., turning] -= math.tau * np.round(apart / math.tau)
    far = np.sum((found - near) ** 2, axis=-1)
    nearest: FloatArray = np.where((far[0] <= far[1])[..., None], found[0], found[1])
    return nearest


def hand_direction(skeleton: Skeleton, side: Side, torso: TorsoFrame) -> Vector | None:
    """Return where a hand points in the torso's frame, from its wrist to its tip.

    None where one of the two is not tracked: inferred tips point anywhere.
    """
    wrist, tip = Joint.of("wrist", side), Joint.of("hand_tip", side)
    if min(skeleton.tracking[wrist], skeleton.tracking[tip]) < Tracking.TRACKED:
        return None
    (x, y, z), (a, b, c) = skeleton.positions[[wrist, tip]].tolist()
    way = subtract((a, b, c), (x, y, z))
    pointing = unit(way)
    return None if pointing is None or norm(way) < SHORTEST_HAND else torso.from_camera(pointing)


def _opposite(angle: float) -> float:
    """Return an angle half a turn away, within ±π."""
    return angle - math.copysign(math.pi, angle)
