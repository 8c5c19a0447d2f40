"""Keys and the command palette: what a lecturer does without looking for a button."""

from collections.abc import Callable, Mapping

import viser

from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.actions import ORDERS, Action, Key, Order
from studio.panels.inputs import Post


class Hotkeys:
    """The palette's entries: those of the session here, those of the page as they are given.

    viser opens the palette with Ctrl+K; while somebody types, keys are letters.

    Parameters
    ----------
    gui
        Of all browsers.
    post
        Where people's commands go.
    page
        What the page itself does, by its label.
    more
        What panels let the session be asked for.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        post: Post,
        page: Mapping[str, Callable[[], None]],
        more: tuple[Order, ...] = (),
    ) -> None:
        self._now: Snapshot | None = None
        ordered = (each.action(post, lambda: self._now) for each in (*ORDERS, *more))
        self.actions = (*ordered, *_page_actions(page))
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
        self._now = now
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
