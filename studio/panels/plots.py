"""The evidence: what was taught, what the network learned, what Baxter did, joint by joint."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import viser

from studio.engine.demonstration import SAMPLES, DemonstrationSet, resample
from studio.engine.performance import joint_columns
from studio.engine.skeleton import SIDES, FloatArray
from studio.engine.snapshot import Mode, Snapshot
from studio.panels import markup
from studio.panels.palette import ENVELOPE, GHOST, MEAN, NETWORK, ROBOT, css
from studio.panels.readiness import fitting

HEIGHT = 118  # [px] of a plot
SMALLEST_RANGE, ROUND = 15.0, 5.0  # [deg] of the angle's axis
_NEW_POINTS = 6  # ticks of playing between two updates: 5 Hz


@dataclass(frozen=True, eq=False)
class Curves:
    """What the plots show, over the same stamps; NaN where there is nothing."""

    joints: tuple[str, ...]  # D names
    stamps: FloatArray  # (142,) [s]
    low: FloatArray  # (142, D) [deg] the demonstrations' envelope
    high: FloatArray  # (142, D) [deg]
    mean: FloatArray  # (142, D) [deg]
    chosen: FloatArray  # (142, D) [deg]
    network: FloatArray  # (142, D) [deg]
    robot: FloatArray  # (142, D) [deg] measured while it does it alone

    def of_joint(self, column: int) -> tuple[FloatArray, ...]:
        """Return a plot's series: the stamps, then each curve (142,)."""
        curves = (self.low, self.high, self.mean, self.chosen, self.network, self.robot)
        return self.stamps, *(curve[:, column] for curve in curves)


class EvidencePanel:
    """One plot a joint, and what its lines are; of two arms one at a time, so that all is seen."""

    def __init__(self, gui: viser.GuiApi, tab: viser.GuiTabHandle) -> None:
        self._gui, self._tab = gui, tab
        self._arm = gui.add_dropdown("Arm", SIDES, visible=False)
        self._legend = gui.add_html(_NOTHING)
        self._plots: list[JointPlot] = []
        self._trace = Trace()
        self._drawn: object = None

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot, if something in it is new."""
        self._trace.observe(now)
        state = (
            now.entries,
            now.chosen,
            now.lesson,
            now.reproduction,
            now.choices.joints,
            len(self._trace.times) // _NEW_POINTS,
            self._arm.value,
        )
        if state == self._drawn:
            return
        self._drawn = state
        curves = curves_of(now, self._trace)
        self._legend.content = _NOTHING if curves is None else _LEGEND
        columns = () if curves is None else shown_columns(curves.joints, self._arm.value)
        self._arm.visible = curves is not None and len(columns) < len(curves.joints)
        for number, plot in enumerate(self._plots):
            plot.chart.visible = number < len(columns)
        if curves is not None:
            self._show(curves, columns)

    def _show(self, curves: Curves, columns: Sequence[int]) -> None:
        for number, column in enumerate(columns):
            joint, data = curves.joints[column], curves.of_joint(column)
            if number == len(self._plots):
                with self._tab:
                    self._plots.append(JointPlot(self._gui, joint, data))
            else:
                self._plots[number].draw(joint, data)


class JointPlot:
    """One joint's plot. Only its data change often: anything else builds the chart anew."""

    def __init__(self, gui: viser.GuiApi, joint: str, data: tuple[FloatArray, ...]) -> None:
        self._frame = _frame(joint, data)
        title, scales = self._frame
        self.chart = gui.add_uplot(
            data,
            _SERIES,
            title=title,
            bands=_BANDS,
            scales=scales,
            axes=_AXES,
            legend={"show": False},
            height=HEIGHT,
            padding=(8, 16, 0, 0),
        )

    def draw(self, joint: str, data: tuple[FloatArray, ...]) -> None:
        """Show other data, and another joint if need be."""
        frame = _frame(joint, data)
        if frame != self._frame:
            self._frame = frame
            self.chart.title, self.chart.scales = frame
        self.chart.data = data


class Trace:
    """The joints as the robot does it alone, gathered while it plays."""

    def __init__(self) -> None:
        self.times: list[float] = []  # [s]
        self.joints: list[FloatArray] = []  # (15,) [rad] each

    def observe(self, now: Snapshot) -> None:
        """Take note of a snapshot; another run begins anew."""
        if now.mode is not Mode.PLAYING or not now.alone:
            return
        if self.times and now.time < self.times[-1]:
            self.times, self.joints = [], []
        if not self.times or now.time > self.times[-1]:
            self.times.append(now.time)
            self.joints.append(now.world.joint_positions)

    def at(self, stamps: FloatArray) -> FloatArray:
        """Return all joints (N, 15) [rad] at stamps (N,) [s], NaN after the newest."""
        columns = np.array(self.joints).T
        return np.column_stack(
            [np.interp(stamps, self.times, column, right=np.nan) for column in columns]
        )


def shown_columns(joints: Sequence[str], side: str) -> list[int]:
    """Return which joints' plots are shown: of two arms' joints one side's, else all."""
    of_side = [i for i, joint in enumerate(joints) if joint.startswith(f"{side}_")]
    return of_side or list(range(len(joints)))


def curves_of(now: Snapshot, trace: Trace) -> Curves | None:
    """Return what is known of the taught motion, or None where nothing was taught."""
    listed = [entry.demonstration for entry in fitting(now)]
    if now.lesson is None and not listed:
        return None
    taught = DemonstrationSet.of(listed) if now.lesson is None else now.lesson.taught
    stamps = np.linspace(0.0, taught.duration, SAMPLES)
    nothing = np.full_like(taught.mean, np.nan)
    chosen = now.entries[now.chosen].demonstration if now.entries else None
    alike = chosen is not None and chosen.joints == taught.joints
    return Curves(
        joints=taught.joints,
        stamps=stamps,
        low=np.degrees(taught.rows.min(axis=0)),
        high=np.degrees(taught.rows.max(axis=0)),
        mean=np.degrees(taught.mean),
        chosen=np.degrees(resample(chosen)) if chosen is not None and alike else nothing,
        network=nothing if now.lesson is None else np.degrees(now.lesson.curve),
        robot=_robot(now, trace, taught, stamps, nothing),
    )


def _robot(
    now: Snapshot, trace: Trace, taught: DemonstrationSet, stamps: FloatArray, nothing: FloatArray
) -> FloatArray:
    """Return what was measured (142, D) [deg], as far as the robot has come."""
    columns = joint_columns(taught.joints)
    if now.reproduction is not None:
        return np.degrees(now.reproduction.performance.measured_at(stamps)[:, columns])
    if now.mode is Mode.PLAYING and now.alone and trace.times:
        return np.degrees(trace.at(stamps)[:, columns])
    return nothing


def axis_range(values: FloatArray) -> tuple[float, float]:
    """Return round bounds [deg] about all that is known, wide enough not to make much of little."""
    lowest, highest = float(np.nanmin(values)), float(np.nanmax(values))
    short = max(0.0, SMALLEST_RANGE - (highest - lowest)) / 2.0
    lower, upper = (lowest - short) / ROUND, (highest + short) / ROUND
    return ROUND * float(np.floor(lower)), ROUND * float(np.ceil(upper))


def _frame(joint: str, data: tuple[FloatArray, ...]) -> tuple[str, dict[str, viser.uplot.Scale]]:
    """Return a plot's title and axes."""
    stamps, *curves = data
    scales = {
        "x": viser.uplot.Scale(time=False, range=(0.0, float(stamps[-1]))),
        "y": viser.uplot.Scale(range=axis_range(np.concatenate(curves))),
    }
    return f"{joint} [deg] over time [s]", scales


def _line(label: str, stroke: str, width: float, dash: tuple[int, ...] = ()) -> viser.uplot.Series:
    line = viser.uplot.Series(
        label=label, stroke=stroke, width=width, points={"show": False}, spanGaps=False
    )
    if dash:
        line["dash"] = dash
    return line


_SERIES = (
    viser.uplot.Series(label="time [s]"),
    _line("lowest", css(ENVELOPE, 0.5), 0.5),
    _line("highest", css(ENVELOPE, 0.5), 0.5),
    _line("mean", css(MEAN), 1.5, (2, 3)),
    _line("chosen", css(GHOST), 1.5, (8, 4)),
    _line("network", css(NETWORK), 2.0),
    _line("robot", css(ROBOT), 3.0),
)
_BANDS = (viser.uplot.Band(series=(2, 1), fill=css(ENVELOPE, 0.25)),)
_AXES = (viser.uplot.Axis(size=26), viser.uplot.Axis(size=42))  # [px] for the numbers
_NOTHING = markup.note("Nothing has been taught yet: the plots come with the first demonstration.")


def _key(sample: str, words: str) -> str:
    style = "display:inline-block;width:2.2em;vertical-align:middle;margin-right:.4em"
    return (
        f'<span style="white-space:nowrap;margin-right:1em"><span style="{style};{sample}"></span>'
        f"{markup.text(words)}</span> "
    )


_LEGEND = markup.block(
    _key(f"height:.8em;background:{css(ENVELOPE, 0.3)}", "all demonstrations")
    + _key(f"border-top:2px dotted {css(MEAN)}", "their mean")
    + _key(f"border-top:2px dashed {css(GHOST)}", "chosen (ghost)")
    + _key(f"border-top:2px solid {css(NETWORK)}", "network")
    + _key(f"border-top:4px solid {css(ROBOT)}", "Baxter alone"),
    "font-size:.85em;margin-top:.5em",
)
