"""3 Learn: which network, of how many neurons; its error beside the floor that no network beats."""

import viser

from studio.engine import commands
from studio.engine.arms import in_words
from studio.engine.report import joint_names
from studio.engine.snapshot import Snapshot
from studio.engine.teaching import LearnerName, LearnerSettings, Lesson
from studio.panels import markup
from studio.panels.inputs import Post
from studio.panels.readiness import fitting, why_not_train

LEARNER_LABELS: dict[LearnerName, str] = {
    "rbf": "RBF, least squares",
    "newrb": "newrb, greedy",
    "field": "stable fields, there and back",
    "plain-field": "one plain field (fails)",
}
MOST_NEURONS = 300  # the paper's Table I goes to 250


class LearnPanel:
    """The third step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._ready = gui.add_html("")
        self._learner = gui.add_dropdown("Network", tuple(LEARNER_LABELS.values()))
        self._neurons = gui.add_slider("Neurons", min=1, max=MOST_NEURONS, step=1, initial_value=50)
        self._train = gui.add_button(
            "Train", hint="Learns from the listed demonstrations", icon=viser.Icon.SCHOOL
        )
        self._train.on_click(lambda _: post(commands.Train(self._settings())))
        self._result = gui.add_html("")

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        refusal = why_not_train(now)
        self._train.disabled = bool(refusal)
        self._ready.content = markup.reasons([refusal]) or _material(now)
        self._result.content = "" if now.lesson is None else learned(now.lesson)

    def _settings(self) -> LearnerSettings:
        chosen = self._learner.value
        name = next(key for key, label in LEARNER_LABELS.items() if label == chosen)
        return LearnerSettings(name, self._neurons.value)


def learned(lesson: Lesson) -> str:
    """Return what came of training as HTML: each joint's error, its floor, their ratio."""
    count = len(lesson.taught.demonstrations)
    title = (
        f"<b>{markup.text(LEARNER_LABELS[lesson.settings.name])}, {lesson.settings.neurons} "
        f"neurons</b>, from {count} demonstration{'s' if count > 1 else ''}"
    )
    rows = []
    for i, joint in enumerate(joint_names(lesson)):
        floor, ratio = "none", "–"
        if lesson.floor is not None:
            floor = f"{lesson.floor[i]:.2e}"
            ratio = f"{lesson.mse[i] / lesson.floor[i]:.4f}" if lesson.floor[i] > 0 else "–"
        rows.append((joint, f"{lesson.mse[i]:.2e}", floor, ratio))
    numbers = markup.table(("joint", "MSE [rad²]", "floor [rad²]", "ratio"), rows)
    remark = markup.note(lesson.remark) if lesson.remark else ""
    return markup.block(title) + numbers + remark + markup.note(_meaning(lesson))


def _meaning(lesson: Lesson) -> str:
    if lesson.floor is None:
        return f"No floor: {lesson.floor_note}."
    return (
        "The floor is how much the demonstrations differ among themselves. A network that sees "
        "only time cannot get below it: a ratio near 1 is as good as can be."
    )


def _material(now: Snapshot) -> str:
    count = len(fitting(now))
    return markup.block(
        f"{count} demonstration{'s' if count > 1 else ''} to learn from: "
        f"{in_words(now.choices.arms)}, {now.choices.mapping} mapping."
    )
