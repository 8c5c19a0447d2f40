"""2 Teach: record or watch the source, and keep the list of demonstrations."""

import viser

from studio.engine import commands
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.chooser import DemonstrationChooser
from studio.panels.inputs import Post
from studio.panels.readiness import FOLLOWING, why_not_teach


class TeachPanel:
    """The second step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._record = gui.add_button(
            "Record",
            hint="Baxter follows the source from its beginning, and it is recorded",
            color="red",
            icon=viser.Icon.PLAYER_RECORD,
        )
        self._record.on_click(lambda _: post(commands.Record()))
        self._watch = gui.add_button(
            "Watch only",
            hint="Baxter follows the source, and nothing is recorded",
            icon=viser.Icon.EYE,
        )
        self._watch.on_click(lambda _: post(commands.Watch()))
        self._notes = gui.add_html("")
        gui.add_divider()
        self._list = gui.add_html("")
        self._chooser = DemonstrationChooser(gui, "Chosen", post)
        self._remove = gui.add_button(
            "Remove the chosen one",
            hint="Takes it off the list; its file stays",
            color="gray",
            icon=viser.Icon.TRASH,
        )
        self._remove.on_click(lambda _: post(commands.Remove(self._chooser.index)))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        refusal = why_not_teach(now)
        self._record.disabled = self._watch.disabled = bool(refusal)
        self._notes.content = markup.reasons([refusal]) + _hint(now)
        self._list.content = listed(now)
        self._chooser.draw(now)
        self._remove.visible = bool(now.entries)


def listed(now: Snapshot) -> str:
    """Return the list of demonstrations as HTML."""
    if not now.entries:
        return markup.block("<b>No demonstrations yet.</b>")
    rows = []
    for number, entry in enumerate(now.entries):
        shown = entry.demonstration
        mark = "▶\N{NO-BREAK SPACE}" if number == now.chosen else ""
        rows.append(
            (
                f"{mark}{number + 1}",
                shown.name,
                f"{shown.arms}, {shown.mapping}",
                f"{shown.duration:.1f}",
                "down" if entry.block_down else "stands",
            )
        )
    head = ("", "demonstration", "arm, mapping", "s", "block")
    return markup.table(head, rows, bold=now.chosen, left=3)


def _hint(now: Snapshot) -> str:
    if now.mode in FOLLOWING and now.recorded:
        return markup.note(f"{now.recorded} samples recorded so far; Stop keeps them.")
    if now.source is not None and not now.source.has_hand_states and now.choices.gate == "sequence":
        return markup.note(
            "This source tells no hand states, so its gate never opens: choose the gate "
            "“open, no signs” in 1 Source."
        )
    if now.saved_as:
        return markup.note(f"Last recording: {now.saved_as}")
    return ""
