"""3 Learn: which network, of how many neurons; its error beside the floor that no network beats."""

from dataclasses import replace

import viser

from studio.engine import commands
from studio.engine.arms import in_words
from studio.engine.learning_status import LearningStatus
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.basis import BasisPart
from studio.panels.error_chart import error_chart, readout
from studio.panels.guessing import Guessing
from studio.panels.inputs import Post
from studio.panels.network_choice import NetworkChoice
from studio.panels.numbers import learned, of_chosen
from studio.panels.readiness import fitting, why_not_train

_NO_NUMBERS = markup.note("Numbers come with the first training.")


class LearnPanel:
    """The third step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._post = post
        self._learning: LearningStatus | None = None
        self._drawn: object = None  # what the curve was drawn from
        self._numbered: tuple[object, object] = (None, None)  # what the numbers were drawn from
        self._ready = gui.add_html("")
        self._choice = NetworkChoice(gui, post)
        # Apart from the curve, whose points come one by one: an equation stays open meanwhile.
        self._readout = gui.add_html("")
        self._curve = gui.add_html("")
        self._train = gui.add_button(
            "Train", hint="Learns from the listed demonstrations", icon=viser.Icon.SCHOOL
        )
        self._train.on_click(lambda _: post(commands.Train(self._choice.settings)))
        self._waiting = Waiting(gui, post)
        self._suggest = gui.add_button("Suggest", icon=viser.Icon.BULB, color="gray")
        self._suggest.on_click(lambda _: self._take_suggestion())
        self._why = gui.add_html("")
        self._resume = gui.add_button("Go on with the curve", visible=False, color="gray")
        self._resume.on_click(lambda _: post(commands.ResumeCurve()))
        with gui.add_folder("Fail on purpose"):
            self._guessing = Guessing(gui, post)
        with gui.add_folder("Numbers"):
            self._result = gui.add_html(_NO_NUMBERS)
            self._basis = BasisPart(gui)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        learning = now.learning
        self._learning = learning
        refusal = why_not_train(now)
        self._train.disabled = bool(refusal)
        self._ready.content = markup.reasons([refusal]) or _material(now)
        self._choice.draw(learning.chosen)
        self._waiting.draw(learning)
        self._readout.content = readout(learning, of_chosen(now))
        self._draw_curve(learning)
        why_not = why_not_suggest(now)
        self._suggest.disabled = bool(why_not)
        self._why.content = markup.note(why_not) if why_not else _reason(learning)
        self._resume.visible = bool(learning.curve.note)
        self._guessing.draw(now)
        self._basis.draw(now)
        self._draw_numbers(now)

    def _draw_curve(self, learning: LearningStatus) -> None:
        """Draw the curve anew if anything of it has changed."""
        state = (learning.curve, learning.chosen.neurons, learning.tried)
        if state != self._drawn:
            self._drawn = state
            self._curve.content = error_chart(learning)

    def _draw_numbers(self, now: Snapshot) -> None:
        """Draw what came of training anew if that has changed: it is long."""
        state = (now.lesson, now.learning.equations)
        if state[0] is not self._numbered[0] or state[1] is not self._numbered[1]:
            self._numbered = state
            self._result.content = (
                _NO_NUMBERS if now.lesson is None else learned(now.lesson, now.learning.equations)
            )

    def _take_suggestion(self) -> None:
        learning = self._learning
        if learning is not None and learning.curve.suggestion is not None:
            neurons = learning.curve.suggestion.neurons
            self._choice.choose(replace(learning.chosen, neurons=neurons))


class Waiting:
    """How far it is with what somebody waits for, and a button that ends it."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._words = gui.add_html("", visible=False)
        self._bar = gui.add_progress_bar(0.0, visible=False, animated=True)
        self._cancel = gui.add_button("Cancel", visible=False, icon=viser.Icon.X, color="gray")
        self._cancel.on_click(lambda _: post(commands.CancelWork()))

    def draw(self, learning: LearningStatus) -> None:
        """Show a snapshot's part."""
        underway = learning.underway
        for part in (self._words, self._bar, self._cancel):
            part.visible = underway is not None
        if underway is not None:
            share = 1.0 if underway.share is None else underway.share
            told = "" if underway.share is None else f", {100.0 * share:.0f} %"
            words = underway.words[0].upper() + underway.words[1:]
            self._words.content = markup.block(f"{markup.text(words)}{told} …")
            # Full and striped where nobody can tell how far; of mypy see `inputs.show_value`.
            self._bar.value = round(100.0 * share)  # type: ignore[misc]


def why_not_suggest(now: Snapshot) -> str:
    """Return why no number of neurons can be suggested."""
    curve = now.learning.curve
    if not fitting(now):
        return why_not_train(now)
    if len(fitting(now)) < 2:
        return "A suggestion needs two demonstrations: it asks how a network does on a new one."
    if curve.note:
        return f"The curve is not complete: {curve.note}."
    if curve.missing:
        known = len(curve.points)
        does = "is being drawn" if now.learning.is_drawing else "waits for a quiet moment"
        return f"The curve {does}: {known} of {known + len(curve.missing)} points."
    return "" if curve.suggestion is not None else "Some errors on the curve are no numbers."


def _reason(learning: LearningStatus) -> str:
    found = learning.curve.suggestion
    return "" if found is None else markup.note(f"Suggested: {found.words}")


def _material(now: Snapshot) -> str:
    count = len(fitting(now))
    return markup.block(
        f"From {count} demonstration{'s' if count > 1 else ''}: "
        f"{in_words(now.choices.arms)}, {now.choices.mapping} mapping.",
        "font-size:.9em",
    )
