"""Where Baxter's hand is to be, and how a person holds an arm so that it gets there.

In the exact mapping Baxter's upper arm and forearm point where the person's do. So a pose of the
person's arm is sought as one of Baxter's: its four joints reach a point with the hand, and the
forearm has a tilt, or the hand a heading; Gauss-Newton with damping, from the pose before.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from studio.engine.arms import driven_joints
from studio.engine.errors import StudioError
from studio.engine.retarget import arm_angles
from studio.engine.robot import BASE_HEIGHT, JOINT_NAMES, Robot, load_robot
from studio.engine.scene_parts import Triple
from studio.engine.skeleton import FloatArray
from studio.engine.sources.demonstrator_body import direction
from studio.engine.wrist import AT_REST, WRIST_JOINTS, Wrist

_WRIST_TO_HAND = 0.115975 + 0.11355  # [m] w1 to w2 and on to the hand's link (urdf/baxter.urdf)
_LIFTED = np.array([0.0, 0.0, BASE_HEIGHT])
_STEP = 1e-6  # [rad] for the differences
_DAMPING, _LONGEST = 1e-5, 0.2  # Levenberg's term; [rad] a joint in one iteration at most
_ITERATIONS = 80
_TURNING = 0.3  # [m/rad] how much the tilt counts beside the place
CLOSE_ENOUGH = 0.01  # [m]


@dataclass(frozen=True)
class ArmPose:
    """Where an arm points [deg]: elevation above level, azimuth outward from straight ahead."""

    upper_elevation: float
    upper_azimuth: float
    fore_elevation: float
    fore_azimuth: float

    @property
    def angles(self) -> FloatArray:
        """All four [deg]."""
        return np.array(
            [self.upper_elevation, self.upper_azimuth, self.fore_elevation, self.fore_azimuth]
        )


@dataclass(frozen=True)
class HandGoal:
    """A place for the left hand, or, with y reversed, for the right one."""

    point: Triple  # [m] of what is ``ahead`` of the hand's link, in the world
    turn: float  # [deg] the forearm's elevation, or of a level hand the azimuth where it points
    level: bool = False  # whether the wrist keeps the hand level
    ahead: float = 0.03  # [m] from the hand's link, along the hand
    care: float = 0.01  # [m] by which people miss it (standard deviation along each axis)

    def moved(self, by: FloatArray) -> Self:
        """Return the goal some way (3,) [m] off."""
        x, y, z = (np.array(self.point) + by).tolist()
        return type(self)((x, y, z), self.turn, self.level, self.ahead, self.care)


@dataclass(frozen=True, eq=False)
class Reacher:
    """Seeks poses of Baxter's left arm."""

    robot: Robot
    wrist: Wrist

    @classmethod
    def usual(cls) -> Self:
        """Return that of the studio's Baxter."""
        return cls(load_robot(), Wrist.for_robot(load_robot(), "left"))

    def seek(self, goal: HandGoal, joints: FloatArray) -> FloatArray:
        """Return the joints (4,) [rad] that reach a goal, from others near by.

        Raises
        ------
        StudioError
            Where the hand comes no nearer than 1 cm.
        """
        target = np.array([*goal.point, math.radians(goal.turn)])
        weights = np.array([1.0, 1.0, 1.0, _TURNING])
        lower, upper = self._limits
        for _ in range(_ITERATIONS):
            miss = (target - self.reached(joints, goal)) * weights
            found = self._nearly(np.vstack([joints, joints + _STEP * np.eye(4)]), goal)
            slope = ((found[1:] - found[0]) / _STEP).T * weights[:, None]
            square = slope @ slope.T + _DAMPING * np.eye(4)
            change = slope.T @ np.linalg.solve(square, miss)
            change *= min(1.0, _LONGEST / max(float(np.abs(change).max()), _STEP))
            joints = np.clip(joints + change, lower, upper)
            if float(np.abs(change).max()) < _STEP:
                break
        short = float(np.linalg.norm(self.reached(joints, goal)[:3] - target[:3]))
        if short > CLOSE_ENOUGH:
            x, y, z = goal.point
            raise StudioError(
                f"Baxter's hand does not reach x {x:.2f}, y {y:.2f}, z {z:.2f} m as the "
                f"demonstrator would have it: it is {100 * short:.0f} cm short. Put blocks and "
                "zones nearer, between x 0.55 and 0.85 m"
            )
        return joints

    def pose(self, joints: FloatArray) -> ArmPose:
        """Return how a person holds an arm that Baxter's, with these joints (4,), follows."""
        shoulder, elbow, wrist = self._points(joints[None])
        angles: list[float] = []
        for way in (elbow[0] - shoulder[0], wrist[0] - elbow[0]):
            x, y, z = (way / np.linalg.norm(way)).tolist()
            angles += [math.degrees(math.asin(z)), math.degrees(math.atan2(y, x))]
        return ArmPose(*angles)

    def joints(self, pose: ArmPose) -> FloatArray:
        """Return Baxter's joints (4,) [rad] while a person holds an arm so."""
        upper, fore = np.radians(pose.angles).reshape(2, 2)
        return arm_angles(direction(*upper), direction(*fore), "left")

    def reached(self, joints: FloatArray, goal: HandGoal) -> FloatArray:
        """Return where (4,) joints (4,) lead the hand: its place x, y, z [m] and its turn [rad]."""
        if not goal.level:
            return np.array(self._nearly(joints[None], goal)[0])
        body = self._body(joints[None])[0]
        s0, s1, e0, e1 = joints.tolist()
        body[self._wrists] = self.wrist.level((s0, s1, e0, e1), AT_REST)
        hand = self.robot.forward_kinematics("left_hand", body)
        point = hand[:3, 3] + goal.ahead * hand[:3, 2] + _LIFTED
        return np.array([*point, math.atan2(hand[1, 2], hand[0, 2])])

    def _nearly(self, joints: FloatArray, goal: HandGoal) -> FloatArray:
        """Return the same (N, 4) for many joints (N, 4); of a level hand only nearly."""
        _, elbow, wrist = self._points(joints)
        way = wrist - elbow
        if goal.level:
            azimuth = np.arctan2(way[:, 1], way[:, 0])
            ahead = np.stack([np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth], axis=-1)
            return np.column_stack([wrist + (_WRIST_TO_HAND + goal.ahead) * ahead, azimuth])
        hand = self.robot.forward_kinematics("left_hand", self._body(joints))
        point = hand[:, :3, 3] + goal.ahead * hand[:, :3, 2] + _LIFTED
        rise = way[:, 2] / np.linalg.norm(way, axis=1)
        return np.column_stack([point, np.arcsin(np.clip(rise, -1.0, 1.0))])

    def _points(self, joints: FloatArray) -> list[FloatArray]:
        """Return where (N, 3) [m] the axes s1, e1 and w1 are: the ends of upper arm and forearm."""
        body = self._body(joints)
        links = ("left_lower_shoulder", "left_lower_elbow", "left_lower_forearm")
        return [self.robot.forward_kinematics(each, body)[:, :3, 3] + _LIFTED for each in links]

    def _body(self, joints: FloatArray) -> FloatArray:
        body = np.zeros((len(joints), len(JOINT_NAMES)))
        body[:, self._columns] = joints
        return body

    @cached_property
    def _columns(self) -> list[int]:
        return [self.robot.joint_index(joint) for joint in driven_joints("left")]

    @cached_property
    def _wrists(self) -> list[int]:
        return [self.robot.joint_index(f"left_{joint}") for joint in WRIST_JOINTS]

    @cached_property
    def _limits(self) -> tuple[FloatArray, FloatArray]:
        limits = self.robot.limits_of(driven_joints("left"))
        return limits.lower, limits.upper
