"""What a session does for a while: follow a source, perform a motion, or hold still.

Each is a small object with ``step``: one tick, in the world that it owns; it returns False after
its last one. All but `Follow` leave no trace on disk.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Protocol

import numpy as np

from studio.engine.demonstration import Demonstration
from studio.engine.errors import FileError
from studio.engine.follow import follow_steps
from studio.engine.mcap_file import RecordingWriter
from studio.engine.performance import (
    SETTLE,
    Performance,
    Tick,
    Trajectory,
    perform_steps,
    start_world,
    whole_body,
)
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording, RecordingInfo, Sample
from studio.engine.retarget import Mapping
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.skeleton import FloatArray, Side, Skeleton
from studio.engine.sources import SkeletonRecording
from studio.engine.teaching import Lesson
from studio.engine.world import World


class Activity(Protocol):
    """What a session needs of an activity."""

    world: World
    time: float  # [s] since it began
    duration: float  # [s] that it takes, 0 for no end

    def step(self) -> bool:
        """Do one tick; return whether another one follows."""
        ...

    def close(self) -> None:
        """End it, keeping what was recorded; may be called twice."""
        ...


class Hold:
    """Hold still where a world has been left."""

    duration = 0.0

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
    """Let the robot follow a source, recording it if a path is given."""

    def __init__(self, stream: SkeletonRecording, pipeline: Pipeline, path: Path | None) -> None:
        self.time, self.duration = 0.0, stream.seconds
        self.info = RecordingInfo.of(pipeline, stream)
        self.samples: list[Sample] = []
        self.skeleton: Skeleton | None = None  # the newest one
        self.writer = None if path is None else RecordingWriter(path, self.info)
        self.world = start_world(pipeline.side, pipeline.mapping)
        self._steps: Iterator[Sample] = follow_steps(stream, pipeline, self.world)

    def step(self) -> bool:
        """Do one tick and write it down at once, so that a crash loses less than a second."""
        sample = next(self._steps, None)
        if sample is None:
            return False
        self.time = sample.time
        self.samples.append(sample)
        self.skeleton = sample.skeleton or self.skeleton
        if self.writer is not None:
            self.writer.write(sample)
        return True

    def close(self) -> None:
        """Finish the recording's file."""
        if self.writer is not None:
            self.writer.close()

    @property
    def recording(self) -> Recording:
        """What has happened so far."""
        return Recording(self.info, tuple(self.samples))


class Perform:
    """Let the robot perform a trajectory alone; see `lesson_alone` and `replay`."""

    def __init__(
        self, trajectory: Trajectory, duration: float, side: Side, mapping: Mapping
    ) -> None:
        self.time, self.duration = 0.0, duration + SETTLE
        self.world = start_world(side, mapping)
        self.lesson: Lesson | None = None  # what is performed, if it was learned
        self._ghost: Demonstration | None = None
        self._motion, self._side, self._mapping = duration, side, mapping
        self._start = self.world.state.joint_positions
        self._ticks: list[Tick] = []
        self._steps = perform_steps(self.world, trajectory, duration, side, mapping)

    @classmethod
    def lesson_alone(cls, lesson: Lesson, ghost: Demonstration | None) -> "Perform":
        """Return the performance of what was learned, beside the ghost of a demonstration."""
        taught = lesson.taught
        alone = cls(lesson.trajectory(), taught.duration, taught.side, taught.mapping)
        alone.lesson, alone._ghost = lesson, ghost
        return alone

    @classmethod
    def replay(cls, demonstration: Demonstration) -> "Perform":
        """Return the replay of a demonstration."""
        shown = demonstration
        return cls(shown.trajectory(), shown.duration, shown.side, shown.mapping)

    def step(self) -> bool:
        """Do one tick."""
        tick = next(self._steps, None)
        if tick is None:
            return False
        self.time = tick.time
        self._ticks.append(tick)
        return True

    def close(self) -> None:
        """Nothing to keep."""

    @property
    def ghost(self) -> FloatArray | None:
        """The ghost's joints (15,) [rad], at the same share of its own duration."""
        if self._ghost is None:
            return None
        share = min(self.time / self._motion, 1.0)
        row = self._ghost.at(np.array([share * self._ghost.duration]))
        body: FloatArray = whole_body(row, self._ghost.side, self._ghost.joints)[0]
        return body

    @property
    def performance(self) -> Performance:
        """The whole performance, once it has come to its end."""
        return Performance(self._side, self._mapping, self._motion, self._start, tuple(self._ticks))


def next_recording_path(folder: Path) -> Path:
    """Return the first free ``demonstration-001.mcap`` in a folder."""
    for number in range(1, 10_000):
        path = folder / f"demonstration-{number:03d}.mcap"
        if not path.exists():
            return path
    raise FileError(f"{folder}: holds 9,999 demonstrations; move some away")
