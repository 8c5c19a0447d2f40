"""One frame's way from skeleton to command: gate, the arms' stages, engagement, limits, guard.

`Pipeline.advance` is the only such way: live teaching, files and tests all call it at 30 Hz.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from studio.engine.arm import ArmMemory, ArmStages
from studio.engine.arms import Arms, driven_joints, sides_of
from studio.engine.calibration import Calibration
from studio.engine.engage import COMING, LONG_UNSEEN, Engage, EngageMemory, Joints, Move, Passed
from studio.engine.gate import Gate, GateMemory, GateMode, GateStatus
from studio.engine.guard import Guard
from studio.engine.hands import (
    PLAIN,
    STILL,
    WRIST_SPEED,
    HandCommand,
    HandOptions,
    Hands,
    HandsMemory,
)
from studio.engine.identity import is_another
from studio.engine.limits import Command, Limits
from studio.engine.reach import Reach
from studio.engine.retarget import Angles, Mapping, solve_arm
from studio.engine.robot import CONTROL_PERIOD, Robot, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray, Side, Skeleton
from studio.engine.vectors import Vector

# Where the robot waits for its teacher: upper arm raised 20° and 45° outward, forearm 45° down and
# 30° further inward. Both mappings can push the block from here.
_READY_UPPER_ARM: Vector = (0.6644630, 0.6644630, 0.3420201)
_READY_FOREARM: Vector = (0.6830127, 0.1830127, -0.7071068)

_ENGAGE = Engage()

NO_PICTURE = "no picture from the sensor"
# Baxter's torso is wider than a person's, and in real recordings arms that just hang are kept 0.03
# to 0.3 rad from where the person's are. Up to here that is as good as hanging, and no hold.
HANGS_WITHIN = 0.32  # [rad]


def ready_angles(side: Side, mapping: Mapping) -> FloatArray:
    """Return the angles (4,) [rad] of one arm's s0, s1, e0, e1 at which every run begins."""
    mirror = 1.0 if side == "left" else -1.0
    upper_arm, forearm = ((v[0], mirror * v[1], v[2]) for v in (_READY_UPPER_ARM, _READY_FOREARM))
    return np.array(solve_arm(upper_arm, forearm, side, mapping))


def ready_pose(arms: Arms, mapping: Mapping) -> FloatArray:
    """Return the same (D,) [rad] for all driven joints."""
    return np.concatenate([ready_angles(side, mapping) for side in sides_of(arms)])


@dataclass(frozen=True)
class Lag:
    """What lies between the wanted angles and those sent: the limits', and while it engages its."""

    angle: float = 0.0  # [rad] of the joint that is furthest behind
    seconds: float = 0.0  # that the slowest joint takes to catch up, at its top speed


NO_LAG = Lag()


@dataclass(frozen=True, eq=False)
class PipelineMemory:
    """All that is kept from one tick to the next."""

    sent: FloatArray  # (D,) [rad]
    arms: tuple[ArmMemory, ...]  # of each driven arm
    engaged: tuple[EngageMemory | None, ...]  # of each; None while the gate is closed or unseen
    hands: HandsMemory
    gate: GateMemory | None = None
    skeleton: Skeleton | None = None  # the newest frame


@dataclass(frozen=True, eq=False)
class Outcome:
    """What one tick decided. Joints are those of `studio.engine.arms.driven_joints`."""

    gate: GateStatus
    held: str  # why the robot does not follow, or nothing
    # (D,) [rad] inside the position limits; None while the gate is closed or no arm was ever seen.
    # An arm that was not seen yet wants to stay where it is.
    wanted: Joints | None
    command: Command
    lag: Lag
    hands: HandCommand = STILL


@dataclass(frozen=True)
class Pipeline:
    """Settings of all stages. Build it by `for_robot`; `advance` does the work."""

    arms: Arms
    mapping: Mapping
    gate: Gate
    stages: tuple[ArmStages, ...]  # of each driven arm
    limits: Limits
    guard: Guard
    hands: Hands
    mirrored: bool = False
    calibration: Calibration | None = None
    engage: Engage = _ENGAGE

    @classmethod
    def for_robot(
        cls,
        robot: Robot,
        arms: Arms,
        mapping: Mapping = "exact",
        gate_mode: GateMode = "sequence",
        mirrored: bool = False,
        calibration: Calibration | None = None,
        hands: HandOptions = PLAIN,
        scene: Scene | None = None,
    ) -> "Pipeline":
        """Return the pipeline that drives one arm of ``robot``, or both, inside its limits.

        It keeps off the desk of ``scene``, of the usual one unless given.

        Limits and guard are those of the arms' joints, followed by the wrists' that are driven.
        """
        wrists = hands.wrist_joints(arms)
        limits = robot.limits_of((*driven_joints(arms), *wrists))
        calm = np.full(len(wrists), WRIST_SPEED)
        arms_speed = limits.velocity[: len(limits.velocity) - len(wrists)]
        return cls(
            arms=arms,
            mapping=mapping,
            gate=Gate(gate_mode),
            stages=tuple(
                ArmStages(Reach.for_robot(robot, side, mapping), mirrored, calibration)
                for side in sides_of(arms)
            ),
            limits=Limits(limits.lower, limits.upper, np.concatenate([arms_speed, calm])),
            guard=Guard.for_robot(
                load_robot(True) if hands.gripper else robot, arms, wrists, scene
            ),
            hands=Hands.for_robot(robot, arms, hands),
            mirrored=mirrored,
            calibration=calibration,
        )

    def start(self) -> PipelineMemory:
        """Return the memory of a robot that waits in its ready pose."""
        nothing = len(self.stages)
        return PipelineMemory(
            ready_pose(self.arms, self.mapping),
            (ArmMemory(),) * nothing,
            (None,) * nothing,
            self.hands.start(),
        )

    def advance(
        self, memory: PipelineMemory, skeleton: Skeleton | None, time: float
    ) -> tuple[PipelineMemory, Outcome]:
        """Do one control tick at ``time`` [s] with the newest frame, or None if none is new."""
        memory, status = self.observe(memory, skeleton, time)
        moves = self._moves(memory, status.armed, time)
        memory, command = self._command(memory, moves, time)
        wanted = _wanted(moves)
        lag = NO_LAG if wanted is None else self._lag(wanted, command.sent)
        if command.resting and lag.angle < HANGS_WITHIN:
            command = replace(command, guarded=command.resting, stopped=False)
        held = self._why_held(memory, command, time) if status.armed else status.reason
        return memory, Outcome(status, held, wanted, command, lag, self.hands.command(memory.hands))

    def observe(
        self, memory: PipelineMemory, skeleton: Skeleton | None, time: float
    ) -> tuple[PipelineMemory, GateStatus]:
        """Do the first half of `advance`: what gate and stages make of the newest frame."""
        gate_memory, status = self.gate.step(memory.gate, skeleton, time)
        return replace(self._see(memory, skeleton, status.armed, time), gate=gate_memory), status

    def _command(
        self, memory: PipelineMemory, arms: list[Move], time: float
    ) -> tuple[PipelineMemory, Command]:
        """Return what is sent to the arms, and the memory of it and of what the wrists got."""
        before = np.concatenate([memory.sent, memory.hands.wrist])
        target = [angle for move in arms for angle in move.target]
        limited = self.limits.step(before, [*target, *memory.hands.wrist], CONTROL_PERIOD)
        moves = arms
        if self.hands.wrists:  # turn with the arms as they get there, not as they would like to
            going = _fours(limited.sent[: len(memory.sent)].tolist())
            moves = arms + self.hands.moves(memory.hands, going, arms, time)
            target = [angle for move in moves for angle in move.target]
            limited = self.limits.step(before, target, CONTROL_PERIOD)
        command = self.guard.keep(before, limited, CONTROL_PERIOD)
        engaged = self._engaged(moves, before, limited.sent, command.sent, time)
        count, driven = len(arms), len(memory.sent)
        wrist = tuple(command.sent[driven:].tolist())
        hands = self.hands.moved(memory.hands, wrist, engaged[count:])
        command = command.of_first(driven)
        return replace(memory, sent=command.sent, engaged=engaged[:count], hands=hands), command

    def _engaged(
        self,
        moves: list[Move],
        before: FloatArray,
        asked: FloatArray,
        sent: FloatArray,
        time: float,
    ) -> tuple[EngageMemory | None, ...]:
        """Return how far each arm and wrist has come, now that the guard has had its say."""
        found, first = [], 0
        for move in moves:
            mine = slice(first, first + len(move.target))
            passed = Passed(*(tuple(row[mine].tolist()) for row in (before, asked, sent)))
            found.append(self.engage.after(move, passed, time, CONTROL_PERIOD))
            first = mine.stop
        return tuple(found)

    def _see(
        self, memory: PipelineMemory, seen: Skeleton | None, armed: bool, time: float
    ) -> PipelineMemory:
        """Bring every arm's wanted angles up to date, and what is known of the hands."""
        before = memory.skeleton
        if seen is not None and before is not None and is_another(before, seen):
            fresh = self.start()  # somebody else: nothing that is known of the arms holds
            hands = self.hands.of_another(memory.hands)
            memory = replace(memory, arms=fresh.arms, engaged=fresh.engaged, hands=hands)
        is_repeated = _same_picture(before, seen)
        arms = tuple(
            stages.step(arm, seen, time, is_repeated)
            for stages, arm in zip(self.stages, memory.arms, strict=True)
        )
        hands = self.hands.see(memory.hands, self.stages, seen, armed, time, is_repeated)
        newest = before if seen is None else seen
        return replace(memory, arms=arms, hands=hands, skeleton=newest)

    def _moves(self, memory: PipelineMemory, armed: bool, time: float) -> list[Move]:
        """Return where each arm goes in this tick; it stays where it has nobody to follow."""
        moves = []
        drives = zip(memory.arms, memory.engaged, _fours(memory.sent.tolist()), strict=True)
        for arm, before, at in drives:
            if not armed or arm.wanted is None:
                moves.append(Move(None, None, at))
            elif _long_unseen(arm, time):
                moves.append(Move(None, arm.wanted, at))
            else:
                now, target = self.engage.step(before, at, arm.wanted, time, CONTROL_PERIOD)
                moves.append(Move(now, arm.wanted, target))
        return moves

    def _why_held(self, memory: PipelineMemory, command: Command, time: float) -> str:
        """Return why an armed robot does not do all that the person does, or nothing."""
        if command.stopped:
            return command.guarded
        hangs = bool(command.resting) and command.guarded == command.resting
        for arm, engaged in zip(memory.arms, memory.engaged, strict=True):
            if arm.refusal:
                return arm.refusal
            if _long_unseen(arm, time):
                return NO_PICTURE
            if engaged is not None and not engaged.arrived and not hangs:
                return COMING
        return ""

    def _lag(self, wanted: Joints, sent: FloatArray) -> Lag:
        gaps = [abs(to - at) for to, at in zip(wanted, sent.tolist(), strict=True)]
        speeds = self._top_speeds[: len(gaps)]  # the wrists' follow
        seconds = [gap / top for gap, top in zip(gaps, speeds, strict=True)]
        return Lag(max(gaps), max(seconds))

    @cached_property
    def _top_speeds(self) -> list[float]:
        speeds: list[float] = self.limits.velocity.tolist()
        return speeds


def _wanted(moves: list[Move]) -> Joints | None:
    """Return what all arms want; None where none of them has anybody to follow."""
    if all(move.wanted is None for move in moves):
        return None
    return tuple(angle for move in moves for angle in move.wanted or move.target)


def _long_unseen(arm: ArmMemory, time: float) -> bool:
    return arm.sighted_at is not None and time - arm.sighted_at > LONG_UNSEEN


def _same_picture(before: Skeleton | None, now: Skeleton | None) -> bool:
    """Tell a duplicate frame, which some recorders write: the same 75 numbers to the last bit."""
    if before is None or now is None or not np.array_equal(before.positions, now.positions):
        return False
    return np.array_equal(before.tracking, now.tracking)


def _fours(flat: list[float]) -> list[Angles]:
    """Return the angles (D,) of the driven joints arm by arm."""
    return [(flat[i], flat[i + 1], flat[i + 2], flat[i + 3]) for i in range(0, len(flat), 4)]
