"""Where the next command leads: limits at a share of the speed, then the guard, always both."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from studio.engine.arms import Arms, sides_of
from studio.engine.fingers import OPEN
from studio.engine.guard import Guard
from studio.engine.limits import Command, Limits
from studio.engine.links.link import Range
from studio.engine.links.wanted import Wanted
from studio.engine.robot import JOINT_NAMES, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray

START_SPEED = 0.15  # [rad/s] of the fastest joint on the way to the start pose
_ELSEWHERE = 0.03  # [rad] that a joint may move which is not driven, before the guard looks anew


@dataclass(frozen=True, eq=False)
class Way:
    """The driven arms' joints (D,), seven each, and what holds for them."""

    arms: Arms
    joints: tuple[str, ...]
    limits: Limits  # those of robot and studio, whichever is narrower, at full speed
    guard: Guard
    scene: Scene
    gripper: bool

    @classmethod
    def of(cls, wanted: Wanted, measured: FloatArray, own: Mapping[str, Range]) -> "Way":
        """Return the way of the wanted arms while the rest stays as ``measured`` (15,) [rad].

        ``own`` are the robot's own position limits [rad], where it tells any.
        """
        robot = load_robot()
        joints = tuple(name for side in sides_of(wanted.arms) for name in robot.arm_joints(side))
        ours = robot.limits_of(joints)
        lower = [max(low, own.get(name, (low, 0.0))[0]) for name, low in _pairs(joints, ours.lower)]
        upper = [min(up, own.get(name, (0.0, up))[1]) for name, up in _pairs(joints, ours.upper)]
        limits = Limits(np.array(lower), np.array(upper), ours.velocity)
        guard = _guard(wanted.scene, wanted.gripper, measured, joints)
        return cls(wanted.arms, joints, limits, guard, wanted.scene, wanted.gripper)

    @property
    def columns(self) -> list[int]:
        """Where the joints stand among all fifteen."""
        return [JOINT_NAMES.index(name) for name in self.joints]

    def fits(self, wanted: Wanted) -> bool:
        """Tell whether arms, scene and hands are still those that it was made for."""
        same_scene = wanted.scene is self.scene or wanted.scene == self.scene
        return wanted.arms == self.arms and same_scene and wanted.gripper == self.gripper

    def beside(self, measured: FloatArray) -> "Way":
        """Return the way with the guard's view of what is not driven brought up to date."""
        known = _whole(measured)
        moved = np.abs(known - self.guard.rest[: len(known)])
        moved[self.columns] = 0.0
        if moved.max() <= _ELSEWHERE:
            return self
        return replace(self, guard=_guard(self.scene, self.gripper, measured, self.joints))

    def step(self, sent: FloatArray, target: FloatArray, ratio: float, elapsed: float) -> Command:
        """Return what is sent ``elapsed`` [s] after ``sent`` (D,), towards ``target`` [rad]."""
        capped = replace(self.limits, velocity=ratio * self.limits.velocity)
        return self.guard.keep(sent, capped.step(sent, target, elapsed), elapsed)

    def start_step(
        self, sent: FloatArray, goal: FloatArray, ratio: float, elapsed: float
    ) -> Command:
        """Return the same at the start's speed, all joints the same share of a straight line."""
        gap = float(np.abs(goal - sent).max())
        share = min(1.0, START_SPEED * elapsed / gap) if gap else 1.0
        return self.step(sent, sent + share * (goal - sent), ratio, elapsed)

    def within(self, positions: FloatArray) -> FloatArray:
        """Return the driven joints (D,) of all (15,) [rad], inside the limits."""
        inside: FloatArray = np.clip(positions[self.columns], self.limits.lower, self.limits.upper)
        return inside


def _pairs(joints: tuple[str, ...], values: FloatArray) -> list[tuple[str, float]]:
    return list(zip(joints, values.tolist(), strict=True))


def _guard(scene: Scene, gripper: bool, measured: FloatArray, joints: tuple[str, ...]) -> Guard:
    robot = load_robot(fingers=gripper)
    fingers = np.full(len(robot.joint_names) - len(JOINT_NAMES), OPEN)
    return Guard.of(robot, scene, np.concatenate([_whole(measured), fingers]), joints)


def _whole(measured: FloatArray) -> FloatArray:
    """Return all joints (15,); only the head may be untold, which the guard need not know."""
    return np.where(np.isfinite(measured), measured, 0.0)
