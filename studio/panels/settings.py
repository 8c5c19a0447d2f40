"""How Baxter is taught: which arm, mirrored or not, mapping, gate, gripper and wrist."""

import math
from collections.abc import Mapping as Labels
from typing import TypeVar

import viser

from studio.engine import commands
from studio.engine.arms import Arms
from studio.engine.choices import Choices
from studio.engine.gate import GateMode
from studio.engine.hands import HandOptions
from studio.engine.pose_reading import read_pose
from studio.engine.retarget import MEDIAN_PAPER_FOREARM_ERROR, Mapping
from studio.engine.snapshot import Snapshot
from studio.engine.wrist import WristMode
from studio.panels import markup
from studio.panels.inputs import Post, on_choice, show_value
from studio.panels.readiness import why_not_configure

ARM_LABELS: dict[Arms, str] = {"left": "left", "right": "right", "both": "both"}
MAPPINGS: dict[Mapping, str] = {"exact": "exact: s0, s1, e0, e1", "paper": "paper: s0, s1, e1"}
GATES: dict[GateMode, str] = {"sequence": "Lasso, Open, Closed", "open": "open, no signs"}
WRISTS: dict[WristMode, str] = {
    "zero": "straight",
    "level": "held level",
    "follow": "follows your hand",
}
_GATE_NOTES: dict[GateMode, str] = {
    "sequence": "Your left hand signs before Baxter moves.",
    "open": "Baxter follows whoever is in sight, at once.",
}
_WRIST_NOTES: dict[WristMode, str] = {
    "zero": "The hand goes on where the forearm points.",
    "level": "The hand stays level, as if it held a glass.",
    "follow": "The hand points where yours does.",
}
_Choice = TypeVar("_Choice", bound=str)


class SettingsPanel:
    """A part of the first step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._drawn: object = None
        self._refusal = gui.add_html("", visible=False)
        self._arms = gui.add_dropdown("Arm", tuple(ARM_LABELS.values()))
        self._mirrored = gui.add_checkbox("Mirrored", False)
        self._whose = gui.add_html("")
        self._mapping = gui.add_dropdown("Mapping", tuple(MAPPINGS.values()))
        self._how = gui.add_html("")
        self._gate = gui.add_dropdown("Gate", tuple(GATES.values()))
        self._when = gui.add_html("")
        self._gripper = gui.add_checkbox("Gripper", False)
        self._fingers = gui.add_html("")
        self._wrist = gui.add_dropdown("Wrist", tuple(WRISTS.values()))
        self._hand = gui.add_html("")
        self._controls = (
            self._arms,
            self._mirrored,
            self._mapping,
            self._gate,
            self._gripper,
            self._wrist,
        )
        for control in self._controls:
            on_choice(control, lambda: post(commands.Configure(self._chosen())))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        chosen = now.choices
        # Only what has changed, or has been refused: a choice just made is on its way.
        if (chosen, now.message.number) != self._drawn:
            self._drawn = chosen, now.message.number
            self._show(chosen)
        self._how.content = markup.note(forearm(chosen.mapping, now))
        refusal = why_not_configure(now)
        for control in self._controls:
            control.disabled = bool(refusal)
        self._refusal.content, self._refusal.visible = markup.reasons([refusal]), bool(refusal)

    def _show(self, chosen: Choices) -> None:
        show_value(self._arms, ARM_LABELS[chosen.arms])
        show_value(self._mirrored, chosen.mirrored)
        show_value(self._mapping, MAPPINGS[chosen.mapping])
        show_value(self._gate, GATES[chosen.gate])
        show_value(self._gripper, chosen.hands.gripper)
        show_value(self._wrist, WRISTS[chosen.hands.wrist])
        self._whose.content = markup.note(whose_arm(chosen))
        self._when.content = markup.note(_GATE_NOTES[chosen.gate])
        self._fingers.content = markup.note(fingers(chosen))
        self._hand.content = markup.note(_WRIST_NOTES[chosen.hands.wrist])

    def _chosen(self) -> Choices:
        return Choices(
            _key(ARM_LABELS, self._arms.value),
            _key(MAPPINGS, self._mapping.value),
            _key(GATES, self._gate.value),
            self._mirrored.value,
            HandOptions(self._gripper.value, _key(WRISTS, self._wrist.value)),
        )


def whose_arm(chosen: Choices) -> str:
    """Return which of the person's arms moves which of Baxter's."""
    if chosen.arms == "both":
        return "As in a mirror, both arms." if chosen.mirrored else "Both arms, each as yours."
    yours = chosen.arms
    if chosen.mirrored:
        yours = "right" if chosen.arms == "left" else "left"
    return f"Baxter's {chosen.arms} arm does what your {yours} arm does."


def forearm(mapping: Mapping, now: Snapshot) -> str:
    """Return how far a mapping's forearm is from the person's, in the pose that is shown."""
    if mapping == "exact":
        words = "Upper arm and forearm point where yours do."
    else:
        usual = math.degrees(MEDIAN_PAPER_FOREARM_ERROR)
        words = f"e0 stays 0, so the forearm is {usual:.0f}° off in the median of real people."
    if now.skeleton is None:
        return words
    readings = read_pose(now.skeleton, now.choices, now.world.joint_positions)
    errors = [math.degrees(each.errors[mapping]) for each in readings if each.errors]
    here = ", ".join(f"{error:.0f}°" for error in errors)
    return f"{words} In this pose: {here} off." if errors else f"{words} Now the arm is not seen."


def fingers(chosen: Choices) -> str:
    """Return what Baxter's fingers do."""
    if not chosen.hands.gripper:
        return "Baxter's hands have no fingers."
    return "Your right hand opens and closes Baxter's fingers."


def _key(labels: Labels[_Choice, str], label: str) -> _Choice:
    return next(key for key, each in labels.items() if each == label)
