"""Baxter does a motion alone: any trajectory, through the limits, in a fresh world."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from studio.engine.limits import Command
from studio.engine.pipeline import Pipeline, ready_angles
from studio.engine.retarget import DRIVEN_JOINTS, LEARNED_JOINTS, Angles, Mapping
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE, JOINT_NAMES, load_robot
from studio.engine.skeleton import FloatArray, Side
from studio.engine.world import Scene, World, WorldState

SETTLE = 1.5  # [s] after the motion, in which a block that was pushed comes to rest
# The arm that is not taught hangs beside the desk, out of everybody's way [rad].
_HANGING: dict[Side, Angles] = {"left": (0.35, 1.0, 0.0, 0.5), "right": (-0.35, 1.0, 0.0, 0.5)}
Trajectory = Callable[[float], FloatArray]  # time [s] -> (D,) [rad], the learned joints


@dataclass(frozen=True, eq=False)
class Tick:
    """One tick of a performance."""

    time: float  # [s] at which the command was given
    command: Command
    world: WorldState  # one control period later


@dataclass(frozen=True, eq=False)
class Performance:
    """A whole performance, the settling included."""

    side: Side
    mapping: Mapping
    duration: float  # [s] of the motion itself
    start: FloatArray  # (15,) [rad] measured before the first command
    ticks: tuple[Tick, ...]

    @property
    def block_down(self) -> bool:
        """Whether the block was pushed down by the taught arm, in the end."""
        return self.ticks[-1].world.block_down

    def measured_at(self, times: FloatArray) -> FloatArray:
        """Return all measured joints (N, 15) [rad] at ``times`` (N,) [s], interpolated linearly."""
        stamps = CONTROL_PERIOD * np.arange(len(self.ticks) + 1)
        joints = np.vstack([self.start, *(tick.world.joint_positions for tick in self.ticks)])
        return np.column_stack([np.interp(times, stamps, column) for column in joints.T])


def start_world(side: Side, mapping: Mapping) -> World:
    """Return a fresh world in which the arm waits in its ready pose, and the other one hangs."""
    ready = dict(zip(_names(side), ready_angles(side, mapping).tolist(), strict=True))
    other: Side = "right" if side == "left" else "left"
    hanging = dict(zip(_names(other), _HANGING[other], strict=True))
    return World(Scene(arm=side), ready | hanging)


def send(world: World, side: Side, sent: FloatArray) -> None:
    """Give the arm's four driven joints (4,) [rad] as targets; the wrist stays at zero."""
    world.apply(dict(zip(_names(side), sent.tolist(), strict=True)))


def perform_steps(
    world: World, trajectory: Trajectory, duration: float, side: Side, mapping: Mapping
) -> Iterator[Tick]:
    """Play ``trajectory`` for ``duration`` [s] in ``world``, then let it settle, tick by tick."""
    limits = Pipeline.for_robot(load_robot(), side, mapping).limits
    columns = [DRIVEN_JOINTS.index(joint) for joint in LEARNED_JOINTS[mapping]]
    sent = ready_angles(side, mapping)
    for k in range(round((duration + SETTLE) * CONTROL_RATE)):
        time = k * CONTROL_PERIOD
        wanted = sent.copy()
        wanted[columns] = trajectory(min(time, duration))
        command = limits.step(sent, wanted, CONTROL_PERIOD)
        sent = command.sent
        send(world, side, sent)
        yield Tick(time, command, world.step())


def perform(trajectory: Trajectory, duration: float, side: Side, mapping: Mapping) -> Performance:
    """Play a trajectory in a world of its own; see `perform_steps`."""
    with start_world(side, mapping) as world:
        start = world.state.joint_positions
        ticks = tuple(perform_steps(world, trajectory, duration, side, mapping))
    return Performance(side, mapping, duration, start, ticks)


def rows_as_trajectory(rows: FloatArray, duration: float) -> Trajectory:
    """Return the trajectory through evenly spaced rows (T, D) [rad], linear in between."""
    stamps = np.linspace(0.0, duration, len(rows))
    return lambda time: np.array([np.interp(time, stamps, column) for column in rows.T])


def whole_body(rows: FloatArray, side: Side, joints: Sequence[str]) -> FloatArray:
    """Return rows (T, D) [rad] of an arm's joints as (T, 15) of all joints, the others at zero."""
    body = np.zeros((len(rows), len(JOINT_NAMES)))
    body[:, joint_columns(side, joints)] = rows
    return body


def joint_columns(side: Side, joints: Sequence[str]) -> list[int]:
    """Return where an arm's joints stand among all fifteen."""
    return [JOINT_NAMES.index(f"{side}_{joint}") for joint in joints]


def _names(side: Side) -> tuple[str, ...]:
    return tuple(f"{side}_{joint}" for joint in DRIVEN_JOINTS)
