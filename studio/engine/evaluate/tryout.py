"""The test in the browser: what was learned does its task many times, beside the demonstrations.

In each trial one of the demonstrations does it too, in turn, so that the test takes twice as long
as the trials alone and not once more for every demonstration.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from studio.engine.evaluate.interval import Rate, rate_of
from studio.engine.evaluate.runs import Conditions, Trial, checked_count
from studio.engine.evaluate.subject import subject_of_lesson
from studio.engine.evaluate.trial import Outcome
from studio.engine.evaluate.variation import Variations
from studio.engine.scene import Scene
from studio.engine.teaching import Lesson


@dataclass(frozen=True)
class TryoutPoint:
    """One trial, done by what was learned and by a demonstration's own replay."""

    alone: Outcome
    replayed: Outcome


@dataclass(frozen=True, eq=False)
class TryoutRun:
    """A task for a workplace: so many trials, each a point `TryoutPoint`.

    Raises
    ------
    StudioError
        Where the number of trials is impossible.
    """

    lesson: Lesson
    scene: Scene
    size: int  # trials

    name = "the test"

    def __post_init__(self) -> None:
        checked_count("trials", self.size)

    def points(self) -> Iterator[TryoutPoint]:
        """Yield the trials in their order."""
        subject = subject_of_lesson(self.lesson, self.scene)
        conditions = Conditions(self.scene, Variations(), 0)
        for trial in range(self.size):
            replay = subject.replays[trial % len(subject.replays)]
            alone = Trial(subject.motion, trial, conditions).run()
            yield TryoutPoint(alone, Trial(replay, trial, conditions).run())


@dataclass(frozen=True, eq=False)
class TryoutStatus:
    """What a session shows of the newest test."""

    lesson: Lesson | None = None  # whose test it is; None before the first one
    asked: int = 0  # trials
    rate: Rate | None = None  # of what was learned; None before the first trial is over
    replayed: Rate | None = None  # of the demonstrations in the same trials
    failures: tuple[tuple[str, int], ...] = ()  # why, and how often; the most frequent first
    goes_on: bool = False

    @classmethod
    def of(cls, run: TryoutRun, points: Sequence[object], goes_on: bool) -> "TryoutStatus":
        """Return what is known after some of a test's points."""
        known = [point for point in points if isinstance(point, TryoutPoint)]
        if not known:
            return cls(run.lesson, run.size, goes_on=goes_on)
        whys = Counter(point.alone.why for point in known if not point.alone.done)
        return cls(
            run.lesson,
            run.size,
            rate_of(sum(point.alone.done for point in known), len(known)),
            rate_of(sum(point.replayed.done for point in known), len(known)),
            tuple(sorted(whys.items(), key=lambda each: (-each[1], each[0]))),
            goes_on,
        )

    @property
    def words(self) -> str:
        """What came of it, in a sentence."""
        if self.rate is None or self.replayed is None:
            return "Testing."
        return (
            f"{self.rate.successes} of {self.rate.trials} times the task was done; by the "
            f"demonstrations' own replays {self.replayed.successes} times."
        )
