"""The plots show what was taught, learned and done, and nothing that is not known yet."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies
from hypothesis.extra import numpy as arrays

from studio.engine.arms import learned_joints
from studio.engine.demonstration import SAMPLES, resample
from studio.panels.plots import (
    SMALLEST_RANGE,
    JointPlot,
    Trace,
    axis_range,
    curves_of,
    shown_columns,
)


def test_nothing_taught_nothing_shown(lesson) -> None:
    assert curves_of(lesson["start"], Trace()) is None
    assert curves_of(lesson["recording"], Trace()) is None


def test_of_two_arms_one_is_shown_and_of_one_arm_all() -> None:
    both = learned_joints("both", "exact")
    for side, columns in (("left", [0, 1, 2, 3]), ("right", [4, 5, 6, 7])):
        assert shown_columns(both, side) == columns
        for arms in ("left", "right"):
            assert shown_columns(learned_joints(arms, "paper"), side) == [0, 1, 2]


def test_all_series_of_a_plot_are_equally_long_and_few(lesson) -> None:
    """The chart library takes unequal lengths in silence."""
    for state in ("recorded", "trained", "played"):
        curves = curves_of(lesson[state], Trace())
        assert curves.joints == ("left_s0", "left_s1", "left_e0", "left_e1")
        for column in range(len(curves.joints)):
            series = curves.of_joint(column)
            assert {len(each) for each in series} == {SAMPLES}
            assert len(series) == 7
    assert SAMPLES <= 300


def test_what_is_not_known_is_not_drawn(lesson) -> None:
    def known(state: str) -> list[bool]:
        curves = curves_of(lesson[state], Trace())
        shown = (curves.mean, curves.chosen, curves.network, curves.robot)
        return [bool(np.isfinite(each).all()) for each in shown]

    assert known("recorded") == [True, True, False, False]
    assert known("trained") == [True, True, True, False]
    assert known("played") == [True, True, True, True]
    assert np.isnan(curves_of(lesson["recorded"], Trace()).network).all()


def test_curves_are_the_real_data_in_degrees(lesson) -> None:
    now = lesson["played"]
    curves = curves_of(now, Trace())
    taught = now.lesson.taught
    assert curves.stamps[-1] == pytest.approx(taught.duration)
    np.testing.assert_allclose(np.radians(curves.network), now.lesson.curve)
    np.testing.assert_allclose(np.radians(curves.mean), taught.mean)
    chosen = now.entries[now.chosen].demonstration
    np.testing.assert_allclose(np.radians(curves.chosen), resample(chosen))
    assert (curves.low <= curves.mean + 1e-9).all()
    assert (curves.mean <= curves.high + 1e-9).all()
    rmse = np.sqrt(np.mean(np.radians(curves.robot - curves.mean) ** 2, axis=0))
    np.testing.assert_allclose(rmse, now.reproduction.deviation.joint_rmse)


def test_while_it_plays_the_robots_line_ends_at_now(lesson) -> None:
    trace = Trace()
    for state in ("playing", "halfway"):
        trace.observe(lesson[state])
    robot = curves_of(lesson["halfway"], trace).robot[:, 0]
    stamps = curves_of(lesson["halfway"], trace).stamps
    np.testing.assert_array_equal(np.isfinite(robot), stamps <= lesson["halfway"].time)


def test_a_new_run_begins_a_new_trace(lesson) -> None:
    trace = Trace()
    for state in ("playing", "halfway", "halfway", "played", "replaying"):
        trace.observe(lesson[state])
    assert trace.times == [lesson["playing"].time, lesson["halfway"].time]
    trace.observe(lesson["playing"])
    assert trace.times == [lesson["playing"].time]


@given(arrays.arrays(np.float64, 20, elements=strategies.floats(-200.0, 200.0)))
@settings(deadline=None, derandomize=True)
def test_an_axis_holds_all_and_exaggerates_nothing(values) -> None:
    values[3] = np.nan
    lower, upper = axis_range(values)
    assert lower <= np.nanmin(values)
    assert np.nanmax(values) <= upper
    assert upper - lower >= SMALLEST_RANGE
    assert upper - lower <= max(np.nanmax(values) - np.nanmin(values), SMALLEST_RANGE) + 10.0


class Chart:
    """What a plot's handle is told."""

    def __init__(self) -> None:
        self.__dict__["told"] = []

    def __setattr__(self, name: str, value: object) -> None:
        self.told.append(name)


class Gui:
    def add_uplot(self, *_: object, **__: object) -> Chart:
        return Chart()


def test_a_chart_is_built_anew_only_where_its_frame_changes(lesson) -> None:
    """The browser tears a chart down for new axes; five times a second that leaves it blank."""
    curves = curves_of(lesson["played"], Trace())
    data = curves.of_joint(0)
    plot = JointPlot(Gui(), "left_s0", data)
    plot.draw("left_s0", (*data[:-1], data[-1] + 0.01))
    assert plot.chart.told == ["data"]
    plot.draw("left_s0", (*data[:-1], data[-1] + 90.0))
    assert sorted(plot.chart.told[1:]) == ["data", "scales", "title"]
