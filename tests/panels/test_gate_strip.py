"""The strip shows every sign by its height and its letter, at its time."""

import re
from itertools import pairwise

import pytest

from studio.engine.hand_strip import SPAN, HandRun
from studio.engine.skeleton import HandState
from studio.panels.gate_strip import CELLS, WIDTH, drawn, in_cells

LASSO, OPEN, CLOSED = HandState.LASSO, HandState.OPEN, HandState.CLOSED


def runs(*shown: tuple[HandState, float], armed: bool = False) -> tuple[HandRun, ...]:
    time, made = 20.0, []
    for state, seconds in shown:
        made.append(HandRun(state, armed, time, time + seconds))
        time += seconds
    return tuple(made)


def rectangles(html: str) -> list[tuple[float, float, float]]:
    """Return x, width and height of every bar."""
    found = re.findall(r'<rect x="([\d.]+)" y="[\d.]+" width="([\d.]+)" height="(\d+)"', html)
    return [(float(x), float(width), float(height)) for x, width, height in found]


def test_signs_differ_by_height_and_letter() -> None:
    shown = drawn(runs((LASSO, 3.0), (OPEN, 3.0), (CLOSED, 3.0), (HandState.UNKNOWN, 1.0)), "")
    bars = rectangles(shown)
    heights = [height for _, _, height in bars]
    assert heights == sorted(heights, reverse=True)
    assert len(set(heights)) == 4
    assert re.findall(r">([LOC])</text>", shown) == ["L", "O", "C"]
    assert [x for x, _, _ in bars] == pytest.approx([0.0, 102.0, 204.0, 306.0])
    assert sum(width for _, width, _ in bars) == pytest.approx(WIDTH)


def test_the_newest_is_on_the_right_and_what_is_not_known_stays_empty() -> None:
    ((x, width, _),) = rectangles(drawn(runs((OPEN, 1.0)), ""))
    assert (x, x + width) == pytest.approx((WIDTH * 0.9, WIDTH))
    assert rectangles(drawn((), "")) == []


def test_armed_time_is_underlined() -> None:
    plain, armed = (len(rectangles(drawn(runs((OPEN, 2.0), armed=a), ""))) for a in (False, True))
    assert (plain, armed) == (1, 2)


def test_a_flickering_hand_makes_no_endless_picture() -> None:
    """At 30 Hz a state a frame, each too short to be seen."""
    flicker = runs(*[(OPEN if k % 2 else CLOSED, 1 / 30) for k in range(300)])
    cells = in_cells(flicker)
    assert len(cells) <= CELLS
    assert (cells[0][2], cells[-1][3]) == (0, CELLS)
    assert all(a[3] == b[2] for a, b in pairwise(cells))
    assert flicker[-1].end - flicker[0].start == pytest.approx(SPAN)


def test_words_are_shown_as_words() -> None:
    assert "hand: &lt;b&gt;" in drawn((), "hand: <b>")
    assert "open 2.0 s" in drawn(runs((OPEN, 2.0)), "")  # for who cannot see it
