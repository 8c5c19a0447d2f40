"""Failing on purpose: say whether the block will fall with so few neurons, then see."""

from collections.abc import Mapping

import viser

from studio.engine import commands
from studio.engine.export.equation import Equation
from studio.engine.findings import FEWEST_GUESSES, Tried
from studio.engine.learning_status import LearningStatus
from studio.engine.snapshot import Snapshot
from studio.engine.task_words import BLOCK, TASK, TaskWords, task_words
from studio.panels import markup
from studio.panels.equation_card import Cards
from studio.panels.inputs import Post
from studio.panels.numbers import of_chosen
from studio.panels.readiness import why_not_train

_ANSWERS = {
    BLOCK: ("Yes, it falls", "No, it stays"),
    TASK: ("Yes, it does", "No, it does not"),
}


class Guessing:
    """See the module; the answer stays hidden until somebody has guessed."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._learning: LearningStatus | None = None
        self._post = post
        self._question = gui.add_html("")
        self._task = BLOCK
        self._answer = gui.add_button_group("Will it fall?", _ANSWERS[BLOCK])
        self._score = gui.add_html("")
        self._all = gui.add_button("Show all counts", icon=viser.Icon.EYE)
        self._answer.on_click(
            lambda _: self._guess(falls=self._answer.value == _ANSWERS[self._task][0])
        )
        self._all.on_click(lambda _: self._reveal())

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._learning = now.learning
        refusal = why_not_train(now)
        task = task_words(now.choices.scene)
        if task is not self._task:
            self._task, self._answer.options = task, _ANSWERS[task]
            self._answer.label = "Will it fall?" if task is BLOCK else "Will it?"
        self._question.content = question(now.learning, refusal, task, of_chosen(now))
        # viser cannot disable a group; why it is not there is said in its place.
        self._answer.visible = not refusal and now.learning.outcome is None
        self._score.content = score(now.learning)
        missing, untried = now.learning.guesses_missing, now.learning.untried
        self._all.disabled = bool(refusal) or missing > 0 or not untried

    def _guess(self, falls: bool) -> None:
        if self._learning is not None:
            self._post(commands.Guess(self._learning.chosen, falls))

    def _reveal(self) -> None:
        if self._learning is not None:
            self._post(commands.RevealBlocks(self._learning.chosen.name))


def question(
    learning: LearningStatus,
    refusal: str,
    task: TaskWords = BLOCK,
    equations: Mapping[str, Equation] | None = None,
) -> str:
    """Return the question, or its answer where somebody has guessed.

    ``equations`` are the chosen network's, where it was the last one trained: its numbers open
    them.
    """
    neurons = learning.chosen.neurons
    at = f"At <b>{neurons} neuron{'s' if neurons > 1 else ''}</b>"
    known = learning.outcome
    if known is not None:
        cards = Cards(equations or {}, "guess")
        return (
            markup.block(f"{at} {_answer(known, learning, cards)}")
            + markup.note(
                "Move the slider to another number to guess again; 4 Compare shows it on the robot."
            )
            + cards.html()
        )
    return markup.block(f"{at}: {task.question}") + (
        markup.reasons([refusal])
        or markup.note(f"Say it first; then Baxter tries it behind the scenes, {_wait(learning)}.")
    )


def _wait(learning: LearningStatus) -> str:
    """Return how long a trial takes: a quarter of a second, but 0.5 to 2.5 s for a stable field."""
    if learning.chosen.name == "field":  # which is matched to the motion step by step
        return "which takes a stable field one to three seconds, or more with many demonstrations"
    return "in about a second"


def _answer(known: Tried, learning: LearningStatus, cards: Cards) -> str:
    point = known.point
    fell = f"<b>{'▬' if point.done else '▮'} {point.task.event[not point.done]}</b>"
    guess = ""
    if known.guess is not None:
        said = point.task.said[not known.guess]
        guess = f" You said: {said} {'✓' if known.right else '✗'}"
    floor, ratio, off = learning.curve.floor, "", 1000.0 * point.hand_error
    if floor:
        times = point.mse / floor
        ratio = f", {cards.number('ratio', f'{times:.3g}', times)} × the floor"
    mse = cards.number("mse", f"{point.mse:.3g}", point.mse)
    hand = cards.number("hand mean", f"{off:.0f}", off)
    return f"{fell}.{guess}<br>MSE {mse} rad²{ratio}; the hand is {hand} mm off on average."


def score(learning: LearningStatus) -> str:
    """Return how well somebody guesses, and what is missing before all is shown."""
    if not learning.guesses:
        return markup.note(f"No guess yet. After {FEWEST_GUESSES}, all counts can be shown.")
    times = f"{learning.guesses} guess{'es' if learning.guesses > 1 else ''}"
    line = markup.block(f"<b>{learning.right} of {times} right</b>")
    if not learning.guesses_missing:
        shown = "" if learning.untried else markup.note("All counts are shown above.")
        return line + shown + _lesson(learning)
    return line + markup.note(f"Guess {learning.guesses_missing} more, then all can be shown.")


def _lesson(learning: LearningStatus) -> str:
    """Return what the tried counts teach, once both ends are known."""
    tried = sorted(
        (each.point for each in learning.tried if each.learner == learning.chosen.name),
        key=lambda point: point.neurons,
    )
    standing = [point.neurons for point in tried if not point.done]
    enough = [p for p in tried if p.done and p.neurons > max(standing, default=0)]
    floor = learning.curve.floor
    if not standing or not enough or not floor:
        return ""
    few = enough[0]
    return markup.note(
        f"Of those tried, from {few.neurons} neurons on {few.task.event[0]}. There the MSE is "
        f"still {few.mse / floor:.3g} × the floor: a small error and a task done are two things."
    )
