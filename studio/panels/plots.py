"""The evidence: what was taught, what the network learned, what Baxter did, joint by joint."""

from collections.abc import Sequence

import viser

from studio.engine.skeleton import SIDES, FloatArray
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.curves import Curves, curves_of, shown_columns
from studio.panels.palette import ENVELOPE, GHOST, LIMIT, MEAN, NETWORK, ROBOT, SECOND, css
from studio.panels.playhead import EVERY

HEIGHT = 100  # [px] of a plot without its title
CLOSE, WIDE, OFF = "about the curves", "up to the limits", "no plots"


class EvidencePanel:
    """One plot a joint, and what its lines are; of two arms one at a time, so that all is seen.

    Whether a browser shows this tab it does not tell, so people can turn the plots off: what is not
    shown is not drawn. All of a plot's data are sent anew each time, so that one where nothing but
    the playhead has moved waits for its turn.
    """

    def __init__(self, gui: viser.GuiApi, tab: viser.GuiTabHandle) -> None:
        self._gui, self._tab = gui, tab
        self._axes = gui.add_dropdown(
            "Axes",
            (CLOSE, WIDE, OFF),
            hint="How much of each joint's range is shown; off spares a slow browser",
        )
        self._arm = gui.add_dropdown("Arm", SIDES, visible=False)
        self._legend = gui.add_html(_NOTHING)
        self._plots: list[JointPlot] = []
        self._drawn: object = None
        self._at: float | None = None
        self._drawings = EVERY  # since the plots were drawn

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot, if something in it is new."""
        self._drawings += 1
        chosen = self._axes.value
        state, at = (_state(now), chosen, self._arm.value), _playhead(now)
        if state == self._drawn and (at == self._at or self._drawings < EVERY):
            return
        self._drawn, self._at, self._drawings = state, at, 0
        curves = None if chosen == OFF else curves_of(now)
        empty = _HIDDEN if chosen == OFF else _NOTHING
        self._legend.content = empty if curves is None else _LEGEND
        columns = () if curves is None else shown_columns(curves.joints, self._arm.value)
        self._arm.visible = curves is not None and len(columns) < len(curves.joints)
        for number, plot in enumerate(self._plots):
            plot.chart.visible = number < len(columns)
        if curves is not None:
            self._show(curves, columns)

    def _show(self, curves: Curves, columns: Sequence[int]) -> None:
        to_limits = self._axes.value == WIDE
        for number, column in enumerate(columns):
            if number == len(self._plots):
                with self._tab:
                    self._plots.append(JointPlot(self._gui, curves, column, to_limits))
            else:
                self._plots[number].draw(curves, column, to_limits)


class JointPlot:
    """One joint's plot. Only its data change often: anything else builds the chart anew."""

    def __init__(self, gui: viser.GuiApi, curves: Curves, column: int, to_limits: bool) -> None:
        self._frame = _frame(curves, column, to_limits)
        title, axis, thin = self._frame
        self.chart = gui.add_uplot(
            curves.of_joint(column, axis),
            _series(thin),
            title=title,
            bands=_BANDS,
            scales=_scales(curves.stamps, axis),
            axes=_AXES,
            legend={"show": False},
            height=HEIGHT,
            padding=(8, 16, 0, 0),
        )
        self._end = float(curves.stamps[-1])

    def draw(self, curves: Curves, column: int, to_limits: bool) -> None:
        """Show other data, and another joint if need be."""
        frame = _frame(curves, column, to_limits)
        title, axis, thin = frame
        data, end = curves.of_joint(column, axis), float(curves.stamps[-1])
        if thin != self._frame[2]:
            self.chart.series, self.chart.data = _series(thin), data
        if (frame, end) != (self._frame, self._end):
            self.chart.title, self.chart.scales = title, _scales(curves.stamps, axis)
            self._frame, self._end = frame, end
        self.chart.data = data


def _state(now: Snapshot) -> tuple[object, ...]:
    """Return what the plots depend on besides the playhead."""
    return (
        now.entries,
        now.chosen,
        now.lesson,
        now.reproduction,
        now.choices.joints,
        tuple(alone.lesson for alone in now.compare.playing),
        now.compare.timeline.title,
    )


def _playhead(now: Snapshot) -> float | None:
    """Return when the playhead is [s], or None without one."""
    return now.time if now.compare.timeline.title else None


def _frame(curves: Curves, column: int, to_limits: bool) -> tuple[str, tuple[float, float], int]:
    """Return a plot's title, the bounds of its axis [deg], and how many thin lines it has."""
    axis = curves.axis_of(column, to_limits)
    lower, upper = curves.limits[:, column]
    title = f"{curves.joints[column]} [deg] · {limits_in_words(lower, upper, axis)}"
    return title, axis, len(curves.thin)


def limits_in_words(lower: float, upper: float, axis: tuple[float, float]) -> str:
    """Return a joint's limits [deg], and which of them have no line as they lie off the axis."""
    low, high = (f"{round(limit, 1):g}" for limit in (lower, upper))
    off = lower < axis[0], upper > axis[1]
    return f"limits {low} to {high}{_OFF[off]}"


def _scales(stamps: FloatArray, axis: tuple[float, float]) -> dict[str, viser.uplot.Scale]:
    return {
        "x": viser.uplot.Scale(time=False, range=(0.0, float(stamps[-1]))),
        "y": viser.uplot.Scale(range=axis),
    }


def _line(label: str, stroke: str, width: float, dash: tuple[int, ...] = ()) -> viser.uplot.Series:
    line = viser.uplot.Series(
        label=label, stroke=stroke, width=width, points={"show": False}, spanGaps=False
    )
    if dash:
        line["dash"] = dash
    return line


def _series(thin: int) -> tuple[viser.uplot.Series, ...]:
    return (
        viser.uplot.Series(label="time [s]"),
        _line("lowest", css(ENVELOPE, 0.5), 0.5),
        _line("highest", css(ENVELOPE, 0.5), 0.5),
        *(_line(f"demonstration {n + 1}", css(ENVELOPE, 0.8), 1.0) for n in range(thin)),
        _line("mean", css(MEAN), 1.5, (2, 3)),
        _line("chosen", css(GHOST), 1.5, (8, 4)),
        _line("network", css(NETWORK), 2.0),
        _line("robot", css(ROBOT), 3.0),
        _line("robot B", css(SECOND), 3.0, (4, 2)),
        _line("lower limit", css(LIMIT), 2.0, (2, 4)),
        _line("upper limit", css(LIMIT), 2.0, (2, 4)),
        _line("playhead", css(MEAN, 0.8), 1.5),
    )


_OFF = {
    (False, False): "",
    (True, False): ", lower off the axis",
    (False, True): ", upper off the axis",
    (True, True): ", both off the axis",
}
_BANDS = (viser.uplot.Band(series=(2, 1), fill=css(ENVELOPE, 0.25)),)
_AXES = (viser.uplot.Axis(size=26), viser.uplot.Axis(size=46))  # [px] for the numbers
_NOTHING = markup.note("Nothing has been taught yet: the plots come with the first demonstration.")
_HIDDEN = markup.note("The plots are off: choose other axes to draw them.")


def _key(sample: str, words: str) -> str:
    style = "display:inline-block;width:2.2em;vertical-align:middle;margin-right:.4em"
    return (
        f'<span style="white-space:nowrap;margin-right:1em"><span style="{style};{sample}"></span>'
        f"{markup.text(words)}</span> "
    )


_LEGEND = markup.block(
    _key(f"height:.8em;background:{css(ENVELOPE, 0.3)};border-top:1px solid {css(ENVELOPE)}", "all")
    + _key(f"border-top:2px dotted {css(MEAN)}", "mean")
    + _key(f"border-top:2px dashed {css(GHOST)}", "chosen (ghost)")
    + _key(f"border-top:2px solid {css(NETWORK)}", "network")
    + _key(f"border-top:4px solid {css(ROBOT)}", "Baxter alone")
    + _key(f"border-top:4px dashed {css(SECOND)}", "B")
    + _key(f"border-top:3px dotted {css(LIMIT)}", "limit"),
    "font-size:.85em;margin-top:.5em",
)
