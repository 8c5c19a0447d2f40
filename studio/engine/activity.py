"""What a session does for a while: follow a source, perform a motion, or hold still.

Each is a small object with ``step``: one tick, in the world that it owns; it returns False after
its last one. All but `Follow` leave no trace on disk.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Protocol

from studio.engine.arms import Arms
from studio.engine.demonstration import Demonstration
from studio.engine.errors import FileError
from studio.engine.follow import follow_steps
from studio.engine.hands import PLAIN, HandTrack
from studio.engine.mcap_file import RecordingWriter
from studio.engine.moment import demonstration_at
from studio.engine.performance import (
    SETTLE,
    Performance,
    Tick,
    Trajectory,
    perform_steps,
    start_world,
)
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording, RecordingInfo, Sample
from studio.engine.retarget import Mapping
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.skeleton import FloatArray, Skeleton
from studio.engine.snapshot import Mode
from studio.engine.teachers import Teacher
from studio.engine.teaching import Lesson
from studio.engine.world import World

LONGEST_RECORDING = 15 * 60  # [s] of a live stream, which ends by itself never; 100 MB in memory


class Activity(Protocol):
    """What a session needs of an activity."""

    world: World
    time: float  # [s] since it began
    duration: float  # [s] that it takes, 0 for no end

    @property
    def guarded(self) -> str:
        """What the collision guard keeps apart at this moment, in words."""
        ...

    @property
    def mode(self) -> Mode:
        """What to call it."""
        ...

    def step(self) -> bool:
        """Do one tick; return whether another one follows."""
        ...

    def close(self) -> None:
        """End it, keeping what was recorded; may be called twice."""
        ...


class Hold:
    """Hold still where a world has been left."""

    duration, mode, guarded = 0.0, Mode.IDLE, ""

    def __init__(self, world: World) -> None:
        self.world = world
        self.time = 0.0

    def step(self) -> bool:
        """Let the physics go on."""
        self.time += CONTROL_PERIOD
        self.world.step()
        return True

    def close(self) -> None:
        """Nothing to keep."""


class Follow:
    """Let the robot follow a teacher, recording it if a path is given."""

    def __init__(self, teacher: Teacher, pipeline: Pipeline, path: Path | None) -> None:
        self.teacher = teacher
        self.time, self.duration = 0.0, teacher.seconds
        self.info = RecordingInfo.of(pipeline, teacher)
        self.samples: list[Sample] = []  # what is recorded
        self.newest: Sample | None = None
        self.skeleton: Skeleton | None = None  # the newest one
        self.writer = None if path is None else RecordingWriter(path, self.info)
        self.world = start_world(pipeline.arms, pipeline.mapping, pipeline.hands.options)
        self._steps: Iterator[Sample] = follow_steps(
            teacher.frames(), pipeline, self.world, teacher.command_given
        )

    def step(self) -> bool:
        """Do one tick and write it down at once, so that a crash loses less than a second."""
        sample = None if self.is_full else next(self._steps, None)
        if sample is None:
            return False
        self.time, self.newest = sample.time, sample
        self.skeleton = sample.skeleton or self.skeleton
        if self.writer is not None:
            if len(self.samples) % CONTROL_RATE == CONTROL_RATE - 1:  # once a second
                sample = replace(sample, latency=self.teacher.latency())
            self.samples.append(sample)
            self.writer.write(sample)
        return True

    def close(self) -> None:
        """Finish the recording's file."""
        if self.writer is not None:
            self.writer.close()

    @property
    def guarded(self) -> str:
        """What the guard keeps apart."""
        return "" if self.newest is None else self.newest.guarded

    @property
    def is_full(self) -> bool:
        """Whether a recording without an end of its own has come to the longest that is kept."""
        return self.duration == 0.0 and len(self.samples) >= LONGEST_RECORDING * CONTROL_RATE

    @property
    def mode(self) -> Mode:
        """What to call it."""
        if self.writer is not None:
            return Mode.RECORDING
        return Mode.ARMED if self.newest is not None and self.newest.gate.armed else Mode.WATCHING

    @property
    def recording(self) -> Recording:
        """What has happened so far."""
        return Recording(self.info, tuple(self.samples))


class Perform:
    """Let the robot perform a trajectory alone; see `lesson_alone` and `replay`."""

    mode = Mode.PLAYING

    def __init__(
        self,
        trajectory: Trajectory,
        duration: float,
        arms: Arms,
        mapping: Mapping,
        hands: HandTrack | None = None,
    ) -> None:
        self.time, self.duration = 0.0, duration + SETTLE
        self.world = start_world(arms, mapping, PLAIN if hands is None else hands.options)
        self.lesson: Lesson | None = None  # what is performed, if it was learned
        self._ghost: Demonstration | None = None
        self._motion, self._arms, self._mapping = duration, arms, mapping
        self._ready = self.world.state.joint_positions
        self._ticks: list[Tick] = []
        self._steps = perform_steps(self.world, trajectory, duration, arms, mapping, hands)

    @classmethod
    def lesson_alone(cls, lesson: Lesson, ghost: Demonstration | None) -> "Perform":
        """Return the performance of what was learned, beside the ghost of a demonstration."""
        taught = lesson.taught
        alone = cls(lesson.trajectory(), taught.duration, taught.arms, taught.mapping, taught.hands)
        alone.lesson, alone._ghost = lesson, ghost
        return alone

    @classmethod
    def replay(cls, demonstration: Demonstration) -> "Perform":
        """Return the replay of a demonstration."""
        shown = demonstration
        return cls(shown.trajectory(), shown.duration, shown.arms, shown.mapping, shown.hands)

    def step(self) -> bool:
        """Do one tick."""
        tick = next(self._steps, None)
        if tick is None:
            return False
        self.time = max(tick.time, 0.0)  # below 0 it is on its way to where the motion begins
        self._ticks.append(tick)
        return True

    def close(self) -> None:
        """Nothing to keep."""

    @property
    def guarded(self) -> str:
        """What the guard keeps apart."""
        return self._ticks[-1].command.guarded if self._ticks else ""

    @property
    def guarded_ticks(self) -> int:
        """How many ticks the guard has changed, those of the way to the beginning included."""
        return sum(1 for tick in self._ticks if tick.command.guarded)

    @property
    def ghost(self) -> FloatArray | None:
        """The ghost's joints (15,) [rad], at the same share of its own duration."""
        if self._ghost is None:
            return None
        share = min(self.time / self._motion, 1.0)
        return demonstration_at(self._ghost, share * self._ghost.duration).joints

    @property
    def performance(self) -> Performance:
        """The whole performance, once it has come to its end."""
        return Performance.of(self._arms, self._mapping, self._motion, self._ready, self._ticks)


def next_recording_path(folder: Path) -> Path:
    """Return the first free ``demonstration-001.mcap`` in a folder."""
    for number in range(1, 10_000):
        path = folder / f"demonstration-{number:03d}.mcap"
        if not path.exists():
            return path
    raise FileError(f"{folder}: holds 9,999 demonstrations; move some away")
