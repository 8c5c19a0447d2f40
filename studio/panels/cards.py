"""The list of demonstrations: a line each, and under the chosen one its card.

Only one card is there, whatever the number of demonstrations: a list of twenty costs twenty
buttons, and is drawn anew only where something in it changed.
"""

from collections.abc import Sequence

import viser

from studio.engine import commands
from studio.engine.entry import Entry
from studio.engine.scene import USUAL, Scene
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.card import Card
from studio.panels.flags import verdict
from studio.panels.inputs import Post

_LONGEST_NAME = 19  # characters, so that a line is one line


class Cards:
    """See the module."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._gui, self._post = gui, post
        self._head = gui.add_html("")
        self._rows: list[_Row] = []
        self._box = gui.add_folder(None)
        with self._box:
            self._style = gui.add_html("", order=-1.0)
            self._card = Card(gui, post, order=0.0)
        self._drawn: object = None

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        chosen = now.entries[now.chosen] if now.entries else None
        self._card.draw(chosen, now.compare.replayed, now.time)
        state = (now.entries, now.chosen, now.choices.scene)
        if state == self._drawn:
            return
        self._drawn = state
        self._head.content = headline(now)
        self._add_rows(len(now.entries))
        others = [row.id for place, row in enumerate(self._rows) if place != now.chosen]
        self._style.content = row_style([row.id for row in self._rows], others)
        for place, row in enumerate(self._rows):
            is_used = place < len(now.entries)
            shown = now.entries[place] if is_used else None
            row.show(shown, place == now.chosen, now.choices.scene)
        self._card.folder.order = 2.0 * now.chosen + 1.0

    def _add_rows(self, count: int) -> None:
        with self._box:
            while len(self._rows) < count:
                self._rows.append(_Row(self._gui, self._post, 2.0 * len(self._rows)))


class _Row:
    """A line, which chooses its demonstration."""

    def __init__(self, gui: viser.GuiApi, post: Post, order: float) -> None:
        self._number = 0
        self._button = gui.add_button("", order=order, color="gray")
        self._button.on_click(lambda _: post(commands.Choose(self._number)))
        self.id = self._button._impl.uuid  # viser's own name for it in the page

    def show(self, entry: Entry | None, is_chosen: bool, scene: Scene) -> None:
        """Show a demonstration, or nothing, while that scene is chosen."""
        self._button.visible = entry is not None
        if entry is not None:
            self._number = entry.number
            self._button.label = line(entry, scene)
            self._button.color = "blue" if is_chosen else "gray"
            icons = viser.Icon.SQUARE_CHECK, viser.Icon.SQUARE
            self._button.icon = icons[0] if entry.included else icons[1]


def headline(now: Snapshot) -> str:
    """Return how many there are and how many are learned from, as HTML."""
    if not now.entries:
        return markup.block("<b>No demonstrations yet.</b>")
    included = sum(entry.included for entry in now.entries)
    flagged = sum(bool(entry.flags) for entry in now.entries)
    words = f"{included} of {len(now.entries)} included"
    marked = f", {flagged} with flags" if flagged else ""
    return markup.block(f"<b>Demonstrations</b>: {words}{marked}")


def line(entry: Entry, scene: Scene = USUAL) -> str:
    """Return a demonstration in a line, marked where it is of another scene than ``scene``."""
    name = entry.name
    short = name if len(name) <= _LONGEST_NAME else f"{name[: _LONGEST_NAME - 1]}…"
    block = entry.task.short[not entry.done]
    left_out = "" if entry.included else " · left out"
    taught_in = entry.demonstration.scene
    left_out += "" if taught_in.is_same_as(scene) else f" · of {taught_in.name_beside(scene)}"
    flags = f" · {verdict(entry)}" if entry.flags or entry.flags is None else ""
    return (
        f"{entry.number}  {short} · {entry.demonstration.duration:.1f} s · {block}{flags}{left_out}"
    )


def row_style(rows: Sequence[str], others: Sequence[str]) -> str:
    """Return a style for the rows' buttons: a list reads from the left, and only one is chosen.

    Where a browser does not take it, they are plain buttons.
    """

    def each(ids: Sequence[str], inner: str = "") -> str:
        return ",".join(f'[id="{one}"]{inner}' for one in ids) or "none"

    quiet = (
        "background:var(--mantine-color-default);color:var(--mantine-color-text);"
        "border:1px solid var(--mantine-color-default-border)"
    )
    return (
        f"<style>{each(rows)}{{padding:0 .6em;font-size:.82em;font-weight:500;"
        f"margin-bottom:-.35em}}{each(rows, ' .mantine-Button-inner')}"
        f"{{justify-content:flex-start}}{each(others)}{{{quiet}}}</style>"
    )
