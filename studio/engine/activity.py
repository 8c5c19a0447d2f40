"""What a session does for a while: follow a source or hold still; `showing` what is over.

Each is a small object with ``step``: one tick, in the world that it owns; it returns False after
its last one. All but `Follow` leave no trace on disk.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Protocol

from studio.engine.demonstration import SHORTEST
from studio.engine.follow import follow_steps
from studio.engine.performance import start_world
from studio.engine.pipeline import Pipeline
from studio.engine.recording import RecordingInfo, Sample
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.scene import USUAL, Scene
from studio.engine.skeleton import Skeleton
from studio.engine.snapshot import Mode
from studio.engine.tape import NO_PLAN, Plan, Tape
from studio.engine.teachers import Teacher
from studio.engine.world import World

REST = 1.0  # [s] after a demonstration, in which the block falls or stays


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
    """Let the robot follow a teacher, recording it if a path is given.

    ``scene`` is what stands around, ``usual`` the same before anybody moved a block.
    """

    def __init__(
        self,
        teacher: Teacher,
        pipeline: Pipeline,
        path: Path | None,
        scene: Scene | None = None,
        plan: Plan = NO_PLAN,
        usual: Scene = USUAL,
    ) -> None:
        self.teacher = teacher
        self.time, self.duration = 0.0, teacher.seconds
        self.info = RecordingInfo.of(pipeline, teacher, usual)
        self.newest: Sample | None = None
        self.skeleton: Skeleton | None = None  # the newest one
        self.tape = None if path is None else Tape(path, self.info, plan)
        self.world = start_world(pipeline.arms, pipeline.mapping, pipeline.hands.options, scene)
        self._shown, self._since = 0, 0  # ticks: of the newest armed stretch, and since it ended
        self._steps: Iterator[Sample] = follow_steps(
            teacher.frames(), pipeline, self.world, teacher.command_given
        )

    def step(self) -> bool:
        """Do one tick and write it down at once, so that a crash loses less than a second."""
        is_full = self.tape is not None and self.duration == 0.0 and self.tape.is_long_enough
        sample = None if is_full else next(self._steps, None)
        if sample is None:
            return False
        self.time, self.newest = sample.time, sample
        self.skeleton = sample.skeleton or self.skeleton
        self._count(sample)
        if self.tape is not None:
            self.tape.write(sample, self.teacher.latency)
        return True

    def begin_recording(self, path: Path) -> None:
        """Record from the next tick on; raise FileError where that cannot be written."""
        self.tape = Tape(path, self.info, NO_PLAN)

    def end_recording(self) -> Tape | None:
        """Record no more, but follow on; return what was recorded, if anything was."""
        ended, self.tape = self.tape, None
        if ended is not None:
            ended.close()
        return ended

    def close(self) -> None:
        """Finish the recording's file."""
        if self.tape is not None:
            self.tape.close()

    @property
    def guarded(self) -> str:
        """What the guard keeps apart."""
        return "" if self.newest is None else self.newest.guarded

    @property
    def samples(self) -> list[Sample]:
        """What has been recorded so far."""
        return [] if self.tape is None else self.tape.samples

    @property
    def take_is_over(self) -> bool:
        """Whether a recording that is to repeat has a demonstration, and the block came to rest."""
        repeats = self.tape is not None and self.tape.plan.repeats
        # A teacher with an end would do the same once more.
        return repeats and not self.duration and self._since >= REST * CONTROL_RATE

    @property
    def mode(self) -> Mode:
        """What to call it."""
        if self.tape is not None:
            return Mode.RECORDING
        return Mode.ARMED if self.newest is not None and self.newest.gate.armed else Mode.WATCHING

    def _count(self, sample: Sample) -> None:
        """Count the ticks of a demonstration, and since it ended; slips count for nothing."""
        if sample.gate.armed:
            self._shown = 1 if self._since else self._shown + 1
            self._since = 0
        elif self._shown >= SHORTEST * CONTROL_RATE:
            self._since += 1
        else:
            self._shown = 0
