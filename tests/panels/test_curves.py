"""The plots' data: what was taught, learned and done, and nothing that is not known yet."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies
from hypothesis.extra import numpy as arrays

from studio.engine.arms import learned_joints
from studio.engine.compare_status import Alone
from studio.engine.demonstration import SAMPLES, resample
from studio.engine.robot import load_robot
from studio.panels.curves import (
    KEPT,
    MOST_THIN,
    ROUND,
    SMALLEST_RANGE,
    axis_range,
    curves_of,
    near,
    shown_columns,
)

AXIS = (-40.0, 60.0)


def test_nothing_taught_nothing_shown(lesson) -> None:
    assert curves_of(lesson["start"]) is None
    assert curves_of(lesson["recording"]) is None


def test_of_two_arms_one_is_shown_and_of_one_arm_all() -> None:
    both = learned_joints("both", "exact")
    for side, columns in (("left", [0, 1, 2, 3]), ("right", [4, 5, 6, 7])):
        assert shown_columns(both, side) == columns
        for arms in ("left", "right"):
            assert shown_columns(learned_joints(arms, "paper"), side) == [0, 1, 2]


def test_all_series_of_a_plot_are_equally_long_and_few(lesson) -> None:
    """The chart library takes unequal lengths in silence."""
    for state in ("recorded", "trained", "halfway", "played"):
        curves = curves_of(lesson[state])
        assert curves.joints == ("left_s0", "left_s1", "left_e0", "left_e1")
        for column in range(len(curves.joints)):
            series = curves.of_joint(column, AXIS)
            assert {len(each) for each in series} == {SAMPLES + (curves.playhead >= 0)}
            assert len(series) == 11 + len(curves.thin)
    assert SAMPLES <= 300


def test_demonstrations_are_thin_lines_within_their_envelope(lesson) -> None:
    curves = curves_of(lesson["trained"])
    taught = lesson["trained"].lesson.taught
    assert len(curves.thin) == len(taught.rows) == 2 <= MOST_THIN
    for line, rows in zip(curves.thin, taught.rows, strict=True):
        np.testing.assert_allclose(np.radians(line), rows)
        assert (curves.low <= line + 1e-9).all()
        assert (line <= curves.high + 1e-9).all()


def test_what_is_not_known_is_not_drawn(lesson) -> None:
    def known(state: str) -> list[bool]:
        curves = curves_of(lesson[state])
        shown = (curves.mean, curves.chosen, curves.network, curves.robot, curves.second)
        return [bool(np.isfinite(each).all()) for each in shown]

    assert known("recorded") == [True, True, False, False, False]
    assert known("trained") == [True, True, True, False, False]
    assert known("played") == [True, True, True, True, False]
    assert np.isnan(curves_of(lesson["recorded"]).network).all()
    assert curves_of(lesson["trained"]).playhead == -1


def test_curves_are_the_real_data_in_degrees(lesson) -> None:
    now = lesson["played"]
    curves, taught = curves_of(now), now.lesson.taught
    assert curves.stamps[-1] == pytest.approx(taught.duration)
    np.testing.assert_allclose(np.radians(curves.network), now.lesson.curve)
    np.testing.assert_allclose(np.radians(curves.mean), taught.mean)
    chosen = now.entries[now.chosen].demonstration
    np.testing.assert_allclose(np.radians(curves.chosen), resample(chosen))
    rmse = np.sqrt(np.mean(np.radians(curves.robot - curves.mean) ** 2, axis=0))
    np.testing.assert_allclose(rmse, now.reproduction.deviation.joint_rmse)


def test_limits_are_the_robots_own(lesson) -> None:
    curves = curves_of(lesson["trained"])
    limits = load_robot().limits_of(curves.joints)
    *_, lower, upper, _ = curves.of_joint(1, AXIS)
    np.testing.assert_allclose(np.radians(lower), limits.lower[1])
    np.testing.assert_allclose(np.radians(upper), limits.upper[1])


def test_while_it_plays_for_the_first_time_its_line_ends_at_the_playhead(lesson) -> None:
    now = lesson["halfway"]
    curves = curves_of(now)
    known = np.isfinite(curves.robot[:, 0])
    np.testing.assert_array_equal(known, curves.stamps <= now.time)
    assert curves.stamps[curves.playhead] <= now.time


def test_what_is_known_stays_whole_and_the_playhead_goes_through_it(lesson) -> None:
    played = lesson["played"]
    half = replace(played, time=played.lesson.taught.duration / 2)
    curves = curves_of(half)
    assert np.isfinite(curves.robot).all()
    stamps, *others, playhead = curves.of_joint(0, AXIS)
    there = np.flatnonzero(np.isfinite(playhead))
    assert there[0] == pytest.approx(SAMPLES / 2, abs=1)
    np.testing.assert_array_equal(playhead[there], AXIS)
    assert (np.diff(stamps) >= 0.0).all()
    for curve in (stamps, *others):  # upright, and all the others as they were
        assert curve[there[0]] == curve[there[1]] or np.isnan(curve[there]).all()
    last = curves_of(replace(played, time=99.0)).of_joint(0, AXIS)[-1]
    assert np.isfinite(last[-2:]).all()


def test_b_is_drawn_beside_a_on_the_same_axis(lesson) -> None:
    now = lesson["played"]
    (first,) = now.compare.playing
    other = Alone(first.lesson, first.performance)
    two = replace(now, compare=replace(now.compare, playing=(first, other)))
    curves = curves_of(two)
    np.testing.assert_array_equal(curves.second, curves.robot)
    turned = replace(curves, second=curves.second + 100.0)
    lower, upper = turned.axis_of(0, to_limits=False)
    assert lower <= curves.low[:, 0].min()
    assert upper >= turned.second[:, 0].max()


def test_an_axis_holds_the_limits_where_asked(lesson) -> None:
    curves = curves_of(lesson["trained"])
    narrow, wide = (curves.axis_of(1, to_limits) for to_limits in (False, True))
    lower, upper = curves.limits[:, 1]
    assert wide[0] <= lower < upper <= wide[1]
    assert narrow[1] - narrow[0] < wide[1] - wide[0]


@given(
    arrays.arrays(np.float64, 20, elements=strategies.floats(-200.0, 200.0)),
    strategies.floats(-300.0, 0.0),
    strategies.floats(0.5, 300.0),
)
@settings(deadline=None, derandomize=True)
def test_limits_are_kept_where_the_curves_keep_most_of_the_axis(values, lower, width) -> None:
    """As many of them as there is room for, the nearer one first."""
    limits = np.array([lower, lower + width])
    swing = max(np.ptp(values), SMALLEST_RANGE)
    gaps = np.maximum([values.min() - limits[0], limits[1] - values.max()], 0.0)

    def fits(kept: object, slack: float) -> bool:
        return bool(swing + slack >= KEPT * (swing + gaps[kept].sum()))

    kept = near(values, limits)
    assert fits(kept, 1e-9)
    for other in ([True, False], [False, True], [True, True]):
        assert sum(other) <= kept.sum() or not fits(other, -1e-9)
    assert kept.sum() != 1 or gaps[kept] <= gaps[~kept]


def test_an_axis_grows_to_a_limit_that_is_near_and_to_no_other(lesson) -> None:
    """The push swings s0 by some 65°, and comes up to some 35° from its lower limit."""
    curves = curves_of(lesson["trained"])
    axes = [curves.axis_of(column, to_limits=False) for column in range(len(curves.joints))]
    shown = [
        [low < lower, upper < high]
        for (low, high), (lower, upper) in zip(axes, curves.limits.T, strict=True)
    ]
    assert shown == [[True, False], [False, False], [False, False], [False, False]]
    for lower, upper in axes:
        assert lower % ROUND == upper % ROUND == 0.0


@given(arrays.arrays(np.float64, 20, elements=strategies.floats(-200.0, 200.0)))
@settings(deadline=None, derandomize=True)
def test_an_axis_holds_all_and_exaggerates_nothing(values) -> None:
    values[3] = np.nan
    lower, upper = axis_range(values)
    assert lower <= np.nanmin(values)
    assert np.nanmax(values) <= upper
    assert upper - lower >= SMALLEST_RANGE
    assert upper - lower <= max(np.nanmax(values) - np.nanmin(values), SMALLEST_RANGE) + 10.0


def test_a_demonstration_that_is_shown_has_a_playhead_at_its_share(lesson) -> None:
    now = lesson["replaying"]
    motion = now.compare.timeline.motion
    assert motion == pytest.approx(now.entries[now.chosen].demonstration.duration)
    curves = curves_of(replace(now, time=motion / 4))
    assert curves.playhead == pytest.approx(SAMPLES / 4, abs=1)
    assert np.isfinite(curves.robot).all()  # of the reproduction before
