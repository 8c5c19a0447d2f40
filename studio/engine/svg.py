"""Small line charts as SVG text: all that a report needs, and nothing to download."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from studio.engine.skeleton import FloatArray

LEFT, RIGHT, TOP, BOTTOM = 46, 14, 24, 34  # margins around the plot [px]
MOST_TICKS = 6


@dataclass(frozen=True, eq=False)
class Line:
    """A curve, told apart by color and dashes, never by color alone."""

    x: FloatArray  # (n,)
    y: FloatArray  # (n,)
    color: str
    dashes: str = ""  # as SVG's stroke-dasharray
    width: float = 1.6
    marked: bool = False  # whether its points are drawn, too


@dataclass(frozen=True)
class Box:
    """A rectangle behind the curves."""

    x: tuple[float, float]
    y: tuple[float, float]
    label: str
    color: str


@dataclass(frozen=True, eq=False)
class Chart:
    """Curves over axes."""

    title: str
    x_label: str
    y_label: str
    lines: tuple[Line, ...]
    boxes: tuple[Box, ...] = ()
    size: tuple[int, int] = (292, 205)  # [px], four of them on a page
    log: bool = False  # of the y axis
    log_x: bool = False
    equal: bool = False  # whether a unit is as long on both axes

    def svg(self) -> str:
        """Return the chart as an SVG element."""
        frame = _Frame.around(self)
        width, height = self.size
        parts = [
            f'<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" '
            f'aria-label="{escape(self.title)}">',
            f'<text x="{LEFT}" y="15" class="title">{escape(self.title)}</text>',
            *(_box(box, frame) for box in self.boxes),
            *_axes(self, frame),
            *(_curve(line, frame) for line in self.lines),
            "</svg>",
        ]
        return "\n".join(parts)


@dataclass(frozen=True)
class _Frame:
    """From values to pixels."""

    x: tuple[float, float]  # of the logarithm, where the axis is logarithmic
    y: tuple[float, float]
    size: tuple[int, int]
    log: bool
    log_x: bool

    @classmethod
    def around(cls, chart: Chart) -> "_Frame":
        xs = np.concatenate([line.x for line in chart.lines] + [box.x for box in chart.boxes])
        ys = np.concatenate([line.y for line in chart.lines] + [box.y for box in chart.boxes])
        if chart.log:
            ys = np.log10(ys[ys > 0.0])
        if chart.log_x:
            xs = np.log10(xs[xs > 0.0])
        x, y = _padded(xs, 0.0 if not chart.equal else 0.03), _padded(ys, 0.06)
        if chart.equal:
            x, y = _with_equal_units(x, y, chart.size)
        return cls(x, y, chart.size, chart.log, chart.log_x)

    def across(self, value: float) -> float:
        value = math.log10(value) if self.log_x else value
        share = (value - self.x[0]) / (self.x[1] - self.x[0])
        return LEFT + share * (self.size[0] - LEFT - RIGHT)

    def down(self, value: float) -> float:
        value = math.log10(value) if self.log else value
        share = (value - self.y[0]) / (self.y[1] - self.y[0])
        return TOP + (1.0 - share) * (self.size[1] - TOP - BOTTOM)


def _padded(values: FloatArray, share: float) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    room = share * (high - low) or (0.0 if high > low else 0.5)
    return low - room, high + room


def _with_equal_units(
    x: tuple[float, float], y: tuple[float, float], size: tuple[int, int]
) -> tuple[tuple[float, float], tuple[float, float]]:
    wide, high = size[0] - LEFT - RIGHT, size[1] - TOP - BOTTOM
    unit = max((x[1] - x[0]) / wide, (y[1] - y[0]) / high)  # of a pixel
    spare_x, spare_y = (unit * wide - x[1] + x[0]) / 2.0, (unit * high - y[1] + y[0]) / 2.0
    return (x[0] - spare_x, x[1] + spare_x), (y[0] - spare_y, y[1] + spare_y)


def ticks(low: float, high: float) -> list[float]:
    """Return round numbers from low to high, at most `MOST_TICKS` of them."""
    rough = (high - low) / MOST_TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(s * power for s in (1.0, 2.0, 5.0, 10.0) if s * power >= rough * (1.0 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def log_ticks(low: float, high: float) -> list[float]:
    """Return round numbers between 10**low and 10**high, decades alone where there are many."""
    digits = (1.0,) if high - low > 3.0 else (1.0, 3.0) if high - low > 1.5 else (1.0, 2.0, 5.0)
    if high - low < 0.15:
        return ticks(10.0**low, 10.0**high)
    decades = range(math.floor(low), math.ceil(high) + 1)
    values = [digit * 10.0**decade for decade in decades for digit in digits]
    return [value for value in values if low - 1e-9 <= math.log10(value) <= high + 1e-9]


def _axes(chart: Chart, frame: _Frame) -> list[str]:
    width, height = chart.size
    bottom, right = height - BOTTOM, width - RIGHT
    parts = []
    for value in log_ticks(*frame.y) if chart.log else ticks(*frame.y):
        y = frame.down(value)
        parts.append(f'<path d="M{LEFT} {y:.1f}H{right}" class="grid"/>')
        parts.append(f'<text x="{LEFT - 5}" y="{y + 3.5:.1f}" class="tick end">{value:.6g}</text>')
    for value in log_ticks(*frame.x) if chart.log_x else ticks(*frame.x):
        x = frame.across(value)
        parts.append(f'<path d="M{x:.1f} {bottom}v4" class="axis"/>')
        parts.append(f'<text x="{x:.1f}" y="{bottom + 15}" class="tick middle">{value:.6g}</text>')
    middle_x, middle_y = (LEFT + right) / 2, (TOP + bottom) / 2
    parts += [
        f'<path d="M{LEFT} {TOP}V{bottom}H{right}" class="axis"/>',
        f'<text x="{middle_x}" y="{height - 4}" class="label middle">'
        f"{escape(chart.x_label)}</text>",
        f'<text transform="translate(11 {middle_y}) rotate(-90)" class="label middle">'
        f"{escape(chart.y_label)}</text>",
    ]
    return parts


def _curve(line: Line, frame: _Frame) -> str:
    points = [
        (frame.across(float(x)), frame.down(float(y)))
        for x, y in zip(line.x, line.y, strict=True)
        if y > 0.0 or not frame.log
    ]
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    dashes = f' stroke-dasharray="{line.dashes}"' if line.dashes else ""
    drawn = (
        f'<polyline points="{path}" fill="none" stroke="{line.color}" '
        f'stroke-width="{line.width}" stroke-linejoin="round"{dashes}/>'
    )
    if line.marked:
        drawn += "".join(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.4" fill="{line.color}"/>' for x, y in points
        )
    return drawn


def _box(box: Box, frame: _Frame) -> str:
    left, right = frame.across(box.x[0]), frame.across(box.x[1])
    top, bottom = frame.down(box.y[1]), frame.down(box.y[0])
    roomy = right - left > 9 * len(box.label)
    return (
        f'<rect x="{left:.1f}" y="{top:.1f}" width="{right - left:.1f}" '
        f'height="{bottom - top:.1f}" fill="{box.color}" stroke="#b5a98f"/>'
        f'<text x="{left + 4 if roomy else right + 4:.1f}" y="{max(top, TOP) + 12:.1f}" '
        'class="tick">'
        f"{escape(box.label)}</text>"
    )


def legend(entries: Sequence[tuple[str, Line]]) -> str:
    """Return the names of curves beside a piece of each."""
    pieces = []
    for name, line in entries:
        dashes = f' stroke-dasharray="{line.dashes}"' if line.dashes else ""
        pieces.append(
            f'<span class="key"><svg width="30" height="10"><path d="M1 5H29" '
            f'stroke="{line.color}" stroke-width="{line.width}"{dashes}/></svg> '
            f"{escape(name)}</span>"
        )
    return f'<p class="legend">{" ".join(pieces)}</p>'
