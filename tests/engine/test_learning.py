"""Learning in a session's ticks: what is asked for comes first, what is outdated ends."""

import time
from collections.abc import Callable

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.curves import COUNTS, BlockCurve, ErrorCurve, Explaining, Training
from studio.engine.errors import StudioError
from studio.engine.export.equations import equations_of
from studio.engine.learning import PATIENCE, Learning
from studio.engine.listed import Listed
from studio.engine.snapshot import Mode
from studio.engine.teaching import LearnerSettings, learn, reproduce
from studio.engine.work import Done, Progress, Report, Work
from studio.engine.worker import Task
from studio.engine.workplace import InTicks
from tests.engine.export.materials import listed
from tests.engine.long_work import PATIENCE as SECONDS

LEFT = Choices()
RBF = LearnerSettings("rbf", 8)


class Bench:
    """A list of two shipped demonstrations, and learning beside it."""

    def __init__(self, work: InTicks | Work) -> None:
        self.listed = Listed()
        self.listed.add(listed(2).takes)
        self.work = work
        self.learning = Learning(self.listed, work)

    def do(self, command) -> str:
        return self.learning.take(command, LEFT)

    def tick(self, ticks: int = 1, mode: Mode = Mode.IDLE) -> list[str]:
        said = [self.learning.tick(LEFT, mode) for _ in range(ticks)]
        return [words for words in said if words]

    @property
    def status(self):
        return self.learning.status


@pytest.fixture
def bench() -> Bench:
    made = Bench(InTicks(has_time=True))
    made.tick()
    return made


def test_training_is_begun_at_once_and_heard_of_at_a_tick(bench: Bench) -> None:
    assert bench.do(commands.Train(RBF)) == ""
    assert bench.learning.mode(Mode.IDLE) is Mode.TRAINING
    assert bench.learning.mode(Mode.PLAYING) is Mode.PLAYING
    assert bench.status.underway.words == "training 8 neurons"
    assert bench.learning.lesson is None
    assert bench.tick() == ["Learned with 8 neurons. Now let Baxter play it."]
    assert bench.learning.mode(Mode.IDLE) is Mode.IDLE
    taught = bench.listed.taught("left", "exact")
    expected = learn(taught, RBF)
    assert np.array_equal(bench.learning.lesson.curve, expected.curve)
    assert bench.status.chosen == RBF


def test_a_lesson_is_of_the_listed_demonstrations_themselves(bench: Bench) -> None:
    """Not of the copies that came back from another process."""
    bench.do(commands.Train(RBF))
    bench.tick()
    own = [entry.demonstration for entry in bench.listed.entries]
    assert list(bench.learning.lesson.taught.demonstrations) == own


def test_only_one_thing_is_waited_for(bench: Bench) -> None:
    bench.do(commands.Train(RBF))
    with pytest.raises(StudioError, match="Press Cancel first: training 8 neurons goes on"):
        bench.do(commands.Guess(RBF, falls=True))
    assert bench.do(commands.CancelWork()) == "Canceled: training 8 neurons."
    assert bench.do(commands.CancelWork()) == "Nothing is being computed."
    assert bench.tick(3) == []
    assert bench.learning.lesson is None


def test_nothing_taught_begins_nothing(bench: Bench) -> None:
    right = Choices("right")
    for command in (
        commands.Train(RBF),
        commands.Guess(RBF, falls=True),
        commands.RevealBlocks("rbf"),
    ):
        with pytest.raises(StudioError, match="record one first"):
            bench.learning.take(command, right)
    assert bench.work.task is None
    assert bench.learning.tick(right, Mode.IDLE) == ""
    for _ in range(PATIENCE + 3):
        bench.learning.tick(right, Mode.IDLE)
    assert bench.work.task is None


def test_the_curve_draws_itself_when_all_is_quiet(bench: Bench) -> None:
    bench.tick(PATIENCE)
    assert not bench.status.is_drawing
    bench.tick(2)
    assert bench.status.is_drawing
    assert bench.learning.mode(Mode.IDLE) is Mode.IDLE  # nobody waits for it
    bench.tick(len(COUNTS) + 1)
    curve = bench.status.curve
    assert not bench.status.is_drawing
    assert [point.neurons for point in curve.points] == list(COUNTS)
    assert curve.suggestion.neurons in COUNTS
    bench.tick(3)
    assert bench.work.task is None
    assert bench.status.curve is curve


def test_the_curve_waits_while_somebody_teaches(bench: Bench) -> None:
    for mode in (Mode.WATCHING, Mode.ARMED, Mode.RECORDING, Mode.CALIBRATING):
        bench.tick(PATIENCE + 3, mode)
        assert bench.work.task is None


def test_without_time_nothing_is_done_that_nobody_asked_for() -> None:
    bench = Bench(InTicks())
    bench.do(commands.Train(RBF))
    bench.tick(PATIENCE + 5)
    assert bench.work.task is None
    assert bench.status.curve.points == ()
    assert dict(bench.status.equations) == {}


@pytest.mark.parametrize(
    "change",
    [
        commands.Include(1, included=False),
        commands.Trim(1, 0.5, 4.0),
    ],
)
def test_a_curve_of_other_demonstrations_ends(bench: Bench, change) -> None:
    bench.tick(PATIENCE + 5)
    drawn = bench.status.curve
    assert bench.status.is_drawing
    bench.listed.take(change)
    bench.tick()
    assert not bench.status.is_drawing
    assert bench.status.curve.points == ()
    bench.tick(PATIENCE + len(COUNTS) + 2)
    assert bench.status.curve.at(1) != drawn.at(1)


def test_a_new_name_changes_nothing(bench: Bench) -> None:
    bench.tick(PATIENCE + 5)
    before = bench.status.curve.points
    bench.listed.take(commands.Rename(1, "waves"))
    bench.tick()
    assert bench.status.curve.points[: len(before)] == before


def test_another_learner_has_a_curve_of_its_own_and_the_first_is_kept(bench: Bench) -> None:
    bench.tick(PATIENCE + 5)
    rbf = bench.status.curve
    bench.do(commands.ChooseLearner(LearnerSettings("newrb", 5)))
    assert not bench.status.is_drawing
    bench.tick(PATIENCE + 5)
    assert isinstance(bench.work.task, ErrorCurve)
    assert bench.work.task.learner == "newrb"
    assert bench.status.curve.points
    bench.do(commands.ChooseLearner(RBF))
    assert bench.status.curve is rbf
    bench.tick(PATIENCE + 2)
    assert bench.work.task.counts == rbf.missing  # and goes on where it was


def test_dragging_the_slider_does_not_disturb_the_curve(bench: Bench) -> None:
    bench.tick(PATIENCE + 3)
    for neurons in range(20, 30):
        bench.do(commands.ChooseLearner(LearnerSettings("rbf", neurons)))
        bench.tick()
    assert len(bench.status.curve.points) >= 10


def test_what_is_asked_for_comes_before_the_curve_which_goes_on_after(bench: Bench) -> None:
    bench.tick(PATIENCE + 5)
    drawn = bench.status.curve.points
    bench.do(commands.Train(RBF))
    assert isinstance(bench.work.task, Training)
    bench.tick()
    assert isinstance(bench.work.task, Explaining)
    bench.tick()
    assert isinstance(bench.work.task, ErrorCurve)
    assert bench.status.curve.points[: len(drawn)] == drawn


def test_a_stopped_curve_says_so_and_goes_on_when_asked(bench: Bench) -> None:
    bench.tick(PATIENCE + 5)
    assert bench.learning.cancel() == ""
    assert bench.status.curve.note == "stopped"
    bench.tick(PATIENCE)
    assert not bench.status.is_drawing
    bench.do(commands.ResumeCurve())
    bench.tick(len(COUNTS))
    assert bench.status.curve.missing == ()


def test_a_curve_that_fails_says_why_and_does_not_begin_anew(bench: Bench, monkeypatch) -> None:
    def fail(*_: object) -> None:
        raise StudioError("too few samples")

    monkeypatch.setattr("studio.engine.curves.error_point", fail)
    assert bench.tick(PATIENCE + 5) == []
    assert bench.status.curve.note == "The error curve came to nothing: too few samples"
    assert bench.work.task is None


def test_what_somebody_waited_for_fails_aloud(bench: Bench, monkeypatch) -> None:
    def fail(*_: object) -> None:
        raise StudioError("too few samples")

    monkeypatch.setattr("studio.engine.curves.learn", fail)
    bench.do(commands.Train(RBF))
    with pytest.raises(StudioError, match="Training came to nothing: too few samples"):
        bench.tick()
    assert bench.status.underway is None


def test_a_guess_is_answered_and_counted(bench: Bench) -> None:
    bench.do(commands.Guess(LearnerSettings("rbf", 2), falls=True))
    assert bench.status.outcome is None
    assert bench.tick() == ["With 2 neurons the block stays up, not as you said."]
    assert bench.status.outcome.point.block_down is False
    bench.do(commands.Guess(RBF, falls=True))
    assert bench.tick() == ["With 8 neurons the block falls, as you said."]
    assert (bench.status.guesses, bench.status.right) == (2, 1)
    lesson, done = bench.learning.lesson, bench.learning.reproduction
    assert lesson.settings == RBF
    expected = reproduce(lesson)
    assert done.deviation.hand_mean == expected.deviation.hand_mean
    point = bench.status.outcome.point
    assert point.hand_error == expected.deviation.hand_mean
    assert point.mse == lesson.mse.mean()
    with pytest.raises(StudioError, match="8 neurons: you know that already"):
        bench.do(commands.Guess(RBF, falls=False))


def test_all_is_revealed_but_what_is_known(bench: Bench) -> None:
    bench.do(commands.Guess(LearnerSettings("rbf", 2), falls=False))
    bench.tick()
    bench.do(commands.RevealBlocks("rbf"))
    task = bench.work.task
    assert isinstance(task, BlockCurve)
    assert 2 not in task.counts
    bench.tick(2)
    assert bench.status.underway.share == pytest.approx(2 / len(task.counts))
    assert [(each.point.neurons, each.guess) for each in bench.status.tried] == [
        (2, False),
        (1, None),
        (3, None),
    ]
    bench.learning.cancel()
    bench.tick(2)
    assert len(bench.status.tried) == 3  # what is known stays


def test_trials_of_other_demonstrations_are_forgotten(bench: Bench) -> None:
    bench.do(commands.Guess(LearnerSettings("rbf", 2), falls=False))
    bench.tick()
    bench.do(commands.Guess(RBF, falls=True))
    bench.listed.take(commands.Include(1, included=False))
    (said,) = bench.tick()
    assert said == "Canceled: trying 8 neurons. The demonstrations have changed."
    assert bench.status.tried == ()


def test_equations_come_by_themselves_and_know_what_was_done(bench: Bench) -> None:
    bench.do(commands.Train(RBF))
    bench.tick(3)
    lesson = bench.learning.lesson
    assert dict(bench.status.equations) == equations_of(lesson)
    done = reproduce(lesson)
    bench.learning.judge(lesson, done.performance)
    bench.tick()
    known = bench.status.equations
    assert dict(known) == equations_of(lesson, done)
    bench.tick()
    assert bench.status.equations is known
    bench.do(commands.Train(LearnerSettings("rbf", 9)))
    bench.tick()
    assert dict(bench.status.equations) == {}


class TellsTwice(InTicks):
    """Tells of a last point before its end, as a process does on a busy machine."""

    def __init__(self) -> None:
        super().__init__(has_time=True)
        self._end: Done | None = None

    @property
    def task(self) -> Task | None:
        return super().task if self._end is None else self._end.task

    def poll(self) -> Report | None:
        if self._end is not None:
            end, self._end = self._end, None
            return end
        report = super().poll()
        if not isinstance(report, Done):
            return report
        self._end = report
        return Progress(report.handle, report.task, report.points)


def test_what_was_done_is_known_whatever_is_told_first() -> None:
    bench = Bench(TellsTwice())
    bench.tick()
    bench.do(commands.Guess(RBF, falls=True))
    bench.tick(6)
    learning = bench.learning
    assert dict(bench.status.equations) == equations_of(learning.lesson, learning.reproduction)


def test_other_joints_forget_all_and_end_the_training(bench: Bench) -> None:
    bench.do(commands.Train(RBF))
    bench.tick(3)
    bench.do(commands.Train(RBF))
    bench.learning.forget()
    assert bench.tick(3) == []
    assert bench.learning.lesson is None
    assert dict(bench.status.equations) == {}


def until(bench: Bench, reached: Callable[[], bool]) -> int:
    """Tick at 100 Hz until something is reached; return how many ticks that took."""
    ticks, begin = 0, time.monotonic()
    while not reached():
        assert time.monotonic() - begin < SECONDS
        bench.tick()
        ticks += 1
        time.sleep(0.01)
    return ticks


def test_in_a_process_the_same_is_found_and_no_tick_waits() -> None:
    """Where a tick waited there would be two."""
    here = Bench(InTicks(has_time=True))
    here.tick()
    here.do(commands.Guess(RBF, falls=True))
    here.tick(PATIENCE + len(COUNTS) + 5)
    there = Bench(Work(time.monotonic))
    try:
        there.tick()
        there.do(commands.Guess(RBF, falls=True))
        ticks = until(there, lambda: there.status.outcome is not None)
        ticks += until(there, lambda: not there.status.curve.missing)
        expected = here.status
        until(there, lambda: there.status.equations.keys() == expected.equations.keys())
        found = there.status
    finally:
        there.learning.close()
    assert ticks > 5
    assert found.outcome.point.block_down == expected.outcome.point.block_down
    for theirs, mine in zip(found.curve.points, expected.curve.points, strict=True):
        assert theirs.mse == pytest.approx(mine.mse)
