"""Baxter does a motion alone: any trajectory, through limits and guard, in a fresh world."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from studio.engine.arms import HANGING, Arms, driven_joints, learned_columns, sides_of
from studio.engine.fingers import fingers_of
from studio.engine.hands import PLAIN, STILL, HandCommand, HandOptions, HandTrack
from studio.engine.limits import Command
from studio.engine.pipeline import ready_pose
from studio.engine.planning import SETTLE, Planner, Trajectory, UnreachableError
from studio.engine.retarget import Mapping
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES
from studio.engine.scene import USUAL, Scene
from studio.engine.skeleton import SIDES, FloatArray
from studio.engine.world import World, WorldState

__all__ = [
    "SETTLE",
    "Performance",
    "Tick",
    "Trajectory",
    "UnreachableError",
    "in_guards_words",
    "joint_columns",
    "perform",
    "perform_steps",
    "rows_as_trajectory",
    "send",
    "start_world",
    "whole_body",
]


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
    def done(self) -> bool:
        """Whether the scene's task was done, in the end."""
        return self.ticks[-1].world.done

    @property
    def missing(self) -> str:
        """What was missing for that, in words."""
        return self.ticks[-1].world.missing

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
    arms: Arms,
    mapping: Mapping,
    hands: HandOptions = PLAIN,
    scene: Scene | None = None,
    pose: FloatArray | None = None,
) -> World:
    """Return a fresh world in which the taught arms wait in their ready pose; another one hangs.

    Fingers, if the hands have any, are open. ``scene`` is the usual one, and ``pose`` (D,) [rad] of
    the driven joints the ready one, unless given.
    """
    pose = ready_pose(arms, mapping) if pose is None else pose
    ready = dict(zip(driven_joints(arms), pose.tolist(), strict=True))
    for side in set(SIDES) - set(sides_of(arms)):
        ready |= dict(zip(driven_joints(side), HANGING[side], strict=True))
    if hands.gripper:
        ready |= fingers_of("left", closed=False) | fingers_of("right", closed=False)
    return World((scene or USUAL).taught_by(arms), ready, hands.gripper)


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
    for step in Planner.of(arms, mapping, hands, world.scene).steps(trajectory, duration):
        send(world, arms, step.command.sent, options, step.hands)
        yield Tick(step.time, step.command, world.step())


def perform(
    trajectory: Trajectory,
    duration: float,
    arms: Arms,
    mapping: Mapping,
    hands: HandTrack | None = None,
    scene: Scene | None = None,
) -> Performance:
    """Play a trajectory in a world of its own, with the usual scene or ``scene``.

    See `perform_steps`. Where its beginning cannot be reached the robot stays as it is, and the
    performance says so.
    """
    with start_world(arms, mapping, PLAIN if hands is None else hands.options, scene) as world:
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
