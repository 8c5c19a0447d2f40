"""The curves' points are the numbers that the table and the experiment tell too."""

import time

import numpy as np
import pytest

from studio.engine.curves import (
    COUNTS,
    MOST_SHOWN,
    BlockCurve,
    ErrorCurve,
    Explaining,
    TableRun,
    Training,
    TrialRun,
    block_point,
    counts_of,
    error_point,
)
from studio.engine.demonstration import SAMPLES, DemonstrationSet
from studio.engine.errors import StudioError
from studio.engine.export.equations import equations_of
from studio.engine.learners import kind_of
from studio.engine.paper import paper_table
from studio.engine.sweep import measure
from studio.engine.teaching import LEARNERS, LearnerSettings, learn, reproduce
from tests.engine.sweeps import Ticking, samples


@pytest.mark.parametrize("neurons", [1, 7, 40])
def test_errors_are_those_of_the_table(neurons: int) -> None:
    """Two roads: a lesson's own errors, and the sweep's."""
    table = measure(kind_of("rbf"), {"neurons": neurons}, samples().rows, Ticking())
    point = error_point(samples(), LearnerSettings("rbf", neurons))
    assert point.neurons == neurons
    assert point.mse == pytest.approx(table.mse.mean())
    assert point.floor_ratio == pytest.approx(table.floor_ratio)
    assert point.held_out == pytest.approx(table.held_out)
    assert point.held_out_ratio == pytest.approx(table.held_out_ratio)


def test_more_neurons_err_less_down_to_the_floor() -> None:
    points = list(ErrorCurve(samples(), "rbf", (2, 5, 12, 30)).points())
    ratios = [point.floor_ratio for point in points]
    assert ratios == sorted(ratios, reverse=True)
    assert 1.0 <= ratios[-1] < 1.1
    assert ratios[0] > 2.0


def test_a_single_demonstration_has_no_floor_and_nothing_to_leave_out() -> None:
    alone = DemonstrationSet.of(samples().demonstrations[:1])
    point = error_point(alone, LearnerSettings("newrb", 10))
    assert (point.floor_ratio, point.held_out, point.held_out_ratio) == (None, None, None)
    assert point.mse > 0.0


def test_too_few_neurons_leave_the_block_standing() -> None:
    curve = BlockCurve(samples(), "rbf", (1, 20))
    failing, succeeding = curve.points()
    assert (failing.block_down, succeeding.block_down) == (False, True)
    assert failing.hand_error > 5.0 * succeeding.hand_error
    alone = reproduce(learn(samples(), LearnerSettings("rbf", 20)))
    assert succeeding.hand_error == alone.deviation.hand_mean
    assert succeeding.mse == error_point(samples(), LearnerSettings("rbf", 20)).mse
    assert block_point(samples(), LearnerSettings("rbf", 20)) == succeeding


def test_one_lesson_and_one_trial() -> None:
    settings = LearnerSettings("rbf", 9)
    (lesson,) = Training(samples(), settings).points()
    assert np.array_equal(lesson.curve, learn(samples(), settings).curve)
    (trial,) = TrialRun(samples(), settings).points()
    assert np.array_equal(trial.lesson.curve, lesson.curve)
    point = block_point(samples(), settings)
    assert trial.reproduction.deviation.hand_mean == point.hand_error


def test_a_table() -> None:
    (table,) = TableRun(samples(2), time.perf_counter, ("rbf",), (5, 9)).points()
    assert [row.neurons for row in table.rows] == [5, 9]


def test_tasks_say_how_much_there_is_to_do() -> None:
    for curve in (ErrorCurve, BlockCurve):
        assert curve(samples(), "rbf", (1, 2, 3)).size == 3
        with pytest.raises(StudioError, match="neurons"):
            curve(samples(), "rbf", (0, 5))
        with pytest.raises(StudioError, match="neurons"):
            curve(samples(), "rbf", ())


def test_counts_are_round_and_about_even_on_a_logarithmic_scale() -> None:
    assert (COUNTS[0], COUNTS[-1]) == (1, MOST_SHOWN)
    assert tuple(sorted(set(COUNTS))) == COUNTS
    ratios = np.array(COUNTS[3:]) / COUNTS[2:-1]
    assert ratios.max() < 1.5
    assert {row.neurons for row in paper_table()} | {SAMPLES} <= set(COUNTS)
    for learner in LEARNERS:
        assert set(counts_of(learner)) <= set(COUNTS)


def test_equations_of_a_lesson() -> None:
    lesson = learn(samples(2), LearnerSettings("rbf", 9))
    (found,) = Explaining(lesson).points()
    assert found == equations_of(lesson)
