"""What can be put on the timeline: looked at by time, never simulated twice.

A demonstration is shown as its recording has it: the person, the robot as measured, the blocks. A
lesson's performance is simulated a few ticks ahead at a time, faster than anybody can watch.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from studio.engine.compare_status import named
from studio.engine.export.material import Take
from studio.engine.moment import Moment, demonstration_at, performance_at, recording_at, skeleton_at
from studio.engine.perform import Perform
from studio.engine.performance import SETTLE, Performance
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.skeleton import FloatArray, Skeleton
from studio.engine.teaching import Lesson
from studio.engine.world import Scene, World, WorldState

# Ticks simulated in one of the session's, by all robots together: of about 1 ms each. It is more
# than the two that the playhead takes at its fastest, so that the playhead never waits.
BUDGET = 8


@dataclass(frozen=True, eq=False)
class Seen:
    """What there is at one time."""

    world: WorldState
    guarded: str = ""  # what the collision guard keeps apart, in words
    ghost: FloatArray | None = None  # (15,) [rad] of the demonstration that goes along
    skeleton: Skeleton | None = None  # of the person who showed it
    beside: WorldState | None = None  # of the second robot


class Film(Protocol):
    """What a timeline needs of what is on it."""

    title: str
    words: str  # what is said when it begins
    duration: float  # [s]
    motion: float  # [s] of it, before everything settles

    @property
    def scene(self) -> Scene:
        """What stands around the first robot, for its arms."""
        ...

    @property
    def world(self) -> World | None:
        """Where the first robot is simulated, if it has to be."""
        ...

    @property
    def is_ready(self) -> bool:
        """Whether its beginning can be seen."""
        ...

    @property
    def is_whole(self) -> bool:
        """Whether all of it can be seen."""
        ...

    def advance(self) -> None:
        """Do one tick's share of what has to be simulated yet."""
        ...

    def at(self, time: float) -> Seen:
        """Return what there is at ``time`` [s]; before its beginning and after its end it stands.

        What is not simulated yet is shown as far as it is.
        """
        ...

    def close(self) -> None:
        """Free all worlds but the first robot's, which goes to whatever comes next."""
        ...


class DemonstrationFilm:
    """A demonstration as it was recorded, and what the block does after it."""

    is_ready = is_whole = True
    world: World | None = None

    def __init__(self, take: Take) -> None:
        self.take, self.title = take, take.demonstration.name
        self.scene = take.demonstration.scene.taught_by(take.demonstration.arms)
        self.words = f"{self.title}, as it was recorded."
        self.motion = take.demonstration.duration
        samples, first = take.recording.samples, take.demonstration.first_sample
        last = take.demonstration.last_sample + round(SETTLE * CONTROL_RATE)
        self._begun = first * CONTROL_PERIOD
        self.duration = (min(last, len(samples) - 1) - first + 1) * CONTROL_PERIOD

    def advance(self) -> None:
        """Nothing to simulate."""

    def at(self, time: float) -> Seen:
        """Return what there was."""
        samples = self.take.recording.samples
        within = min(max(time, 0.0), self.duration)
        moment = recording_at(self.take.recording, self._begun + within)
        sample = samples[moment.index]
        return Seen(
            _state(sample.world, moment),
            sample.guarded,
            skeleton=skeleton_at(samples, moment.index),
        )

    def close(self) -> None:
        """Nothing to free."""


class Solo:
    """One robot doing alone what it learned: known already, or being simulated."""

    def __init__(self, lesson: Lesson, scene: Scene, known: Performance | None = None) -> None:
        self.lesson, self.scene, self.performance = lesson, scene, known
        self._simulated = None if known is not None else Perform.of(lesson, scene)

    @property
    def is_whole(self) -> bool:
        """Whether all of it is known."""
        return self._simulated is None or self._simulated.is_over

    @property
    def world(self) -> World | None:
        """Where it is simulated."""
        return None if self._simulated is None else self._simulated.world

    def advance(self, ticks: int) -> None:
        """Simulate some ticks more, if any are left."""
        if self._simulated is None or self._simulated.is_over:
            return
        for _ in range(ticks):
            if not self._simulated.step():
                break
        self.performance = self._simulated.performance

    def at(self, time: float) -> tuple[WorldState, str]:
        """Return its world, and what the guard keeps apart in words."""
        if self.performance is None:  # on its way to where the motion begins
            coming = self._simulated
            if coming is None:
                raise LookupError("a performance without a tick")
            return coming.world.state, coming.guarded
        moment = performance_at(self.performance, time)
        tick = self.performance.ticks[moment.index]
        return _state(tick.world, moment), tick.command.guarded


class LessonFilm:
    """One robot or two doing alone what they learned, beside the ghost of a demonstration."""

    def __init__(self, solos: Sequence[Solo], ghost: Take | None) -> None:
        self.solos, self.ghost = tuple(solos), ghost
        one = len(self.solos) == 1
        name = named(self.lesson)
        self.title = f"Baxter alone: {name}" if one else f"A: {name}, beside B"
        self.words = "Baxter does it alone." if one else "Both robots do it alone, A and B."
        self.motion = self.lesson.taught.duration
        self.duration = max(solo.lesson.taught.duration for solo in self.solos) + SETTLE

    @property
    def lesson(self) -> Lesson:
        """What the first robot learned."""
        return self.solos[0].lesson

    @property
    def scene(self) -> Scene:
        """What stands around the first robot."""
        return self.solos[0].scene

    @property
    def world(self) -> World | None:
        """Where the first robot is simulated, if it has to be."""
        return self.solos[0].world

    @property
    def is_ready(self) -> bool:
        """Whether all robots have come to where their motion begins."""
        return all(solo.performance is not None for solo in self.solos)

    @property
    def is_whole(self) -> bool:
        """Whether all robots are through."""
        return all(solo.is_whole for solo in self.solos)

    def advance(self) -> None:
        """Simulate some ticks of whoever is not through."""
        waiting = [solo for solo in self.solos if not solo.is_whole]
        for solo in waiting:
            solo.advance(BUDGET // len(waiting))

    def at(self, time: float) -> Seen:
        """Return both robots, the ghost, and the person who showed it."""
        world, guarded = self.solos[0].at(time)
        seen = Seen(world, guarded)
        if len(self.solos) > 1:
            seen = replace(seen, beside=self.solos[1].at(time)[0])
        if self.ghost is None:
            return seen
        share = min(max(time, 0.0) / self.lesson.taught.duration, 1.0)
        shown = self.ghost.demonstration
        moment = demonstration_at(shown, share * shown.duration)
        skeleton = skeleton_at(self.ghost.recording.samples, moment.index)
        return replace(seen, ghost=moment.joints, skeleton=skeleton)

    def close(self) -> None:
        """Free the second robot's world."""
        for solo in self.solos[1:]:
            if solo.world is not None:
                solo.world.close()


def _state(world: WorldState, moment: Moment) -> WorldState:
    """Return a tick's world with what moves where a moment has it."""
    return replace(
        world,
        joint_positions=moment.joints,
        block_poses=world.block_poses if moment.block_poses is None else moment.block_poses,
        fingers=world.fingers if moment.fingers is None else moment.fingers,
    )
