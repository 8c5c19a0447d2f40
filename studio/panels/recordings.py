"""The recordings folder: what lies in it, what is broken in it, and what is opened from it."""

from datetime import datetime
from pathlib import Path

import viser

from studio.engine import commands
from studio.engine.collection import CollectionStatus
from studio.engine.recordings_folder import FolderFile
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.inputs import Post

_NONE = "nothing to open"
_SHOWN_PROBLEMS = 5


class RecordingsPanel:
    """A part of the second step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._post = post
        self._names: dict[str, str] = {}  # of files, by what is shown of each
        self._drawn: object = None
        with gui.add_folder("Recordings folder", expand_by_default=False):
            self._where = gui.add_html("")
            self._choice = gui.add_dropdown("File", (_NONE,), disabled=True)
            self._open = gui.add_button(
                "Open it",
                hint="Lists its demonstrations, beside those that are listed",
                icon=viser.Icon.FOLDER_OPEN,
                disabled=True,
            )
            self._open.on_click(lambda _: self._open_chosen())
            self._problems = gui.add_html("")
            self._path = gui.add_text(
                "Other path",
                "",
                hint="A folder of recordings, a recording or a session (.zip) on the machine that "
                "runs the studio; uploads are in 1 Source and 5 Export",
            )
            self._add = gui.add_button("Add what is there", icon=viser.Icon.PLUS, color="gray")
            self._add.on_click(lambda _: self._add_path())

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        status = now.collection
        state = (status.files, status.listed, status.problem, now.recorded > 0, now.saved_as)
        if state == self._drawn:
            return
        self._drawn = state
        # What is being written has no index yet, and would seem to be cut off.
        newest = status.files[:1] if now.recorded else ()
        files = tuple(f for f in status.files if f not in newest or not f.problem)
        self._where.content = described(status, len(files))
        self._problems.content = broken(files)
        self._names = {
            label(file): file.path.name
            for file in files
            if file.can_open and file.path not in status.listed
        }
        self._choice.options = tuple(self._names) or (_NONE,)
        self._choice.disabled = self._open.disabled = not self._names

    def _open_chosen(self) -> None:
        name = self._names.get(self._choice.value)
        if name is not None:
            self._post(commands.OpenRecording(name))

    def _add_path(self) -> None:
        typed = self._path.value.strip()
        if typed:
            self._post(commands.AddFrom(Path(typed)))


def label(file: FolderFile) -> str:
    """Return a file as a line: its name, how long it is and when it was made."""
    seconds = (
        "session" if file.is_session else "" if file.seconds is None else f"{file.seconds:.0f} s"
    )
    made = datetime.fromtimestamp(file.modified).strftime("%d %b %H:%M")
    return " · ".join(part for part in (file.path.stem, seconds, made) if part)


def described(status: CollectionStatus, count: int) -> str:
    """Return which folder it is and what lies in it, as HTML."""
    if status.problem:
        return markup.problem(status.problem)
    if not count:
        return markup.note(f"Empty so far: {status.folder}")
    listed = sum(file.path in status.listed for file in status.files)
    words = f"{count} file{'s' if count > 1 else ''}, {listed} on the list: {status.folder}"
    return markup.note(words)


def broken(files: tuple[FolderFile, ...]) -> str:
    """Return what is wrong with files, as HTML; nothing where all is well."""
    wrong = [file for file in files if file.problem]
    lines = [f"{file.path.name}: {file.problem}." for file in wrong[:_SHOWN_PROBLEMS]]
    if len(wrong) > _SHOWN_PROBLEMS:
        lines.append(f"{len(wrong) - _SHOWN_PROBLEMS} more.")
    return markup.reasons(lines)
