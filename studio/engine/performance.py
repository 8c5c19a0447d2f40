"""Baxter does a motion alone: any trajectory, through limits and guard, in a fresh world."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from studio.engine.arms import HANGING, Arms, driven_joints, learned_columns, sides_of
from studio.engine.engage import (
    ARRIVED_WITHIN,
    EngageMemory,
    Joints,
    Move,
    Passed,
    largest,
)
from studio.engine.errors import StudioError
from studio.engine.fingers import fingers_of
from studio.engine.hands import PLAIN, STILL, HandCommand, HandOptions, HandTrack
from studio.engine.limits import Command
from studio.engine.pipeline import Pipeline, ready_pose
from studio.engine.retarget import Mapping
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE, JOINT_NAMES, load_robot
from studio.engine.skeleton import SIDES, FloatArray
from studio.engine.world import Scene, World, WorldState

SETTLE = 1.5  # [s] after the motion, in which a block that was pushed comes to rest
_LONGEST_WAY = 10.0  # [s] to where a motion begins; at the engagement's speeds 6 are enough
_NO_WAY = 1e-4  # [rad] in a tick; slower, with the guard in the way, it comes no further
Trajectory = Callable[[float], FloatArray]  # time [s] -> (D,) [rad], the learned joints


class UnreachableError(StudioError):
    """The robot cannot come to where a motion begins."""


@dataclass(frozen=True, eq=False)
class Tick:
    """One tick of a performance."""

    time: float  # [s] at which the command was given; below 0 on the way to where it begins
    command: Command
    world: WorldState  # one control period later


@dataclass(frozen=True, eq=False)
class Performance:
    """A whole performance, the settling included."""

    arms: Arms
    mapping: Mapping
    duration: float  # [s] of the motion itself
    start: FloatArray  # (15,) [rad] measured before the motion's first command
    ticks: tuple[Tick, ...]  # of the motion and the settling
    refusal: str = ""  # why the robot stayed where it was and did none of it

    @property
    def block_down(self) -> bool:
        """Whether the block was pushed down by a taught arm, in the end."""
        return self.ticks[-1].world.block_down

    @property
    def guarded_ticks(self) -> int:
        """How many of the ticks the collision guard changed: they are not what was asked."""
        return sum(1 for tick in self.ticks if tick.command.guarded)

    @classmethod
    def of(
        cls,
        arms: Arms,
        mapping: Mapping,
        duration: float,
        ready: FloatArray,
        ticks: Sequence[Tick],
    ) -> "Performance":
        """Return the performance that `perform_steps` has come to, from a world at ``ready``."""
        way = [tick for tick in ticks if tick.time < 0.0]
        start = way[-1].world.joint_positions if way else ready
        return cls(arms, mapping, duration, start, tuple(ticks[len(way) :]))

    def measured_at(self, times: FloatArray) -> FloatArray:
        """Return all measured joints (N, 15) [rad] at ``times`` (N,) [s], interpolated linearly."""
        stamps = CONTROL_PERIOD * np.arange(len(self.ticks) + 1)
        joints = np.vstack([self.start, *(tick.world.joint_positions for tick in self.ticks)])
        return np.column_stack([np.interp(times, stamps, column) for column in joints.T])


def start_world(
    arms: Arms, mapping: Mapping, hands: HandOptions = PLAIN, scene: Scene | None = None
) -> World:
    """Return a fresh world in which the taught arms wait in their ready pose; another one hangs.

    Fingers, if the hands have any, are open. ``scene`` is the usual one unless given.
    """
    ready = dict(zip(driven_joints(arms), ready_pose(arms, mapping).tolist(), strict=True))
    for side in set(SIDES) - set(sides_of(arms)):
        ready |= dict(zip(driven_joints(side), HANGING[side], strict=True))
    if hands.gripper:
        ready |= fingers_of("left", closed=False) | fingers_of("right", closed=False)
    return World(scene or Scene(arms=arms), ready, hands.gripper)


def send(
    world: World,
    arms: Arms,
    sent: FloatArray,
    options: HandOptions = PLAIN,
    hands: HandCommand = STILL,
) -> None:
    """Give the driven joints (D,) [rad] as targets, and the hands theirs."""
    targets = dict(zip(driven_joints(arms), sent.tolist(), strict=True))
    world.apply(targets | hands.targets(arms, options))


def perform_steps(
    world: World,
    trajectory: Trajectory,
    duration: float,
    arms: Arms,
    mapping: Mapping,
    hands: HandTrack | None = None,
) -> Iterator[Tick]:
    """Play ``trajectory`` for ``duration`` [s] in ``world``, then let it settle, tick by tick.

    Before that the robot comes to where it begins, as softly as to a person; the motion itself
    begins at time 0. ``hands`` do what they did by then. What the guard held off for long catches
    up as softly.

    Raises
    ------
    UnreachableError
        Where the guard does not let the robot come to where the motion begins; nothing has moved.
    """
    options = PLAIN if hands is None else hands.options
    pipeline = Pipeline.for_robot(load_robot(), arms, mapping, hands=options)
    columns, driven = learned_columns(arms, mapping), len(driven_joints(arms))
    wrists = np.zeros(len(options.wrist_joints(arms)))
    sent = np.concatenate([ready_pose(arms, mapping), wrists])

    def wanted_at(time: float, before: FloatArray) -> tuple[FloatArray, HandCommand]:
        wanted, told = before.copy(), STILL if hands is None else hands.at(time)
        wanted[columns], wanted[driven:] = trajectory(time), told.wrist
        return wanted, told

    def sent_as(command: Command, told: HandCommand, time: float) -> Tick:
        wrist = tuple(command.sent[driven:].tolist())
        send(world, arms, command.sent[:driven], options, replace(told, wrist=wrist))
        return Tick(time, command.of_first(driven), world.step())

    begin, told = wanted_at(0.0, sent)
    way = _way(pipeline, sent, begin)
    for k, command in enumerate(way, start=-len(way)):
        sent = command.sent
        yield sent_as(command, told, k * CONTROL_PERIOD)
    memory: EngageMemory | None = EngageMemory(0.0, arrived=True, released=True)
    for k in range(round((duration + SETTLE) * CONTROL_RATE)):
        time = k * CONTROL_PERIOD
        wanted, told = wanted_at(min(time, duration), sent)
        memory, command = _softly(pipeline, memory, sent, wanted, time)
        sent = command.sent
        yield sent_as(command, told, time)


def _way(pipeline: Pipeline, start: FloatArray, begin: FloatArray) -> list[Command]:
    """Return the commands from one pose (D,) [rad] to another, at the speed of an engagement.

    Raises
    ------
    UnreachableError
        Where the guard lets none of them come near.
    """
    memory: EngageMemory | None = None
    begin = np.clip(begin, pipeline.limits.lower, pipeline.limits.upper)
    way: list[Command] = []
    sent, moved = start, np.inf
    while len(way) < _LONGEST_WAY * CONTROL_RATE and moved > _NO_WAY:
        if np.array_equal(sent, begin):
            return way
        memory, command = _softly(pipeline, memory, sent, begin, len(way) * CONTROL_PERIOD)
        way.append(command)
        moved, sent = np.abs(command.sent - sent).max(), command.sent
    left = largest(_joints(sent), _joints(begin))
    if left < ARRIVED_WITHIN:
        return way
    why = way[-1].guarded or "it takes too long"
    raise UnreachableError(
        f"Baxter cannot come to where this motion begins: {why}, {np.degrees(left):.0f}° short of "
        "it. Nothing has moved: teach a motion that begins elsewhere"
    )


def _softly(
    pipeline: Pipeline,
    memory: EngageMemory | None,
    sent: FloatArray,
    wanted: FloatArray,
    time: float,
) -> tuple[EngageMemory | None, Command]:
    """Return what is sent after ``sent`` (D,) [rad], and how far the engagement has come."""
    engage, goal = pipeline.engage, _joints(wanted)
    memory, target = engage.step(memory, _joints(sent), goal, time, CONTROL_PERIOD)
    limited = pipeline.limits.step(sent, target, CONTROL_PERIOD)
    command = pipeline.guard.keep(sent, limited, CONTROL_PERIOD)
    passed = Passed(*map(_joints, (sent, limited.sent, command.sent)))
    memory = engage.after(Move(memory, goal, target), passed, time, CONTROL_PERIOD)
    return memory, command


def _joints(row: FloatArray) -> Joints:
    return tuple(row.tolist())


def perform(
    trajectory: Trajectory,
    duration: float,
    arms: Arms,
    mapping: Mapping,
    hands: HandTrack | None = None,
) -> Performance:
    """Play a trajectory in a world of its own; see `perform_steps`.

    Where its beginning cannot be reached the robot stays as it is, and the performance says so.
    """
    with start_world(arms, mapping, PLAIN if hands is None else hands.options) as world:
        ready, refusal = world.state.joint_positions, ""
        try:
            ticks = tuple(perform_steps(world, trajectory, duration, arms, mapping, hands))
        except UnreachableError as error:
            refusal = str(error)
            still = ready_pose(arms, mapping)[learned_columns(arms, mapping)]
            ticks = tuple(perform_steps(world, lambda _: still, duration, arms, mapping))
    return replace(Performance.of(arms, mapping, duration, ready, ticks), refusal=refusal)


def in_guards_words(performance: Performance) -> str:
    """Return what kept the robot from doing what was asked, or nothing."""
    changed = performance.guarded_ticks
    if performance.refusal or not changed:
        return performance.refusal
    words = Counter(tick.command.guarded for tick in performance.ticks if tick.command.guarded)
    return (
        f"The collision guard changed {changed} of {len(performance.ticks)} ticks, most often "
        f"because {words.most_common(1)[0][0].partition(':')[0]}."
    )


def rows_as_trajectory(rows: FloatArray, duration: float) -> Trajectory:
    """Return the trajectory through evenly spaced rows (T, D) [rad], linear in between."""
    stamps = np.linspace(0.0, duration, len(rows))
    return lambda time: np.array([np.interp(time, stamps, column) for column in rows.T])


def whole_body(rows: FloatArray, joints: Sequence[str]) -> FloatArray:
    """Return rows (T, D) [rad] of some joints as (T, 15) of all joints, the others at zero."""
    body = np.zeros((len(rows), len(JOINT_NAMES)))
    body[:, joint_columns(joints)] = rows
    return body


def joint_columns(joints: Sequence[str]) -> list[int]:
    """Return where joints, by their full names, stand among all fifteen."""
    return [JOINT_NAMES.index(joint) for joint in joints]
