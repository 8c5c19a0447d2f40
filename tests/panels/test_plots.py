"""Plots are sent only while they are drawn, and built anew only where more than data changes."""

from dataclasses import replace

import numpy as np

from studio.panels.curves import curves_of
from studio.panels.plots import OFF, WIDE, EvidencePanel, JointPlot
from tests.panels.controls import Gui, Tab


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


def test_a_title_says_the_limits_that_lie_outside(lesson) -> None:
    curves = curves_of(lesson["trained"])
    plot = JointPlot(Gui(), curves, 1, to_limits=False)
    lower, upper = curves.limits[:, 1]
    assert f"limits {lower:.0f} to {upper:.0f}" in plot.chart.title


def test_a_still_snapshot_sends_nothing_and_a_playhead_data_alone(lesson) -> None:
    evidence, gui = panel()
    evidence.draw(lesson["played"])
    assert len(gui.charts) == 4
    told = [len(chart.told) for chart in gui.charts]
    evidence.draw(lesson["played"])
    assert [len(chart.told) for chart in gui.charts] == told
    evidence.draw(replace(lesson["played"], time=1.0))
    for chart, before in zip(gui.charts, told, strict=True):
        assert set(chart.told[before:]) <= {"data", "visible"}
        assert "data" in chart.told[before:]


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
