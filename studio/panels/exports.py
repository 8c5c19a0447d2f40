"""5 Export: what people take away, and a session that is opened again."""

from collections.abc import Callable
from pathlib import Path

import viser

from studio.engine import commands
from studio.engine.errors import FileError
from studio.engine.export import KINDS
from studio.engine.snapshot import Snapshot
from studio.engine.uploads import Uploads, shown_name
from studio.panels import markup
from studio.panels.actions import Order
from studio.panels.inputs import Post
from studio.panels.readiness import why_not_export
from studio.panels.replay_page import REPLAY

Deliver = Callable[[tuple[Path, ...]], None]  # send files to whoever asked for them, soon
_TOO_LARGE = (
    "lay it on the machine that runs the studio, and type its path as Other path, in the "
    "Recordings folder of 2 Teach"
)

LABELS = {
    "replay": "Replay page",
    "video": "Video",
    "csv": "Tables (CSV)",
    "npz": "Arrays (NPZ)",
    "mcap": "Recordings (MCAP)",
    "model": "Network (JSON)",
    "html": "Report (HTML)",
    "zip": "Whole session (ZIP)",
}
# Two boxes a row; where a later viser lays them out in another way, one a row is left.
_BOXES = ", ".join(
    "div:has(> .studio-exports)" + " + div" * place for place in range(1, len(LABELS) + 2)
)
_STYLE = f"""<style>
:is({_BOXES}) {{ display: inline-block; width: 50%; padding-bottom: .1em !important; }}
:is({_BOXES}) > div > div:first-child {{ width: calc(100% - 2em) !important; }}
</style><div class="studio-exports"></div>"""
_NOTHING_CHOSEN = "Choose at least one that is ready."
_ALL = KINDS | {REPLAY.name: REPLAY}


class ExportPanel:
    """The last step."""

    def __init__(self, gui: viser.GuiApi, post: Post, uploads: Uploads, deliver: Deliver) -> None:
        self._post, self._uploads, self._deliver = post, uploads, deliver
        self._sent = 0  # the newest export that was delivered
        self._now: Snapshot | None = None  # what was drawn last
        gui.add_html(markup.block("<b>Take it with you</b>: choose, and your browser keeps it."))
        gui.add_html(_STYLE)
        self._boxes = {
            name: gui.add_checkbox(label, name == "zip", hint=_sentence(_ALL[name].words))
            for name, label in LABELS.items()
        }
        self._anonymous = gui.add_checkbox(
            "Strip names",
            False,
            hint="Leaves out the names of files, sources, demonstrations and bodies",
        )
        self._export = gui.add_button("Export", icon=viser.Icon.DOWNLOAD)
        self._export.on_click(lambda _: self._ask())
        self._progress = gui.add_progress_bar(0.0, visible=False)
        self._cancel = gui.add_button("Cancel", color="gray", icon=viser.Icon.X, visible=False)
        self._cancel.on_click(lambda _: post(commands.CancelExport()))
        self._notes = gui.add_html("")
        gui.add_divider()
        self._open = gui.add_upload_button(
            "Open a session (.zip)",
            hint="Its demonstrations come beside those that are listed, with what was learned",
            mime_type=".zip,application/zip",
            icon=viser.Icon.FOLDER_OPEN,
        )
        self._open.on_upload(self._receive)
        self._opening = gui.add_html("")
        self._problem = gui.add_html("", visible=False)  # stays until another one is opened

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._now, status = now, now.export
        reasons = {name: why_not_export(now, name) for name in LABELS}
        for name, box in self._boxes.items():
            box.disabled = bool(reasons[name])
        running, refusal = bool(status.running), "" if self._chosen(now) else _NOTHING_CHOSEN
        self._export.disabled = running or bool(refusal)
        self._progress.visible = running
        self._cancel.visible = running or bool(status.opening)
        if running:
            share = round(100.0 * status.share)
            self._progress.value = share  # type: ignore[misc] # as in `show_value`
        self._notes.content = _notes(now, [*_grouped(reasons), refusal])
        self._opening.content = markup.note(f"Opening {status.opening} …") if status.opening else ""
        if status.opening:
            self._problem.visible = False

    def send(self, now: Snapshot) -> None:
        """Deliver what has been written since, whichever step is open by now."""
        if now.export.number != self._sent:
            self._sent = now.export.number
            self._deliver(now.export.files)

    @property
    def order(self) -> Order:
        """The palette's entry that exports what is ticked, whichever step is open."""
        return Order("Export what is ticked", self._asked, self._why_not)

    def _asked(self, now: Snapshot) -> commands.Export:
        return commands.Export(self._chosen(now), self._anonymous.value)

    def _why_not(self, now: Snapshot) -> str:
        if now.export.running:
            return "An export is being written: wait, or cancel it."
        return "" if self._chosen(now) else f"5 Export: {_NOTHING_CHOSEN}"

    def _ask(self) -> None:
        if self._now is not None:
            self._post(self._asked(self._now))

    def _chosen(self, now: Snapshot) -> tuple[str, ...]:
        return tuple(
            name for name, box in self._boxes.items() if box.value and not why_not_export(now, name)
        )

    def _receive(self, event: viser.GuiEvent[viser.GuiUploadButtonHandle]) -> None:
        file = event.target.value
        try:
            path = self._uploads.keep(file.name, file.content, _TOO_LARGE)
        except FileError as error:
            self._problem.content, self._problem.visible = markup.problem(str(error)), True
        else:
            self._problem.visible = False
            self._post(commands.OpenSession(path, shown_name(file.name)))


def _grouped(reasons: dict[str, str]) -> list[str]:
    """Return each reason once, with what it holds up."""
    words = []
    for reason in dict.fromkeys(filter(None, reasons.values())):
        held = [LABELS[name] for name, why in reasons.items() if why == reason]
        words.append(reason if len(held) == len(reasons) else f"{', '.join(held)}: {reason}")
    return words


def _notes(now: Snapshot, refusals: list[str]) -> str:
    status = now.export
    if status.running:
        labels = ", ".join(LABELS[name] for name in status.running)
        words = f"{labels}: {status.share:.0%}. The studio goes on meanwhile; a film takes longest."
        return markup.note(words)
    return markup.reasons(refusals)


def _sentence(words: str) -> str:
    return words[0].upper() + words[1:]
