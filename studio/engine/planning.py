"""What a robot that does a motion alone is told, tick by tick: soft start, limits and guard.

None of it depends on what the world makes of it, so that it can be planned without one, and once
for any number of worlds.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from studio.engine.arms import Arms, driven_joints, learned_columns
from studio.engine.engage import ARRIVED_WITHIN, EngageMemory, largest
from studio.engine.errors import StudioError
from studio.engine.hands import PLAIN, STILL, HandCommand, HandTrack
from studio.engine.limits import Command
from studio.engine.pipeline import Pipeline, ready_pose
from studio.engine.retarget import Mapping
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.engine.softly import as_joints, softly

SETTLE = 1.5  # [s] after the motion, in which a block that was pushed comes to rest
_LONGEST_WAY = 10.0  # [s] to where a motion begins; at the engagement's speeds 6 are enough
_NO_WAY = 1e-4  # [rad] in a tick; slower, with the guard in the way, it comes no further
Trajectory = Callable[[float], FloatArray]  # time [s] -> (D,) [rad], the learned joints


class UnreachableError(StudioError):
    """The robot cannot come to where a motion begins."""


@dataclass(frozen=True, eq=False)
class Planned:
    """What the robot is told in one tick."""

    time: float  # [s] below 0 on the way to where the motion begins
    command: Command  # of the driven joints
    hands: HandCommand


@dataclass(frozen=True, eq=False)
class Planner:
    """Plans motions of the taught arms, with or without hands; build it by `of`."""

    arms: Arms
    mapping: Mapping
    hands: HandTrack | None
    pipeline: Pipeline

    @classmethod
    def of(
        cls,
        arms: Arms,
        mapping: Mapping,
        hands: HandTrack | None = None,
        scene: Scene | None = None,
    ) -> "Planner":
        """Return the planner of a robot with such ``hands``, in the usual scene unless given."""
        options = PLAIN if hands is None else hands.options
        pipeline = Pipeline.for_robot(load_robot(), arms, mapping, hands=options, scene=scene)
        return cls(arms, mapping, hands, pipeline)

    @property
    def ready(self) -> FloatArray:
        """Where the robot waits (D + W,) [rad]: driven joints, then driven wrists."""
        options = PLAIN if self.hands is None else self.hands.options
        wrists = np.zeros(len(options.wrist_joints(self.arms)))
        return np.concatenate([ready_pose(self.arms, self.mapping), wrists])

    def steps(
        self, trajectory: Trajectory, duration: float, start: FloatArray | None = None
    ) -> Iterator[Planned]:
        """Yield the way to where ``trajectory`` begins, then ``duration`` [s] of it and `SETTLE`.

        The robot comes there from ``start`` (D + W,) [rad], where it is `ready` unless given, as
        softly as to a person; the motion itself begins at time 0. Hands do what they did by then.
        What the guard held off for long catches up as softly.

        Raises
        ------
        UnreachableError
            Before the first step, where the guard does not let the robot come there.
        """
        sent = self.ready if start is None else start
        way = self.way(sent, self.begin(trajectory, sent))
        yield from way
        sent = self.all_sent(way[-1]) if way else sent
        yield from self.motion(trajectory, duration, sent)

    def begin(self, trajectory: Trajectory, start: FloatArray) -> FloatArray:
        """Return where a motion begins (D + W,) [rad], inside the position limits."""
        wanted, _ = self._wanted(trajectory, 0.0, start)
        return np.clip(wanted, self.pipeline.limits.lower, self.pipeline.limits.upper)

    def way(self, start: FloatArray, begin: FloatArray) -> list[Planned]:
        """Return the steps from one pose (D + W,) [rad] to another, at an engagement's speed.

        Raises
        ------
        UnreachableError
            Where the guard lets none of them come near.
        """
        memory: EngageMemory | None = None
        way: list[Command] = []
        sent, moved = start, np.inf
        while len(way) < _LONGEST_WAY * CONTROL_RATE and moved > _NO_WAY:
            if np.array_equal(sent, begin):
                break
            memory, command = softly(self.pipeline, memory, sent, begin, len(way) * CONTROL_PERIOD)
            way.append(command)
            moved, sent = np.abs(command.sent - sent).max(), command.sent
        left = largest(as_joints(sent), as_joints(begin))
        if left >= ARRIVED_WITHIN:
            why = way[-1].guarded or "it takes too long"
            raise UnreachableError(
                f"Baxter cannot come to where this motion begins: {why}, {np.degrees(left):.0f}° "
                "short of it. Nothing has moved: teach a motion that begins elsewhere"
            )
        told = STILL if self.hands is None else self.hands.at(0.0)
        return [
            self._planned(k * CONTROL_PERIOD, command, told)
            for k, command in enumerate(way, start=-len(way))
        ]

    def motion(
        self, trajectory: Trajectory, duration: float, start: FloatArray
    ) -> Iterator[Planned]:
        """Yield the steps of a motion that the robot begins at ``start`` (D + W,) [rad]."""
        sent = start
        memory: EngageMemory | None = EngageMemory(0.0, arrived=True, released=True)
        for k in range(round((duration + SETTLE) * CONTROL_RATE)):
            time = k * CONTROL_PERIOD
            wanted, told = self._wanted(trajectory, min(time, duration), sent)
            memory, command = softly(self.pipeline, memory, sent, wanted, time)
            sent = command.sent
            yield self._planned(time, command, told)

    def all_sent(self, step: Planned) -> FloatArray:
        """Return where a step leaves driven joints and wrists (D + W,) [rad]."""
        return np.concatenate([step.command.sent, step.hands.wrist])

    def _wanted(
        self, trajectory: Trajectory, time: float, before: FloatArray
    ) -> tuple[FloatArray, HandCommand]:
        wanted, told = before.copy(), STILL if self.hands is None else self.hands.at(time)
        driven = len(driven_joints(self.arms))
        wanted[learned_columns(self.arms, self.mapping)] = trajectory(time)
        wanted[driven:] = told.wrist
        return wanted, told

    def _planned(self, time: float, command: Command, told: HandCommand) -> Planned:
        driven = len(driven_joints(self.arms))
        wrist = tuple(command.sent[driven:].tolist())
        return Planned(time, command.of_first(driven), replace(told, wrist=wrist))
