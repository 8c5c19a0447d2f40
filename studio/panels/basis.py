"""The Gaussians behind one joint's curve, drawn on request: each with its weight, and their sum."""

import viser

from studio.engine.basis_curves import Basis, basis_of
from studio.engine.skeleton import FloatArray
from studio.engine.snapshot import Snapshot
from studio.engine.svg import BOTTOM, LEFT, RIGHT, TOP, Chart, Line, legend
from studio.engine.teaching import Lesson
from studio.panels import markup
from studio.panels.error_chart import SIZE, chart_html
from studio.panels.inputs import show_value
from studio.panels.palette import ENVELOPE, NETWORK, css
from studio.panels.playhead import Playhead, upright

_NOT = "not drawn"
_PLAYHEAD = "gaussians"  # the name of its line


class BasisPart:
    """See the module."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._options: tuple[str, ...] = (_NOT,)
        self._drawn: tuple[object, str] = (None, _NOT)
        self._joint = gui.add_dropdown(
            "Gaussians", self._options, hint="What each neuron adds to a joint's curve"
        )
        self._chart = gui.add_html("", visible=False)
        self._playhead = Playhead(gui, _PLAYHEAD)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        lesson = now.lesson
        options = (_NOT,) if lesson is None else (_NOT, *lesson.taught.joints)
        if options != self._options:
            self._options = options
            self._joint.options = options
            show_value(self._joint, _NOT)
        self._joint.disabled = lesson is None
        self._draw_chart(lesson)
        has_line = self._chart.visible and "</svg>" in self._chart.content
        self._playhead.draw(playhead(now) if has_line else None)

    def _draw_chart(self, lesson: Lesson | None) -> None:
        """Draw it anew if it is another lesson's or another joint's."""
        wanted = (lesson, self._joint.value)
        if wanted == self._drawn:
            return
        self._drawn = wanted
        joint = self._joint.value
        self._chart.visible = lesson is not None and joint != _NOT
        if lesson is not None and joint in lesson.taught.joints:
            self._chart.content = drawn(lesson, lesson.taught.joints.index(joint))


def playhead(now: Snapshot) -> float | None:
    """Return where [px] in the chart the playhead is, at the same share of the motion as in plots.

    None where nothing is on the timeline.
    """
    motion, (width, _) = now.compare.timeline.motion, SIZE
    share = min(max(now.time / motion, 0.0), 1.0) if motion else None
    return None if share is None else LEFT + share * (width - LEFT - RIGHT)


def drawn(lesson: Lesson, column: int) -> str:
    """Return the Gaussians of a joint as HTML, or why there are none."""
    basis = basis_of(lesson, column)
    if basis is None:
        return markup.note("A field follows the posture, not time: it has no Gaussians over time.")
    joint = lesson.taught.joints[column]
    each = [Line(*part, css(ENVELOPE), width=1.0) for part in basis.parts]
    total = Line(basis.stamps, basis.total, css(NETWORK), width=2.4)
    chart = Chart(f"{joint} from its Gaussians", "sample", "[deg]", (*each, total), size=SIZE)
    keys = legend([(_named(basis), each[0]), ("their sum", total)])
    line = upright(_PLAYHEAD, TOP, SIZE[1] - BOTTOM)
    with_line = f"{chart.svg().removesuffix('</svg>')}{line}</svg>"
    return chart_html(with_line + keys) + markup.note(
        f"To the sum the network adds {joint}'s mean angle, {basis.bias:.1f}°, and has its curve."
        + _large(basis, basis.total)
    )


def _named(basis: Basis) -> str:
    if len(basis.parts) < basis.neurons:
        return f"the {len(basis.parts)} largest of {basis.neurons} Gaussians, weighted"
    return "each Gaussian, weighted" if basis.neurons > 1 else "the Gaussian, weighted"


def _large(basis: Basis, total: FloatArray) -> str:
    """Return that large Gaussians cancel, where they do."""
    largest = max(float(abs(angles).max()) for _, angles in basis.parts)
    times = largest / max(float(abs(total).max()), 1e-9)
    if times < 3.0:
        return ""
    told = f"{times:.0f}" if times < 1000.0 else f"{times:.0e}".replace("e+0", "e")
    return f" The largest Gaussian is {told} times as high as that sum: they cancel."
