"""Error against the number of neurons, and below it whether the block falls: one scale for both."""

import math
from collections.abc import Iterator, Mapping

import numpy as np

from studio.engine.curves import MOST_SHOWN, ErrorPoint
from studio.engine.export.equation import Equation
from studio.engine.findings import Curve, Tried
from studio.engine.learning_status import LearningStatus
from studio.engine.paper import paper_table
from studio.engine.skeleton import FloatArray
from studio.engine.svg import LEFT, RIGHT, Chart, Line, legend
from studio.panels import markup
from studio.panels.equation_card import Cards
from studio.panels.palette import BRAND, ENVELOPE, GHOST, NETWORK, css

SIZE = (346, 186)  # [px], as wide as the panel; with slider and strip on a laptop at once
_STRIP = 52  # [px], its height
_GROUND = 36  # [px] from the strip's top, where the blocks stand
_TALL, _THIN = 15, 6  # [px], a block
_INK = "currentColor"
_STYLE = """<style>
.studio-chart text { fill: currentColor; font-size: 11px; }
.studio-chart .title { font-size: 12px; font-weight: 600; }
.studio-chart .end { text-anchor: end; } .studio-chart .middle { text-anchor: middle; }
.studio-chart .grid { stroke: currentColor; opacity: .13; fill: none; }
.studio-chart .axis { stroke: currentColor; opacity: .6; fill: none; }
.studio-chart .legend { margin: .2em 0 0 0; font-size: .85em; line-height: 1.5; }
.studio-chart .key { white-space: nowrap; margin-right: .8em; }
</style>"""


def chart_html(svg: str) -> str:
    """Return a chart as it looks on the page, in light and dark."""
    return f'{_STYLE}<div class="studio-chart" style="margin:0 .4em .5em .4em">{svg}</div>'


def error_chart(learning: LearningStatus) -> str:
    """Return the curve with what it is compared with, the chosen number marked, and the strip."""
    curve, neurons = learning.curve, learning.chosen.neurons
    lines = dict(_lines(curve))
    chart = Chart(
        "How much it errs, by neurons",
        "neurons",
        "MSE [rad²], mean of the joints",
        (*lines.values(), *_chosen(curve, neurons, lines)),
        size=SIZE,
        log=True,
        log_x=True,
    )
    tried = [each for each in learning.tried if each.learner == curve.learner]
    keys = legend(list(lines.items()))
    return chart_html(chart.svg() + strip(tried, neurons) + keys)


def readout(learning: LearningStatus, equations: Mapping[str, Equation] | None = None) -> str:
    """Return the chosen network's errors in words, as far as they are known.

    ``equations`` are that network's, where it was the last one trained: its numbers open them.
    """
    neurons = learning.chosen.neurons
    named = f"<b>{neurons} neuron{'s' if neurons > 1 else ''}</b>"
    point = learning.curve.at(neurons)
    cards = Cards(equations or {}, "curve")
    words = _why_unknown(learning.curve) if point is None else errors_in_words(point, cards)
    return markup.block(f"{named}: {words}", "font-size:.9em") + cards.html()


def errors_in_words(point: ErrorPoint, cards: Cards) -> str:
    """Return a point's errors as HTML."""
    parts = [f"MSE {cards.number('mse', f'{point.mse:.3g}', point.mse)} rad²"]
    if point.floor_ratio is not None:
        ratio = cards.number("ratio", f"{point.floor_ratio:.4g}", point.floor_ratio)
        parts.append(f"{ratio} × floor")
    if point.held_out is not None:
        held_out = cards.number("held-out", f"{point.held_out:.3g}", point.held_out)
        parts.append(f"held out {held_out}")
    return ", ".join(parts)


def _why_unknown(curve: Curve) -> str:
    if not curve.points:
        return "its errors are not known yet."
    if curve.missing:
        return "not on the curve yet."
    return "between two points of the curve; Train tells its errors."


def strip(tried: list[Tried], neurons: int) -> str:
    """Return on the curve's scale which blocks fell and which stood; a block for each."""
    width = SIZE[0]
    x = across(neurons)
    blocks = "".join(_block(each) for each in tried)
    nobody = (
        ""
        if tried
        else f'<text x="{width / 2}" y="{_GROUND - 10}" class="middle">no guess yet</text>'
    )
    return (
        f'<svg viewBox="0 0 {width} {_STRIP}" width="{width}" height="{_STRIP}" role="img" '
        f'aria-label="which blocks fell">'
        f'<path d="M{x:.1f} 0V{_GROUND}" stroke="{css(BRAND)}" stroke-dasharray="4 3"/>{nobody}'
        f'<path d="M{LEFT} {_GROUND}H{width - RIGHT}" class="axis"/>{blocks}'
        f'<text x="{LEFT}" y="{_STRIP - 3}">▮ stays up  ▬ fell   ✓ ✗ the guess</text></svg>'
    )


def across(neurons: int) -> float:
    """Return where a number of neurons is on the scale [px]."""
    share = math.log(neurons) / math.log(MOST_SHOWN)
    return LEFT + share * (SIZE[0] - LEFT - RIGHT)


def _block(tried: Tried) -> str:
    down, x = tried.point.done, across(tried.point.neurons)
    wide, high = (_TALL, _THIN) if down else (_THIN, _TALL)
    told = tried.point.task.event[not down]
    guess = "" if tried.guess is None else "✓" if tried.right else "✗"
    return (
        f"<g><title>{tried.point.neurons} neurons: {told}</title>"
        f'<rect x="{x - wide / 2:.1f}" y="{_GROUND - high}" width="{wide}" height="{high}" '
        f'fill="{css(NETWORK)}" stroke="{_INK}" stroke-width=".8"/>'
        f'<text x="{x:.1f}" y="{_GROUND - _TALL - 5}" class="middle">{guess}</text></g>'
    )


def _lines(curve: Curve) -> Iterator[tuple[str, Line]]:
    """Yield the curves by name: first what lies behind."""
    paper = paper_table()
    yield (
        "the paper's Table I",
        Line(
            np.array([row.neurons for row in paper], dtype=float),
            np.array([np.mean(list(row.mse.values())) for row in paper]),
            css(ENVELOPE),
            "1 3",
            width=2.4,
            marked=True,
        ),
    )
    counts = np.array([point.neurons for point in curve.points], dtype=float)
    if curve.floor:
        ends = np.array([1.0, float(MOST_SHOWN)])
        yield "floor", Line(ends, np.full(2, curve.floor), _INK, "6 3", width=1.2)
    held_out = [point.held_out for point in curve.points]
    if len(counts) and None not in held_out:
        yield "held out", _finite(counts, np.array(held_out, dtype=float), css(GHOST), "8 4")
    if len(counts):
        mse = np.array([point.mse for point in curve.points])
        yield "on what was taught", _finite(counts, mse, css(NETWORK), "", marked=True)


def _finite(x: FloatArray, y: FloatArray, color: str, dashes: str, marked: bool = False) -> Line:
    there = np.isfinite(y)
    return Line(x[there], y[there], color, dashes, 2.0, marked)


def _chosen(curve: Curve, neurons: int, lines: dict[str, Line]) -> Iterator[Line]:
    """Yield the mark of the chosen number: a line over all of the height, a point on the curve."""
    heights = np.concatenate([line.y for line in lines.values()])
    ends = np.array([heights.min(), heights.max()])
    yield Line(np.full(2, float(neurons)), ends, css(BRAND), "4 3", width=1.4)
    # The scale reaches from 1 to its end whatever is drawn, as the strip's does.
    yield Line(np.array([1.0, float(MOST_SHOWN)]), np.full(2, ends[0]), "none", width=0.0)
    point = curve.at(neurons)
    if point is not None and math.isfinite(point.mse):
        at = np.array([float(neurons)])
        yield Line(at, np.array([point.mse]), css(BRAND), marked=True)
