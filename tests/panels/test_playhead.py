"""Playheads in drawn charts: upright, sent five times a second at most, silent while still."""

import re
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from studio.engine.robot import CONTROL_RATE
from studio.engine.svg import LEFT, RIGHT
from studio.panels.app import FRAME, PANEL_EVERY
from studio.panels.basis import BasisPart, drawn, playhead
from studio.panels.error_chart import SIZE
from studio.panels.playhead import EVERY, Playhead, upright
from tests.panels.controls import Control, Gui

A_SECOND = round(1.0 / (FRAME * PANEL_EVERY))  # drawings of an open panel


def place(style: Control) -> float | None:
    """Return where the style puts the line [px]."""
    found = re.search(r"translateX\((.*?)px\)", style.content)
    return float(found[1]) if found else None


def test_the_style_moves_the_line_of_its_own_chart() -> None:
    gui = Gui()
    head = Playhead(gui, "one")
    head.draw(12.34)
    (style,) = gui.texts
    assert place(style) == 12.3
    (name,) = re.findall(r"<style>\.([\w-]+)\{visibility:visible;", style.content)
    assert ElementTree.fromstring(upright("one", 0, 9)).get("class") == name
    assert ElementTree.fromstring(upright("other", 0, 9)).get("class") != name
    for _ in range(EVERY):
        head.draw(None)
    assert style.content == ""


def test_it_is_sent_five_times_a_second_and_comes_to_where_the_playhead_stops() -> None:
    gui = Gui()
    head = Playhead(gui, "one")
    (style,) = gui.texts
    for drawing in range(4 * A_SECOND):
        head.draw(float(drawing))
    assert len(style.told) == 4 * 5
    for _ in range(EVERY):
        head.draw(99.0)
    assert place(style) == 99.0
    sent = len(style.told)
    for _ in range(3 * A_SECOND):
        head.draw(99.0)
    assert len(style.told) == sent


def part(lesson, state: str = "played") -> tuple[BasisPart, Gui, Control, Control]:
    """Return the part with a joint's Gaussians drawn, its chart, and its playhead's style."""
    gui = Gui()
    made = BasisPart(gui)
    made.draw(lesson[state])
    gui["Gaussians"].value = "left_s1"
    chart, style = gui.texts
    return made, gui, chart, style


def test_the_gaussians_have_the_playhead_at_its_share_of_the_motion(lesson) -> None:
    now = lesson["played"]
    motion = now.compare.timeline.motion
    basis, _, chart, style = part(lesson)
    svg = ElementTree.fromstring(re.search(r"<svg.*?</svg>", chart_of(now), re.DOTALL)[0])
    (total,) = [p for p in svg.findall("polyline") if p.get("stroke-width") == "2.4"]
    ends = [float(pair.split(",")[0]) for pair in total.get("points").split()]
    for share, wanted in ((0.0, ends[0]), (0.5, (ends[0] + ends[-1]) / 2), (1.0, ends[-1])):
        for _ in range(EVERY):
            basis.draw(replace(now, time=share * motion))
        assert place(style) == pytest.approx(wanted, abs=0.11)
    for _ in range(EVERY):
        basis.draw(replace(now, time=now.duration))  # all settles; the motion is at its end
    assert place(style) == SIZE[0] - RIGHT
    assert "studio-playhead" in chart.content
    assert playhead(replace(now, time=-1.0)) == LEFT


def chart_of(now) -> str:
    return drawn(now.lesson, now.lesson.taught.joints.index("left_s1"))


def test_while_it_plays_the_chart_is_drawn_once_and_the_line_five_times_a_second(lesson) -> None:
    basis, _, chart, style = part(lesson)
    for drawing in range(3 * A_SECOND):
        basis.draw(replace(lesson["played"], time=drawing * FRAME * PANEL_EVERY))
    assert chart.told.count("content") == 1
    assert 3 * 5 - 1 <= len(style.told) <= 3 * 5


def test_a_still_page_sends_nothing(lesson) -> None:
    for state in ("trained", "played"):
        basis, _, chart, style = part(lesson, state)
        for _ in range(A_SECOND):
            basis.draw(lesson[state])
        sent = len(chart.told) + len(style.told)
        for _ in range(A_SECOND):
            basis.draw(lesson[state])
        assert len(chart.told) + len(style.told) == sent
    for tick in range(A_SECOND):  # trained, a robot that merely stands: its clock goes on
        basis, _, _, style = part(lesson, "trained")
        basis.draw(replace(lesson["trained"], time=tick / CONTROL_RATE))
        assert style.told == []


def test_what_is_not_drawn_has_no_playhead(lesson) -> None:
    basis, gui, _, style = part(lesson)
    gui["Gaussians"].value = "not drawn"
    for drawing in range(A_SECOND):
        basis.draw(replace(lesson["played"], time=float(drawing)))
    assert style.told == []
