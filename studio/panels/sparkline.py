"""A demonstration at a glance, as SVG: its joints over time, what is trimmed off, what is wrong.

Joints are told apart by color and dashes; flags carry the numbers under which they are explained.
"""

from collections.abc import Sequence

import numpy as np

from studio.engine.entry import Entry
from studio.engine.export.material import Take
from studio.engine.skeleton import FloatArray
from studio.panels import markup
from studio.panels.palette import PROBLEM, css
from studio.panels.playhead import upright

WIDTH, HEIGHT = 236, 78
PLAYHEAD = "demonstration"  # the name of its line
TOP, BOTTOM = 14, 4  # for the flags' numbers, and a little air
POINTS = 80  # of a line; a browser draws a hundred of them without noticing
MARK = css(PROBLEM, 0.32)
SMALLEST_RANGE = 15.0  # [deg] so that a hand that trembles does not look like a wide motion
_NARROWEST = 3.0  # [px] of a flag's mark, which may be a moment
# After Okabe and Ito, for color-blind people too, on light and dark; from the fifth joint on, which
# is the second arm's, lines are thin.
_STYLES = (
    ("rgb(40,130,200)", ""),
    ("rgb(213,94,0)", "7 2"),
    ("rgb(0,158,115)", "2 2"),
    ("rgb(204,121,167)", "7 2 2 2"),
)


def sparkline(entry: Entry) -> str:
    """Return the picture."""
    whole = entry.whole
    times = np.linspace(0.0, whole.duration, POINTS)
    curves = np.degrees(whole.at(times))
    lines = [
        _line(_across(times, whole.duration), _down(curves)[:, column], column)
        for column in range(curves.shape[1])
    ]
    label = f"{markup.text(entry.name)}: its joints over {whole.duration:.1f} seconds"
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="100%" role="img" aria-label="{label}" '
        'style="display:block;background:var(--mantine-color-default-hover);border-radius:.2em">'
        f"{_marks(entry)}{''.join(lines)}{_trimmed(entry)}{upright(PLAYHEAD, 0, HEIGHT)}</svg>"
    )


def playhead(entry: Entry, replayed: Take | None, time: float) -> float | None:
    """Return where [px] in the picture ``time`` [s] of what is replayed is; None outside it.

    By its place in the recording: a card that is trimmed or renamed meanwhile still shows it.
    """
    whole = entry.whole
    if replayed is None or replayed.recording is not entry.recording:
        return None
    skipped = replayed.demonstration.first_sample - whole.first_sample
    if not 0 <= skipped < len(whole.times):
        return None
    # What the robot does after the demonstration is not in the picture, which ends with it.
    within = min(float(whole.times[skipped]) + time, whole.duration)
    return WIDTH * within / whole.duration


def legend(joints: Sequence[str]) -> str:
    """Return the joints' names, each beside its line."""
    rows = []
    for column, joint in enumerate(joints):
        line = (
            '<svg width="22" height="6" style="margin-right:.35em"><line x1="0" x2="22" y1="3" '
            f'y2="3" {_style(column)}/></svg>'
        )
        rows.append(f"<div>{line}{markup.text(joint)}</div>")
    return "".join(rows)


def _style(column: int) -> str:
    """Return a joint's look, as SVG's attributes."""
    color, dashes = _STYLES[column % len(_STYLES)]
    width = 1.7 if column < len(_STYLES) else 0.8
    return f'stroke="{color}" stroke-width="{width}" stroke-dasharray="{dashes}"'


def _across(times: FloatArray, duration: float) -> FloatArray:
    return WIDTH * times / duration


def _down(curves: FloatArray) -> FloatArray:
    """Return where (N, D) [deg] are, one scale for all joints, each about its own middle."""
    middle = (curves.max(axis=0) + curves.min(axis=0)) / 2.0
    reach = max(SMALLEST_RANGE, float(np.ptp(curves, axis=0).max())) / 2.0
    share: FloatArray = (curves - middle) / reach  # -1 to 1
    return TOP + (HEIGHT - TOP - BOTTOM) * (1.0 - share) / 2.0


def _line(x: FloatArray, y: FloatArray, column: int) -> str:
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
    return f'<polyline points="{points}" fill="none" {_style(column)}/>'


def _marks(entry: Entry) -> str:
    """Return a band and a number wherever a flag has a place."""
    begin, _ = entry.span
    scale = WIDTH / entry.whole.duration
    marks = []
    for number, flag in enumerate(entry.flags or (), start=1):
        for start, end in flag.places:
            left = min((begin + start) * scale, WIDTH - _NARROWEST)
            width = max(_NARROWEST, (end - start) * scale)
            marks.append(
                f'<rect x="{left:.1f}" y="0" width="{width:.1f}" height="{HEIGHT}" fill="{MARK}"/>'
            )
        if flag.places:
            aside = 9.0 * ((number - 1) % 5)  # flags often begin at the same place
            at = min(max((begin + flag.places[0][0]) * scale, 0.0) + aside + 2.0, WIDTH - 10.0)
            marks.append(
                f'<text x="{at:.1f}" y="11" font-size="11" font-weight="700" '
                f'fill="currentColor">{number}</text>'
            )
    return "".join(marks)


def _trimmed(entry: Entry) -> str:
    """Return a veil over what is trimmed off."""
    begin, end = (WIDTH * moment / entry.whole.duration for moment in entry.span)
    veils = [
        f'<rect x="{x:.1f}" y="0" width="{width:.1f}" height="{HEIGHT}" '
        'fill="var(--mantine-color-body)" opacity=".78"/>'
        f'<line x1="{edge:.1f}" x2="{edge:.1f}" y1="0" y2="{HEIGHT}" stroke="currentColor" '
        'stroke-width="1" stroke-dasharray="3 2"/>'
        for x, width, edge in ((0.0, begin, begin), (end, WIDTH - end, end))
        if width > 0.5
    ]
    return "".join(veils)
