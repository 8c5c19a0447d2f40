"""What came of training: each joint's error beside its floor, and what else is worth knowing."""

from collections.abc import Iterator, Mapping

from studio.engine.export.equation import Equation
from studio.engine.lesson_words import worth_knowing
from studio.engine.report import joint_names
from studio.engine.snapshot import Snapshot
from studio.engine.teaching import Lesson
from studio.panels import markup
from studio.panels.equation_card import Cards, row, table_of
from studio.panels.network_choice import LEARNER_LABELS

# Of all joints together: an equation's key, what the number is, and how it is shown.
_TOGETHER = (
    ("ratio", "error over its floor, all joints", ".4f"),
    ("held-out", "error on a demonstration left out [rad²]", ".2e"),
    ("held-out ratio", "the same over that of the others' mean", ".3f"),
    ("acceleration", "acceleration over a smooth curve's", ".2f"),
    ("width", "width of the Gaussians [samples]", ".2f"),
    ("rank", "rank: neurons that the samples tell apart", ".0f"),
    ("condition", "condition of Eq. 14", ".1e"),
)


def learned(lesson: Lesson, equations: Mapping[str, Equation]) -> str:
    """Return what came of training as HTML; ``equations`` may still be missing."""
    count = len(lesson.taught.demonstrations)
    cards = Cards(equations, "learn")
    title = (
        f"<b>{markup.text(LEARNER_LABELS[lesson.settings.name])}, {lesson.settings.neurons} "
        f"neuron{'s' if lesson.settings.neurons > 1 else ''}</b>, from {count} "
        f"demonstration{'s' if count > 1 else ''}"
    )
    hint = (
        "Press a number to see its equation with its values in it."
        if equations
        else "The equations behind these numbers come in a moment."
    )
    remarks = (*worth_knowing(lesson, equations), *filter(None, (lesson.remark, _meaning(lesson))))
    return (
        markup.block(title)
        + table_of("".join(_joints(lesson, cards)))
        + (table_of("".join(_together(equations, cards))) if equations else "")
        + markup.note(hint)
        + "".join(map(markup.note, remarks))
        + cards.html()
    )


def of_chosen(now: Snapshot) -> Mapping[str, Equation]:
    """Return the equations of the network that the slider is at; none unless it was trained."""
    lesson, learning = now.lesson, now.learning
    is_trained = lesson is not None and lesson.settings == learning.chosen
    return learning.equations if is_trained else {}


def _joints(lesson: Lesson, cards: Cards) -> Iterator[str]:
    yield row(("joint", "MSE [rad²]", "floor [rad²]", "ratio"), kind="th")
    for i, (shown, joint) in enumerate(zip(joint_names(lesson), lesson.taught.joints, strict=True)):
        mse, floor, ratio = float(lesson.mse[i]), "none", "–"
        if lesson.floor is not None:
            under = float(lesson.floor[i])
            floor = cards.number(f"floor {joint}", f"{under:.2e}", under)
            if under > 0.0:
                ratio = cards.number(f"ratio {joint}", f"{mse / under:.4f}", mse / under)
        yield row(
            (markup.text(shown), cards.number(f"mse {joint}", f"{mse:.2e}", mse), floor, ratio)
        )


def _together(equations: Mapping[str, Equation], cards: Cards) -> Iterator[str]:
    largest = [key for key in equations if key.startswith("largest ")]
    worst = max(largest, key=lambda key: equations[key].value)
    yield row(
        (
            markup.text(f"largest error, {worst.removeprefix('largest ')} (ε*) [rad]"),
            cards.number(worst, f"{equations[worst].value:.3f}", equations[worst].value),
        )
    )
    for key, words, form in _TOGETHER:
        if key in equations:
            value = equations[key].value
            shown = format(value, form).replace("inf", "> 1e15")
            yield row((markup.text(words), cards.number(key, shown, value)))


def _meaning(lesson: Lesson) -> str:
    if lesson.floor is None:
        return f"No floor: {lesson.floor_note}."
    return (
        "The floor is how much the demonstrations differ among themselves. A network that sees "
        "only time cannot get below it: a ratio near 1 is as good as can be."
    )
