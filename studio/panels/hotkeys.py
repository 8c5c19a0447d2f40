"""Keys and the command palette: all that a lecturer does without looking for a button."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import viser

from studio.engine import commands
from studio.engine.commands import Command
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.inputs import Post
from studio.panels.readiness import (
    why_not_play,
    why_not_record_again,
    why_not_restore,
    why_not_step,
    why_not_teach,
    why_not_toggle,
)

_Special = Literal["escape", "space", "arrowright", "arrowleft"]
_KeyName = _Special | Literal["B", "N", "R", "T", "Z", "1", "2", "3", "4", "5"]
JUMP = 15  # ticks: half a second


@dataclass(frozen=True)
class Key:
    """A key as viser names it, and as people do."""

    name: Literal[
        "escape",
        "space",
        "arrowright",
        "arrowleft",
        "B",
        "N",
        "R",
        "T",
        "Z",
        "1",
        "2",
        "3",
        "4",
        "5",
    ]
    shown: str
    modifier: Literal["shift", "cmd/ctrl"] | None = None


@dataclass(frozen=True)
class Action:
    """One entry of the palette."""

    label: str
    act: Callable[[], None]
    key: Key | None = None
    why_not: Callable[[Snapshot], str] = lambda _: ""


class Hotkeys:
    """The palette's entries: those of the session here, those of the page as they are given.

    viser opens the palette with Ctrl+K; while somebody types, keys are letters.
    """

    def __init__(
        self, gui: viser.GuiApi, post: Post, page: Mapping[str, Callable[[], None]]
    ) -> None:
        self.actions = (*_session_actions(post), *_page_actions(page))
        self._handles = [
            gui.add_command(
                action.label,
                hotkey=None if action.key is None else action.key.name,
                modifier=None if action.key is None else action.key.modifier,
            )
            for action in self.actions
        ]
        for action, handle in zip(self.actions, self._handles, strict=True):
            handle.on_trigger(_calling(action.act))

    def draw(self, now: Snapshot) -> None:
        """Switch off what cannot be done now, and say why."""
        for action, handle in zip(self.actions, self._handles, strict=True):
            why = action.why_not(now) or None
            if why != handle.description:
                handle.description = why
            if bool(why) != handle.disabled:
                handle.disabled = bool(why)


def keys_as_html(actions: tuple[Action, ...]) -> str:
    """Return all keys as a table."""
    rows = [(each.key.shown, each.label) for each in actions if each.key is not None]
    return markup.table(("key", "does"), [*rows, ("Ctrl K", "All commands")], left=2)


def _session_actions(post: Post) -> tuple[Action, ...]:
    def send(command: Command) -> Callable[[], None]:
        return lambda: post(command)

    def step(label: str, ticks: int, key: Key) -> Action:
        return Action(label, send(commands.StepBy(ticks)), key, why_not_step)

    return (
        Action("Stop and disarm", send(commands.Stop()), Key("escape", "Esc")),
        Action("Play or pause", send(commands.TogglePlay()), Key("space", "Space"), why_not_toggle),
        step("One tick on", 1, Key("arrowright", "→")),
        step("One tick back", -1, Key("arrowleft", "←")),
        step("Half a second on", JUMP, Key("arrowright", "Shift →", "shift")),
        step("Half a second back", -JUMP, Key("arrowleft", "Shift ←", "shift")),
        Action(
            "Record again, in place of the chosen one",
            send(commands.RecordAgain()),
            Key("R", "R"),
            why_not_record_again,
        ),
        Action("Record", send(commands.Record()), None, why_not_teach),
        Action("Watch, without recording", send(commands.Watch()), None, why_not_teach),
        Action(
            "Let Baxter do it alone", send(commands.PlayReproduction()), Key("B", "B"), why_not_play
        ),
        Action(
            "Undo the last deletion",
            send(commands.Restore()),
            Key("Z", "Ctrl Z", "cmd/ctrl"),
            why_not_restore,
        ),
        Action("Take the demonstrator", send(commands.UseDemonstrator())),
        Action("Be the puppet", send(commands.UsePuppet())),
    )


_PAGE_KEYS = {
    "Take the tour": Key("T", "T"),
    "1 Source": Key("1", "1"),
    "2 Teach": Key("2", "2"),
    "3 Learn": Key("3", "3"),
    "4 Compare": Key("4", "4"),
    "5 Export": Key("5", "5"),
    "Dark or light": Key("N", "N"),
}


def _page_actions(page: Mapping[str, Callable[[], None]]) -> tuple[Action, ...]:
    return tuple(Action(label, act, _PAGE_KEYS.get(label)) for label, act in page.items())


def _calling(act: Callable[[], None]) -> Callable[[viser.CommandEvent], None]:
    return lambda _: act()
