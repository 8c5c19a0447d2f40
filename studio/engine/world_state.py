"""What is known of the world after a control tick, and when a block counts as pushed down."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from studio.engine.robot import JOINT_NAMES
from studio.engine.skeleton import FloatArray

DOWN_TILT = math.radians(60.0)  # [rad] a block that is down leans more than this
REST_SPEED = 0.02  # [m/s] of the center of a block at rest, at most
REST_SPIN = 0.2  # [rad/s] of a block at rest, at most
REST_TICKS = 6  # that a block stays below both before it is at rest: 0.2 s


@dataclass(frozen=True, eq=False)
class WorldState:
    """The world at one moment."""

    time: float  # [s] since the world began
    joint_positions: FloatArray  # (15,) [rad], in the order of robot.JOINT_NAMES
    joint_velocities: FloatArray  # (15,) [rad/s]
    block_poses: FloatArray  # (B, 7) x y z [m] from the floor below the base, qx qy qz qw
    touched: bool  # the taught arm has touched the task's block
    tilt: float  # [rad] of the task's block from the upright
    block_down: bool  # touched before it fell, leaning more than DOWN_TILT, and at rest
    # How far out the fingers of both hands are [m], as in fingers.FINGER_JOINTS; (0,) without them.
    fingers: FloatArray = field(default_factory=lambda: np.empty(0))
    done: bool = False  # the scene's success condition holds; of the paper's task: block_down
    missing: str = ""  # what is missing for that yet, in words

    @classmethod
    def of(
        cls, time: float, joints: FloatArray, block_poses: FloatArray, verdict: "Verdict"
    ) -> "WorldState":
        """Return what joints (15 or 19, 2), each position and velocity, blocks and judge tell."""
        arms = len(JOINT_NAMES)  # then come fingers, if there are any
        return cls(
            time=time,
            joint_positions=frozen(joints[:arms, 0]),
            joint_velocities=frozen(joints[:arms, 1]),
            block_poses=frozen(block_poses),
            touched=verdict.task.touched,
            tilt=verdict.task.tilt,
            block_down=verdict.task.down,
            fingers=frozen(joints[arms:, 0]),
            done=verdict.done,
            missing=verdict.missing,
        )


@dataclass(frozen=True)
class BlockWatch:
    """What is known of a block: the memory from tick to tick."""

    touched: bool = False
    pushed: bool = False  # touched before it last came to lean more than DOWN_TILT, or just then
    tilt: float = 0.0  # [rad]
    slow_ticks: int = 0  # since it last moved

    def step(self, touched: bool, pose: FloatArray, speed: float, spin: float) -> "BlockWatch":
        """Return what is known after a tick.

        ``touched`` says whether the taught arm touched the block in it; then its pose (7,), speed
        [m/s] and spin [rad/s] at the end.
        """
        slow = speed <= REST_SPEED and spin <= REST_SPIN
        touched = self.touched or touched
        return BlockWatch(
            touched=touched,
            pushed=self.pushed if self.tilt > DOWN_TILT else touched,
            tilt=tilt_of(pose),
            slow_ticks=self.slow_ticks + 1 if slow else 0,
        )

    @property
    def at_rest(self) -> bool:
        """Whether it has not moved for a while."""
        return self.slow_ticks >= REST_TICKS

    @property
    def down(self) -> bool:
        """Whether it fell once the taught arm had touched it, and lies at rest."""
        return self.pushed and self.tilt > DOWN_TILT and self.at_rest


@dataclass(frozen=True)
class Verdict:
    """What a scene's judge has come to after a tick (`studio.engine.judge`)."""

    task: BlockWatch  # of the scene's first block
    done: bool
    missing: str  # what is missing yet, in words; nothing where it is done


def frozen(values: ArrayLike) -> FloatArray:
    """Return a copy that nobody can change."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def tilt_of(pose: FloatArray) -> float:
    """Return the angle [rad] between a block's own z axis and the upright, for its pose (7,)."""
    x, y = float(pose[3]), float(pose[4])
    upright = 1.0 - 2.0 * (x * x + y * y)  # the z component of the block's own z axis
    return math.acos(min(1.0, max(-1.0, upright)))
