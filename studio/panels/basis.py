"""The Gaussians behind one joint's curve, drawn on request: each with its weight, and their sum."""

import viser

from studio.engine.basis_curves import Basis, basis_of
from studio.engine.skeleton import FloatArray
from studio.engine.snapshot import Snapshot
from studio.engine.svg import Chart, Line, legend
from studio.engine.teaching import Lesson
from studio.panels import markup
from studio.panels.error_chart import SIZE, chart_html
from studio.panels.inputs import show_value
from studio.panels.palette import ENVELOPE, NETWORK, css

_NOT = "not drawn"


class BasisPart:
    """See the module."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._options: tuple[str, ...] = (_NOT,)
        self._drawn: tuple[object, str] = (None, _NOT)
        self._joint = gui.add_dropdown(
            "Gaussians", self._options, hint="What each neuron adds to a joint's curve"
        )
        self._chart = gui.add_html("", visible=False)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        lesson = now.lesson
        options = (_NOT,) if lesson is None else (_NOT, *lesson.taught.joints)
        if options != self._options:
            self._options = options
            self._joint.options = options
            show_value(self._joint, _NOT)
        self._joint.disabled = lesson is None
        wanted = (lesson, self._joint.value)
        if wanted == self._drawn:
            return
        self._drawn = wanted
        joint = self._joint.value
        self._chart.visible = lesson is not None and joint != _NOT
        if lesson is not None and joint in lesson.taught.joints:
            self._chart.content = drawn(lesson, lesson.taught.joints.index(joint))


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
    return chart_html(chart.svg() + keys) + markup.note(
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
