"""The puppet's panels: who takes it in the first step, and its signs under the gate."""

from collections.abc import Sequence
from functools import partial
from typing import Literal

import viser

from studio.engine import commands
from studio.engine.engage import COMING
from studio.engine.gate_words import WHY
from studio.engine.skeleton import SIDES, HandState, Side
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.inputs import Post
from studio.panels.palette import HAND, css
from studio.panels.readiness import FOLLOWING

NONE = "none"
SIGNS = {
    "LASSO": HandState.LASSO,
    "OPEN": HandState.OPEN,
    "CLOSED": HandState.CLOSED,
    NONE: HandState.UNKNOWN,
}
KEYS: dict[HandState, Literal["L", "O", "C"]] = {
    HandState.LASSO: "L",
    HandState.OPEN: "O",
    HandState.CLOSED: "C",
}
# viser's group of buttons does not show which of them was pressed last.
_STYLE = """<style>
div:has(> .puppet-{side}) + div > div > div:first-child {{ display: {label}; }}
div:has(> .puppet-{side}) + div .mantine-Button-root {{
  height: 2.2em; font-size: 1em; padding: 0; }}
div:has(> .puppet-{side}) + div .mantine-Button-root:nth-child({place}) {{
  background: {color}; color: #111; font-weight: 800; text-decoration: underline; }}
</style><div class="puppet-{side}"></div>"""


class PuppetPanel:
    """In the first step: take the puppet, and bring it back where it was."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._take = gui.add_button(
            "Be the puppet",
            hint="A stick person whose hands you drag: no sensor, no camera, you teach",
            icon=viser.Icon.HAND_GRAB,
        )
        self._take.on_click(lambda _: post(commands.UsePuppet()))
        self._how = gui.add_html("")
        self._home = gui.add_button(
            "Hands back",
            hint="Both hands go back to where they were at first, and sign nothing",
            icon=viser.Icon.HOME,
            color="gray",
            visible=False,
        )
        self._home.on_click(lambda _: post(commands.PuppetHome()))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        is_puppet = now.who.puppet is not None
        self._take.visible, self._home.visible = not is_puppet, is_puppet
        self._how.content = HOW_TO_DRAG if is_puppet else WHO_NEEDS_IT


class SignsPanel:
    """In the gate's panel, while the puppet is the source: its signs."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._hands = {side: _Signs(gui, post, side) for side in SIDES}

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        puppet = now.who.puppet
        for side, signs in self._hands.items():
            # Only the gripper asks for the right hand.
            is_shown = puppet is not None and (side == "left" or now.choices.hands.gripper)
            signs.draw(puppet.sign(side) if puppet is not None else HandState.UNKNOWN, is_shown)


class _Signs:
    """The buttons of one hand, and its keys."""

    def __init__(self, gui: viser.GuiApi, post: Post, side: Side) -> None:
        self._post, self._side = post, side
        self._style = gui.add_html(_styled(side, HandState.UNKNOWN), visible=False)
        self._bar = gui.add_button_group(
            f"{side.capitalize()} hand",
            tuple(SIGNS),
            hint="What the puppet's hand shows, until you press another one",
            visible=False,
        )
        self._bar.on_click(lambda _: post(commands.Sign(side, SIGNS[self._bar.value])))
        self._commands = [
            gui.add_command(
                f"Puppet: {side} hand {state.value.upper()}",
                hotkey=key,
                modifier=None if side == "left" else "shift",
                disabled=True,
                description=_WHY_NOT_SIGN[side],
            )
            for state, key in KEYS.items()
        ]
        for command, state in zip(self._commands, KEYS, strict=True):
            command.on_trigger(partial(self._sign, state))

    def _sign(self, state: HandState, _: object) -> None:
        self._post(commands.Sign(self._side, state))

    def draw(self, state: HandState, is_shown: bool) -> None:
        self._bar.visible = self._style.visible = is_shown
        self._style.content = _styled(self._side, state)
        for command in self._commands:
            if command.disabled == is_shown:
                command.disabled = not is_shown
                command.description = None if is_shown else _WHY_NOT_SIGN[self._side]


_WHY_NOT_SIGN: dict[Side, str] = {
    "left": "Only the puppet signs by keys: take it in 1 Source first.",
    "right": "Only the puppet signs by keys, and only a gripper asks for its right hand: take both "
    "in 1 Source first.",
}
WHO_NEEDS_IT = markup.note("No sensor, no camera: drag its hand, sign with L, O, C, and teach.")
HOW_TO_DRAG = markup.note(
    "Drag the blue balls in the 3D view. Shift keeps a ball at its height. A click lets an elbow "
    "hang. Signs: L, O, C, or the buttons under the gate."
)


def next_move(now: Snapshot) -> str:
    """Return what whoever has the puppet should do next; nothing where Baxter itself says why."""
    gate, hands = now.gate, _hands_in_words(now.choices.persons_sides)
    if now.mode not in FOLLOWING or gate is None:
        return "2 Teach: Record; then sign, and drag its hand"
    if not gate.armed:
        return _sign_next(now)
    if now.held == COMING:
        return f"Wait: Baxter comes to its {hands}"
    if now.held or now.guarded or gate.left is not None:
        return ""
    ending = "LASSO (L) disarms" if now.choices.gate == "sequence" else "Stop ends it"
    return f"Drag its {hands}: push the block; {ending}"


def _hands_in_words(sides: Sequence[Side]) -> str:
    """Return which of the puppet's hands teach."""
    return "hands" if len(sides) > 1 else f"{sides[0]} hand"


def _sign_next(now: Snapshot) -> str:
    gate, puppet = now.gate, now.who.puppet
    if gate is None or puppet is None or now.choices.gate == "open" or gate.lit >= len(KEYS):
        return ""
    state, key = list(KEYS.items())[gate.lit]
    word = state.value.upper()
    if puppet.sign("left") is state:
        return f"Keep {word} a moment"
    fell_back = gate.detail.partition(";")[0]
    why = f"{fell_back}; " if fell_back in WHY.values() else ""
    return f"{why}sign {word}: press {key}" if why else f"Sign {word}: press {key}, or its button"


def _styled(side: Side, state: HandState) -> str:
    place = list(SIGNS.values()).index(state) + 1
    label = "none" if side == "left" else "block"  # the left hand's stand below the gate's signs
    return _STYLE.format(side=side, place=place, color=css(HAND[state]), label=label)
