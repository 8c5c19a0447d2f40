"""One frame's way from skeleton to command: gate, directions, smoothing, angles, reach, limits.

`Pipeline.advance` is the only such way: live teaching, files and tests all call it at 30 Hz.
"""

from dataclasses import dataclass, replace

import numpy as np

from studio.engine.gate import Gate, GateMemory, GateMode, GateStatus
from studio.engine.human import ArmVectors, Held, arm_vectors, torso_frame
from studio.engine.limits import Command, Limits
from studio.engine.reach import Reach, ReachMemory
from studio.engine.retarget import DRIVEN_JOINTS, Angles, Mapping, solve_arm
from studio.engine.robot import CONTROL_PERIOD, Robot
from studio.engine.skeleton import FloatArray, Side, Skeleton
from studio.engine.smooth import OneEuro, OneEuroMemory
from studio.engine.vectors import Vector

# Where the robot waits for its teacher: upper arm raised 20° and 45° outward, forearm 45° down and
# 30° further inward. Both mappings can push the block from here.
_READY_UPPER_ARM: Vector = (0.6644630, 0.6644630, 0.3420201)
_READY_FOREARM: Vector = (0.6830127, 0.1830127, -0.7071068)

# Tried on real recordings: jitter a third of the raw mapping's, 50 ms of lag.
_TORSO_FILTER = OneEuro(min_cutoff=1.5, beta=1.0)
_ARM_FILTER = OneEuro(min_cutoff=1.5, beta=0.7)


def ready_angles(side: Side, mapping: Mapping) -> FloatArray:
    """Return the angles (4,) [rad] of s0, s1, e0, e1 at which every run begins."""
    mirror = 1.0 if side == "left" else -1.0
    upper_arm, forearm = ((v[0], mirror * v[1], v[2]) for v in (_READY_UPPER_ARM, _READY_FOREARM))
    return np.array(solve_arm(upper_arm, forearm, side, mapping))


@dataclass(frozen=True)
class SmoothedArm:
    """The filters' memories: the torso's two axes, upper arm and forearm in the torso's frame."""

    left: OneEuroMemory | None = None
    up: OneEuroMemory | None = None
    upper_arm: OneEuroMemory | None = None
    forearm: OneEuroMemory | None = None


@dataclass(frozen=True, eq=False)
class PipelineMemory:
    """All that is kept from one tick to the next."""

    sent: FloatArray  # (4,) [rad]
    gate: GateMemory | None = None
    arm: SmoothedArm = SmoothedArm()
    reach: ReachMemory | None = None
    wanted: Angles | None = None  # [rad], kept while the arm is refused or no frame is new
    refusal: str = ""  # why the newest frame's arm was refused
    skeleton: Skeleton | None = None  # the newest frame


@dataclass(frozen=True, eq=False)
class Outcome:
    """What one tick decided."""

    gate: GateStatus
    held: str  # why the robot does not follow, or nothing
    wanted: Angles | None  # [rad] inside the position limits; None while the gate is closed
    command: Command


@dataclass(frozen=True)
class Pipeline:
    """Settings of all stages. Build it by `for_robot`; `advance` does the work."""

    side: Side
    mapping: Mapping
    gate: Gate
    reach: Reach
    limits: Limits
    torso_filter: OneEuro = _TORSO_FILTER
    arm_filter: OneEuro = _ARM_FILTER

    @classmethod
    def for_robot(
        cls, robot: Robot, side: Side, mapping: Mapping = "exact", gate_mode: GateMode = "sequence"
    ) -> "Pipeline":
        """Return the pipeline that drives one arm of ``robot`` inside its limits."""
        limits = robot.limits_of([f"{side}_{joint}" for joint in DRIVEN_JOINTS])
        lower, upper = (_angles(bound) for bound in (limits.lower, limits.upper))
        return cls(
            side=side,
            mapping=mapping,
            gate=Gate(gate_mode),
            reach=Reach(side, mapping, lower, upper),
            limits=Limits(limits.lower, limits.upper, limits.velocity),
        )

    def start(self) -> PipelineMemory:
        """Return the memory of a robot that waits in its ready pose."""
        return PipelineMemory(ready_angles(self.side, self.mapping))

    def advance(
        self, memory: PipelineMemory, skeleton: Skeleton | None, time: float
    ) -> tuple[PipelineMemory, Outcome]:
        """Do one control tick at ``time`` [s] with the newest frame, or None if none is new."""
        gate_memory, status = self.gate.step(memory.gate, skeleton, time)
        memory = replace(memory, gate=gate_memory)
        if skeleton is not None and not _same_picture(memory.skeleton, skeleton):
            memory = self._see(memory, skeleton, time)
        wanted = memory.wanted if status.armed else None
        target = memory.sent if wanted is None else np.array(wanted)
        command = self.limits.step(memory.sent, target, CONTROL_PERIOD)
        held = memory.refusal if status.armed else status.reason
        return replace(memory, sent=command.sent), Outcome(status, held, wanted, command)

    def _see(self, memory: PipelineMemory, skeleton: Skeleton, time: float) -> PipelineMemory:
        """Bring the wanted angles up to date with a frame that shows something new."""
        memory = replace(memory, skeleton=skeleton)
        seen = arm_vectors(skeleton, self.side)
        if isinstance(seen, Held):
            return replace(memory, refusal=seen.reason)
        arm, directions = self._smooth(memory.arm, seen, skeleton.time)
        reach, wanted = self.reach.step(memory.reach, *directions, time)
        return replace(memory, arm=arm, reach=reach, wanted=wanted, refusal="")

    def _smooth(
        self, memory: SmoothedArm, seen: ArmVectors, time: float
    ) -> tuple[SmoothedArm, tuple[Vector, Vector]]:
        """Return upper arm and forearm in the torso's frame, all smoothed."""
        left_memory, left = self.torso_filter.step(memory.left, seen.torso.y, time)
        up_memory, up = self.torso_filter.step(memory.up, seen.torso.z, time)
        torso = torso_frame(left, up) or seen.torso
        upper_memory, upper_arm = self.arm_filter.step(
            memory.upper_arm, torso.from_camera(seen.upper_arm), time
        )
        fore_memory, forearm = self.arm_filter.step(
            memory.forearm, torso.from_camera(seen.forearm), time
        )
        return SmoothedArm(left_memory, up_memory, upper_memory, fore_memory), (upper_arm, forearm)


def _same_picture(before: Skeleton | None, now: Skeleton) -> bool:
    """Tell a duplicate frame, which some recorders write: the same 75 numbers to the last bit."""
    return before is not None and np.array_equal(before.positions, now.positions)


def _angles(values: FloatArray) -> Angles:
    s0, s1, e0, e1 = values.tolist()
    return (s0, s1, e0, e1)
