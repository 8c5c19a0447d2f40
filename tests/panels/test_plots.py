"""Plots are sent only while they are drawn, and built anew only where more than data changes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies

from studio.panels.app import FRAME, PANEL_EVERY
from studio.panels.curves import curves_of
from studio.panels.palette import LIMIT, MEAN
from studio.panels.playhead import EVERY
from studio.panels.plots import OFF, WIDE, EvidencePanel, JointPlot, limits_in_words
from tests.panels.controls import Gui, Tab
from tests.panels.test_view import contrast

A_SECOND = round(1.0 / (FRAME * PANEL_EVERY))  # drawings of a panel


def panel() -> tuple[EvidencePanel, Gui]:
    gui = Gui()
    return EvidencePanel(gui, Tab()), gui


def test_a_chart_is_built_anew_only_where_its_frame_changes(lesson) -> None:
    """The browser tears a chart down for new axes; five times a second that leaves it blank."""
    curves = curves_of(lesson["played"])
    plot = JointPlot(Gui(), curves, 0, to_limits=False)
    plot.draw(replace(curves, network=curves.network + 0.01), 0, to_limits=False)
    assert plot.chart.told == ["data"]
    plot.draw(replace(curves, network=curves.network + 90.0), 0, to_limits=False)
    assert sorted(plot.chart.told[1:]) == ["data", "scales", "title"]


def test_series_and_data_are_as_many_whatever_was_taught(lesson) -> None:
    curves = curves_of(lesson["trained"])
    plot = JointPlot(Gui(), curves, 0, to_limits=False)
    for count in (2, 1, 0):
        plot.draw(replace(curves, thin=curves.thin[:count]), 0, to_limits=False)
        assert len(plot.chart.data) == len(plot.chart.series) == 11 + count


@pytest.mark.parametrize(
    ("axis", "words"),
    [
        ((-100.0, 100.0), "limits -97.5 to 97.5"),
        ((-100.0, 10.0), "limits -97.5 to 97.5, upper off the axis"),
        ((-10.0, 100.0), "limits -97.5 to 97.5, lower off the axis"),
        ((-70.0, 10.0), "limits -97.5 to 97.5, both off the axis"),
    ],
)
def test_a_title_says_the_limits_and_which_of_them_are_not_drawn(axis, words) -> None:
    assert limits_in_words(-97.494, 97.494, axis) == words


@given(
    strategies.floats(-170.0, 170.0),
    strategies.floats(0.1, 120.0),
    strategies.floats(5.0, 90.0),
    strategies.booleans(),
)
@settings(deadline=None, derandomize=True)
def test_no_plot_is_silent_about_limits(lesson, lowest, swing, gap, to_limits) -> None:
    """Each limit has a line within its axis, or stands in the title as one that has none."""
    known = curves_of(lesson["trained"])
    rows = np.linspace(lowest, lowest + swing, len(known.stamps))[:, None] * np.ones((1, 4))
    nothing = np.full_like(rows, np.nan)
    drawn = {"low": rows, "high": rows, "mean": rows, "chosen": nothing, "network": nothing}
    limits = np.array([[lowest - gap], [lowest + swing + 1.7 * gap]]) * np.ones((1, 4))
    curves = replace(known, **drawn, thin=(), limits=limits)
    plot = JointPlot(Gui(), curves, 0, to_limits)
    axis = plot.chart.scales["y"]["range"]
    *_, lower, upper, _ = plot.chart.data
    is_drawn = [axis[0] < lower[0], upper[0] < axis[1]]
    assert plot.chart.title.count("off the axis") == (is_drawn != [True, True])
    assert plot.chart.title.endswith(limits_in_words(*limits[:, 0], axis))
    assert not to_limits or is_drawn == [True, True]


def test_lines_are_seen_on_a_light_page_and_on_a_dark_one() -> None:
    for page in ((255, 255, 255), (36, 36, 36)):
        for color in (LIMIT, MEAN):
            assert contrast(color, page) >= 3.0  # WCAG 2.1, of graphics


def test_a_still_snapshot_sends_nothing_and_a_playhead_data_alone(lesson) -> None:
    evidence, gui = panel()
    evidence.draw(lesson["played"])
    assert len(gui.charts) == 4
    told = [len(chart.told) for chart in gui.charts]
    evidence.draw(lesson["played"])
    assert [len(chart.told) for chart in gui.charts] == told
    for _ in range(EVERY):
        evidence.draw(replace(lesson["played"], time=1.0))
    for chart, before in zip(gui.charts, told, strict=True):
        assert set(chart.told[before:]) <= {"data", "visible"}
        assert "data" in chart.told[before:]


@pytest.mark.parametrize("speed", [0.25, 1.0, 2.0])
def test_a_moving_playhead_draws_five_times_a_second_whatever_its_speed(lesson, speed) -> None:
    evidence, gui = panel()
    played = lesson["played"]
    running = replace(played.compare.timeline, is_playing=True, speed=speed)
    now = replace(played, compare=replace(played.compare, timeline=running))
    evidence.draw(replace(now, time=0.0))
    seconds = 2
    before = [chart.told.count("data") for chart in gui.charts]
    for drawing in range(1, seconds * A_SECOND + 1):
        evidence.draw(replace(now, time=drawing / A_SECOND * speed))
    for chart, count in zip(gui.charts, before, strict=True):
        assert chart.told.count("data") - count == seconds * A_SECOND // EVERY == seconds * 5


def test_the_playhead_comes_to_where_it_stops(lesson) -> None:
    evidence, gui = panel()
    for time in (1.0, 1.1, 1.2, 1.3, 1.3, 1.3):
        evidence.draw(replace(lesson["played"], time=time))
    *_, playhead = gui.charts[0].data
    stamps = gui.charts[0].data[0][np.isfinite(playhead)]
    motion = lesson["played"].compare.timeline.motion
    assert stamps[0] == pytest.approx(
        1.3 / motion * lesson["played"].lesson.taught.duration, abs=0.05
    )


def test_what_is_new_is_drawn_at_once(lesson) -> None:
    evidence, gui = panel()
    evidence.draw(lesson["trained"])
    evidence.draw(lesson["played"])
    *_, robot, _, _, _, _ = gui.charts[0].data
    assert np.isfinite(robot).any()


def test_a_robot_that_merely_stands_sends_nothing(lesson) -> None:
    evidence, gui = panel()
    evidence.draw(lesson["trained"])
    told = [len(chart.told) for chart in gui.charts]
    evidence.draw(replace(lesson["trained"], time=lesson["trained"].time + 9.0))
    assert [len(chart.told) for chart in gui.charts] == told


def test_what_is_not_drawn_is_not_sent(lesson) -> None:
    evidence, gui = panel()
    evidence.draw(lesson["played"])
    gui["Axes"].value = OFF
    evidence.draw(lesson["played"])
    assert not any(chart.visible for chart in gui.charts)
    assert "plots are off" in gui.words
    told = [list(chart.told) for chart in gui.charts]
    for time in np.linspace(0.0, 5.0, 20):
        evidence.draw(replace(lesson["played"], time=float(time)))
    assert all(
        set(chart.told[len(before) :]) <= {"visible"}
        for chart, before in zip(gui.charts, told, strict=True)
    )


def test_without_anything_taught_it_says_so(lesson) -> None:
    evidence, gui = panel()
    evidence.draw(lesson["start"])
    assert gui.charts == []
    assert "Nothing has been taught yet" in gui.words


def test_the_axes_go_up_to_the_limits_where_asked(lesson) -> None:
    evidence, gui = panel()
    gui["Axes"].value = WIDE
    evidence.draw(lesson["trained"])
    curves = curves_of(lesson["trained"])
    for column, chart in enumerate(gui.charts):
        lower, upper = chart.scales["y"]["range"]
        assert lower <= curves.limits[0, column]
        assert upper >= curves.limits[1, column]
