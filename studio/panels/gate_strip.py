"""The strip of what the hand has shown in the last ten seconds; the newest is on the right.

A sign is told by its height and its letter, so that the strip can be read without its colors; a
black bar below is the time in which the robot was armed.
"""

from collections.abc import Sequence

from studio.engine.hand_strip import SPAN, HandRun
from studio.engine.skeleton import HandState
from studio.panels import markup
from studio.panels.palette import HAND, css

WIDTH, HEIGHT = 340, 28  # [px]
CELLS = 100  # what is shorter than a cell, a tenth of a second, may be left out
_TALLEST, _ARMED = 24, 4  # [px] of a sign, of the bar below
_HEIGHTS = {HandState.LASSO: 24, HandState.OPEN: 17, HandState.CLOSED: 11}
_UNSEEN_HEIGHT, _LETTER_WIDTH = 2, 11  # [px]


def drawn(runs: Sequence[HandRun], seen: str) -> str:
    """Return the strip as HTML; ``seen`` are words on its newest end."""
    base = f'<line x1="0" x2="{WIDTH}" y1="{_TALLEST}" y2="{_TALLEST}" stroke="currentColor"/>'
    ticks = "".join(
        f'<line x1="{x}" x2="{x}" y1="{_TALLEST}" y2="{_TALLEST + 4}" stroke="currentColor"/>'
        for x in range(0, WIDTH, round(WIDTH / SPAN))
    )
    body = "".join(_bar(*cells) for cells in in_cells(runs))
    foot = "display:flex;justify-content:space-between;font-size:.8em;line-height:1.2"
    return (
        f'<svg width="100%" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" style="display:block" '
        f'aria-label="{_told(runs)}">{body}{base}{ticks}</svg>'
        f'<div style="{foot}"><span>{SPAN:.0f} s ago</span><b>{markup.text(seen)}</b>'
        "<span>now</span></div>"
    )


def in_cells(runs: Sequence[HandRun]) -> list[tuple[HandState, bool, int, int]]:
    """Return state, armed or not, first cell and the cell behind the last, of each stretch."""
    if not runs:
        return []
    begin = runs[-1].end - SPAN
    edges = [round((run.start - begin) / SPAN * CELLS) for run in runs]
    ends = [*edges[1:], CELLS]
    return [
        (run.state, run.armed, start, end)
        for run, start, end in zip(runs, edges, ends, strict=True)
        if end > start
    ]


def _bar(state: HandState, armed: bool, start: int, end: int) -> str:
    x, width = start * WIDTH / CELLS, (end - start) * WIDTH / CELLS
    height = _HEIGHTS.get(state, _UNSEEN_HEIGHT)
    bar = _rectangle(x, _TALLEST - height, width, height, css(HAND[state]))
    if state in _HEIGHTS and width >= _LETTER_WIDTH:
        bar += (
            f'<text x="{x + width / 2:.1f}" y="{_TALLEST - 1.5}" font-size="11" font-weight="700" '
            f'fill="#111" text-anchor="middle">{state.value[0].upper()}</text>'
        )
    if armed:
        bar += _rectangle(x, _TALLEST, width, _ARMED, "currentColor")
    return bar


def _rectangle(x: float, y: float, width: float, height: float, color: str) -> str:
    return f'<rect x="{x:.1f}" y="{y}" width="{width:.1f}" height="{height}" fill="{color}"/>'


def _told(runs: Sequence[HandRun]) -> str:
    """Return the newest of it in words, for who cannot see it."""
    newest = [f"{run.state.value.replace('_', ' ')} {run.end - run.start:.1f} s" for run in runs]
    return "the hand in the last ten seconds: " + ", ".join(newest[-6:])
