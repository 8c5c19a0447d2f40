"""2 Teach: record or watch the source, and keep the list of demonstrations."""

import viser

from studio.engine import commands
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.snapshot import Mode, Snapshot
from studio.panels import markup
from studio.panels.cards import Cards
from studio.panels.inputs import Post
from studio.panels.readiness import FOLLOWING, why_not_teach
from studio.panels.recordings import RecordingsPanel

AUTOMATIC, BY_HAND = "automatic: while armed", "by hand: between two presses"
PRESSES = "A take keeps what lies between two presses, as far as Baxter was armed."
UNDO, FOR_GOOD = "Undo", "Delete for good"


class TeachPanel:
    """The second step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        # Without a hint: it would cover the panel where "Take the tour" was clicked on.
        self._how = gui.add_dropdown("Recording", (AUTOMATIC, BY_HAND))
        self._repeat = gui.add_checkbox(
            "Take after take",
            True,
            hint="After each demonstration a new recording begins, with the block upright",
        )
        self._add_buttons(gui, post)
        self._notes = gui.add_html("")
        self._cards = Cards(gui, post)
        self._removed = gui.add_html("")
        self._undo = gui.add_button_group("", (UNDO, FOR_GOOD), visible=False)
        self._undo.on_click(
            lambda _: post(
                commands.Restore() if self._undo.value == UNDO else commands.DeleteForGood()
            )
        )
        self._folder = RecordingsPanel(gui, post)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._show_buttons(now)
        self._cards.draw(now)
        self._removed.content = removed(now)
        self._undo.visible = bool(now.collection.removed)
        self._folder.draw(now)

    def _add_buttons(self, gui: viser.GuiApi, post: Post) -> None:
        self._record = gui.add_button(
            "Record",
            hint="Baxter follows the source from its beginning, and it is recorded",
            color="red",
            icon=viser.Icon.PLAYER_RECORD,
        )
        self._record.on_click(lambda _: post(commands.Record(repeats=self._repeat.value)))
        self._begin = gui.add_button(
            "Begin the take",
            hint="From now on it is recorded",
            color="red",
            icon=viser.Icon.PLAYER_RECORD,
            visible=False,
        )
        self._begin.on_click(lambda _: post(commands.BeginTake()))
        self._end = gui.add_button(
            "End the take",
            hint="Lists what was recorded, and Baxter follows on",
            color="red",
            icon=viser.Icon.PLAYER_STOP,
            visible=False,
        )
        self._end.on_click(lambda _: post(commands.EndTake()))
        self._watch = gui.add_button(
            "Watch only",
            hint="Baxter follows the source, and nothing is recorded",
            color="gray",
            icon=viser.Icon.EYE,
        )
        self._watch.on_click(lambda _: post(commands.Watch()))

    def _show_buttons(self, now: Snapshot) -> None:
        refusal, by_hand = why_not_teach(now), self._how.value == BY_HAND
        is_watched, is_recording = now.mode in FOLLOWING, now.mode is Mode.RECORDING
        marks = by_hand and is_watched  # a take is begun and ended while Baxter watches
        self._record.disabled = self._watch.disabled = bool(refusal)
        self._record.visible = not by_hand
        self._repeat.visible = not by_hand and is_endless(now)
        self._watch.visible = not marks
        self._watch.label = "Watch" if by_hand else "Watch only"
        self._begin.visible = by_hand and not is_recording
        self._begin.disabled = not is_watched
        self._end.visible = by_hand and is_recording
        first = "" if is_watched or refusal else "Press Watch first: then begin a take."
        why = () if marks else (refusal, first if by_hand else "")
        keeps = markup.note(PRESSES) if by_hand else ""
        self._notes.content = markup.reasons(why) + keeps + _hint(now)


def is_endless(now: Snapshot) -> bool:
    """Tell whether the source goes on until Stop: the puppet and live streams do."""
    return now.source is not None and now.source.seconds == 0.0


def removed(now: Snapshot) -> str:
    """Return what was deleted last and what goes with it, as HTML."""
    name, file = now.collection.removed, now.collection.goes_too
    if not name:
        return ""
    goes = f" With the next deletion its file {file} goes too." if file else " Its file stays."
    return markup.note(f"Deleted: {name}.{goes}")


def _hint(now: Snapshot) -> str:
    if now.mode in FOLLOWING and now.recorded:
        return markup.note(f"{now.recorded * CONTROL_PERIOD:.0f} s recorded so far, and saved.")
    if now.source is not None and not now.source.has_hand_states and now.choices.gate == "sequence":
        return markup.note(
            "This source tells no hand states, so its gate never opens: choose the gate "
            "“open, no signs” in 1 Source."
        )
    if now.saved_as:
        return markup.note(f"Last recording: {now.saved_as}")
    return ""
