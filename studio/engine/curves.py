"""What takes a while to find out about a set of demonstrations, as tasks that tell point by point.

A task is plain data with a ``points()`` that computes: here, or in another process
(`studio.engine.work`), with the same result. One is done when all its ``size`` points are there.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from studio.engine.demonstration import DemonstrationSet
from studio.engine.export.equation import Equation
from studio.engine.export.equations import learned_numbers
from studio.engine.sweep import Sweep, Timer, checked_neurons, sweep
from studio.engine.task_words import BLOCK, TaskWords, task_words
from studio.engine.teaching import (
    LEARNERS,
    LearnerName,
    LearnerSettings,
    Lesson,
    Reproduction,
    learn,
    reproduce,
)
from studio.rbf import leave_one_demonstration_out

# Of neurons: about evenly spread on a logarithmic scale up to the most of the paper's Table I, with
# all of that table, and as many as a demonstration has samples.
COUNTS = (
    *(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 15, 18, 20, 25, 30, 40, 50, 60, 75, 100, 125, 142),
    *(150, 200, 250, 300),
)
MOST_SHOWN = COUNTS[-1]
# A stable field takes 1 to 3 s, once for all demonstrations and once for each that is left out.
_OF_FIELDS = (2, 5, 10, 20, 50, 100)


@dataclass(frozen=True)
class ErrorPoint:
    """How well one number of neurons learns."""

    neurons: int
    mse: float  # [rad²] mean over joints and demonstrations
    floor_ratio: float | None  # over the floor that no network undercuts; None where there is none
    held_out: float | None  # [rad²] on demonstrations left out; None for a single one
    held_out_ratio: float | None  # over that of the other demonstrations' mean curve


@dataclass(frozen=True)
class BlockPoint:
    """What Baxter does alone with one number of neurons."""

    neurons: int
    block_down: bool
    mse: float  # [rad²] mean over joints and demonstrations
    hand_error: float  # [m] mean distance of the hand from the mean demonstration as sent
    done: bool = False  # the scene's task; of the paper's: block_down
    task: TaskWords = BLOCK  # how one says that


@dataclass(frozen=True, eq=False)
class Trial:
    """What was learned, and what Baxter made of it."""

    lesson: Lesson
    reproduction: Reproduction


@dataclass(frozen=True, eq=False)
class ErrorCurve:
    """Errors against numbers of neurons: an `ErrorPoint` for each.

    Raises
    ------
    StudioError
        Where a number of neurons is impossible.
    """

    taught: DemonstrationSet
    learner: LearnerName
    counts: tuple[int, ...]

    name = "the error curve"

    def __post_init__(self) -> None:
        checked_neurons(self.counts)

    @property
    def size(self) -> int:
        """How many points there will be."""
        return len(self.counts)

    def points(self) -> Iterator[ErrorPoint]:
        """Yield the points in the order of the counts."""
        return (error_point(self.taught, LearnerSettings(self.learner, n)) for n in self.counts)


@dataclass(frozen=True, eq=False)
class BlockCurve:
    """Whether the block falls, against numbers of neurons: a `BlockPoint` for each.

    Raises
    ------
    StudioError
        Where a number of neurons is impossible.
    """

    taught: DemonstrationSet
    learner: LearnerName
    counts: tuple[int, ...]

    name = "the curve of blocks"

    def __post_init__(self) -> None:
        checked_neurons(self.counts)

    @property
    def size(self) -> int:
        """How many points there will be."""
        return len(self.counts)

    def points(self) -> Iterator[BlockPoint]:
        """Yield the points in the order of the counts."""
        return (block_point(self.taught, LearnerSettings(self.learner, n)) for n in self.counts)


@dataclass(frozen=True, eq=False)
class Training:
    """One network taught: a `Lesson`."""

    taught: DemonstrationSet
    settings: LearnerSettings

    name, size = "training", 1

    def points(self) -> Iterator[Lesson]:
        """Yield the lesson."""
        yield learn(self.taught, self.settings)


@dataclass(frozen=True, eq=False)
class TrialRun:
    """One network taught and played by Baxter: a `Trial`."""

    taught: DemonstrationSet
    settings: LearnerSettings

    name, size = "the trial", 1

    def points(self) -> Iterator[Trial]:
        """Yield the trial."""
        lesson = learn(self.taught, self.settings)
        yield Trial(lesson, reproduce(lesson))


@dataclass(frozen=True, eq=False)
class Explaining:
    """The equations behind a lesson's numbers: one dictionary, see `learned_numbers`."""

    lesson: Lesson

    name, size = "the equations", 1

    def points(self) -> Iterator[dict[str, Equation]]:
        """Yield the equations by key."""
        yield learned_numbers(self.lesson)


@dataclass(frozen=True, eq=False)
class TableRun:
    """A table like the paper's Table I: a `Sweep`. The timer has to be a module's own function."""

    taught: DemonstrationSet
    timer: Timer
    learners: tuple[str, ...]
    neurons: tuple[int, ...]

    name, size = "the table", 1

    def points(self) -> Iterator[Sweep]:
        """Yield the table."""
        yield sweep(self.taught, self.timer, self.learners, self.neurons)


def counts_of(learner: LearnerName) -> tuple[int, ...]:
    """Return the numbers of neurons that a learner's curve has: few where each takes seconds."""
    return _OF_FIELDS if learner == "field" else COUNTS


def error_point(taught: DemonstrationSet, settings: LearnerSettings) -> ErrorPoint:
    """Return how well a network learns; the errors are those of `studio.engine.sweep`."""
    lesson = learn(taught, settings)
    floor, held_out = lesson.floor, None
    if len(taught.rows) > 1:
        untaught = LEARNERS[settings.name](settings.neurons)
        held_out = leave_one_demonstration_out(untaught, taught.rows)
    return ErrorPoint(
        neurons=settings.neurons,
        mse=float(lesson.mse.mean()),
        floor_ratio=None
        if floor is None or not floor.any()
        else float(lesson.mse.sum() / floor.sum()),
        held_out=None if held_out is None else float(held_out.mse.mean()),
        held_out_ratio=None if held_out is None else held_out.ratio,
    )


def block_point(taught: DemonstrationSet, settings: LearnerSettings) -> BlockPoint:
    """Teach a network, and return what Baxter makes of it in a fresh world."""
    lesson = learn(taught, settings)
    return block_point_of(lesson, reproduce(lesson))


def block_point_of(lesson: Lesson, found: Reproduction) -> BlockPoint:
    """Return a reproduction as a point of the curve."""
    return BlockPoint(
        neurons=lesson.settings.neurons,
        block_down=found.performance.block_down,
        mse=float(lesson.mse.mean()),
        hand_error=found.deviation.hand_mean,
        done=found.performance.done,
        task=task_words(lesson.taught.scene),
    )
