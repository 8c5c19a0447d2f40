"""The picture of many networks: success, and error over its floor, against numbers of neurons."""

from collections.abc import Sequence
from html import escape

import numpy as np

from studio.engine.evaluate.evaluation import pooled
from studio.engine.evaluate.grid import Cell, Grid
from studio.engine.evaluate.report import conditions_in_words
from studio.engine.svg import Box, Chart, Line
from studio.engine.sweep_charts import STYLES
from studio.engine.sweep_report import label_of

CHART = (540, 300)  # [px] each of the two
BAND = "#e9e4d4"  # the demonstrations' own rate
_TOP, _KEYS = 58, 20  # [px] above the charts, and for each learner below
_STYLE = (
    "<style>.title{font-weight:bold;font-size:13px}.tick{font-size:10.5px;fill:#444}"
    ".label{font-size:11.5px}.grid{stroke:#e8e8e8}.axis{stroke:#666;fill:none}"
    ".middle{text-anchor:middle}.end{text-anchor:end}</style>"
)


def grid_picture(grid: Grid) -> str:
    """Return the picture as an SVG file: both charts, whose line is whose, and the answer."""
    width, height = 2 * CHART[0], _TOP + CHART[1] + _KEYS * (1 + len(grid.learners)) + 8
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
        _STYLE,
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
        '<text x="14" y="22" font-size="17" font-weight="bold">How many neurons does the task '
        "need?</text>",
        f'<text x="14" y="42" fill="#444">{escape(_under(grid))}</text>',
        f'<g transform="translate(0 {_TOP})">{success_chart(grid)}</g>',
        f'<g transform="translate({CHART[0]} {_TOP})">{error_chart(grid)}</g>',
    ]
    for place, name in enumerate(grid.learners):
        parts.append(_key(place, name, grid.answer(name), _TOP + CHART[1] + _KEYS * (place + 1)))
    return "\n".join([*parts, "</svg>\n"])


def success_chart(grid: Grid) -> str:
    """Return the success rates with their intervals, over the demonstrations' own as a band."""
    lines = []
    for place, name in enumerate(grid.learners):
        color, dashes = STYLES[place % len(STYLES)]
        cells = grid.of(name)
        rates = np.array([cell.tested.rate.value for cell in cells])
        lines.append(Line(_neurons(cells), 100 * rates, color, dashes, marked=True))
        lines += [_interval(cell, color, place) for cell in cells]
    _, low, high = pooled(grid.replays)
    counts = [cell.network.neurons for cell in grid.cells]
    span = (float(min(counts)), float(max(counts)))
    band = Box(span, (100 * low, 100 * high), "the demonstrations' own replays", BAND)
    frame = Line(np.array(span), np.array([0.0, 100.0]), "none")  # from 0 to 100 % in any case
    return Chart(
        "Does it do the task?",
        "neurons",
        "success [%], 95 % interval",
        (frame, *lines),
        (band,),
        CHART,
        log_x=True,
    ).svg()


def error_chart(grid: Grid) -> str:
    """Return the errors over their floor; nothing where there is no floor."""
    lines = []
    for place, name in enumerate(grid.learners):
        color, dashes = STYLES[place % len(STYLES)]
        cells = [cell for cell in grid.of(name) if cell.network.floor_ratio is not None]
        ratios = np.array([cell.network.floor_ratio for cell in cells], dtype=float)
        if cells:
            lines.append(Line(_neurons(cells), ratios, color, dashes, marked=True))
    if not lines:
        return ""
    return Chart(
        "How well does it fit?",
        "neurons",
        "MSE / floor (1 is the best there is)",
        tuple(lines),
        size=CHART,
        log=True,
        log_x=True,
    ).svg()


def _interval(cell: Cell, color: str, place: int) -> Line:
    """Return a cell's interval as an upright line, beside those of other learners."""
    rate, aside = cell.tested.rate, 1.0 + 0.012 * place
    at = np.full(2, aside * cell.network.neurons)
    return Line(at, 100 * np.array([rate.low, rate.high]), color, width=1.0)


def _neurons(cells: Sequence[Cell]) -> np.ndarray:
    return np.array([cell.network.neurons for cell in cells], dtype=float)


def _under(grid: Grid) -> str:
    trials = max(len(cell.tested.outcomes) for cell in grid.cells)
    return f"{trials} trials a point; {conditions_in_words(grid.conditions)}"


def _key(place: int, name: str, answer: str, y: int) -> str:
    color, dashes = STYLES[place % len(STYLES)]
    dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
    return (
        f'<path d="M14 {y + 4}h30" stroke="{color}" stroke-width="2"{dashed}/>'
        f'<text x="52" y="{y + 8}" font-size="11">{escape(label_of(name))}: {escape(answer)}</text>'
    )
