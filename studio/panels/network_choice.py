"""Which network, and of how many neurons: a number to type, and a slider on a logarithmic scale."""

from dataclasses import replace

import viser

from studio.engine import commands
from studio.engine.curves import COUNTS, MOST_SHOWN
from studio.engine.teaching import LearnerName, LearnerSettings
from studio.panels.inputs import Post, on_choice, show_value

LEARNER_LABELS: dict[LearnerName, str] = {
    "rbf": "RBF, least squares",
    "newrb": "newrb, greedy",
    "field": "stable fields, there and back",
    "plain-field": "one plain field (fails)",
}
_MARKED = (1, 3, 10, 30, 100, 300)  # counts below the slider
_PATIENCE = 10  # drawings, a second, to hear of what was sent

# viser shows a slider's own value beside it, here a place among `COUNTS` that means nothing to
# people; the number above tells the count. Where a later viser lays its elements out in another
# way, the place is seen, and all works.
_STYLE = """<style>
div:has(> .studio-neurons) + div .mantine-NumberInput-root { display: none; }
</style><div class="studio-neurons"></div>"""


class NetworkChoice:
    """See the module. Several browsers and the session itself may choose: all show the newest."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._post = post
        self._shown = LearnerSettings()
        self._sent: LearnerSettings | None = None  # what a person chose and nobody has heard of
        self._waited = 0  # drawings since then
        self._learner = gui.add_dropdown(
            "Network",
            tuple(LEARNER_LABELS.values()),
            initial_value=LEARNER_LABELS[self._shown.name],
        )
        self._number = gui.add_number(
            "Neurons", self._shown.neurons, min=1, max=MOST_SHOWN, step=1, hint="1 to 300"
        )
        gui.add_html(_STYLE)
        self._slider = gui.add_slider(
            "few to many",
            min=0,
            max=len(COUNTS) - 1,
            step=1,
            initial_value=place_of(self._shown.neurons),
            marks=tuple((COUNTS.index(count), str(count)) for count in _MARKED),
        )
        on_choice(self._learner, self._name_chosen)
        on_choice(self._number, lambda: self._send(replace(self._shown, neurons=self._typed())))
        on_choice(self._slider, self._slid)

    @property
    def settings(self) -> LearnerSettings:
        """What is chosen."""
        return self._shown

    def choose(self, settings: LearnerSettings) -> None:
        """Choose for a person."""
        self._show(settings)
        self._send(settings)

    def draw(self, chosen: LearnerSettings) -> None:
        """Show what the session has, unless what was sent is still on its way."""
        self._waited += 1
        if chosen == self._sent or self._waited > _PATIENCE:
            self._sent = None
        if self._sent is None and chosen != self._shown:
            self._show(chosen)

    def _name_chosen(self) -> None:
        name = next(k for k, label in LEARNER_LABELS.items() if label == self._learner.value)
        self._send(replace(self._shown, name=name))

    def _slid(self) -> None:
        count = COUNTS[self._slider.value]
        show_value(self._number, count)
        self._send(replace(self._shown, neurons=count))

    def _typed(self) -> int:
        count = min(max(int(self._number.value), 1), MOST_SHOWN)
        show_value(self._slider, place_of(count))
        return count

    def _send(self, settings: LearnerSettings) -> None:
        self._shown = self._sent = settings
        self._waited = 0
        self._post(commands.ChooseLearner(settings))

    def _show(self, settings: LearnerSettings) -> None:
        self._shown = settings
        show_value(self._learner, LEARNER_LABELS[settings.name])
        show_value(self._number, settings.neurons)
        show_value(self._slider, place_of(settings.neurons))


def place_of(neurons: int) -> int:
    """Return the place on the slider that is nearest to a number of neurons, by their ratio."""
    return min(range(len(COUNTS)), key=lambda i: max(COUNTS[i] / neurons, neurons / COUNTS[i]))
