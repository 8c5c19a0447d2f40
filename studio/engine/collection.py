"""The demonstrations and their files: what is opened, merged, kept, changed and deleted."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from studio.engine.cards import card_path, takes_of, write_cards
from studio.engine.commands import (
    AddFrom,
    Choose,
    Command,
    DeleteForGood,
    ListCommand,
    OpenRecording,
    OpenSession,
    Remove,
    Restore,
    TeachCommand,
    UseFile,
)
from studio.engine.entry import Entry
from studio.engine.errors import FileError, NothingTaughtError, StudioError
from studio.engine.export.session_reader import is_session
from studio.engine.listed import Listed
from studio.engine.mcap_log import is_mcap
from studio.engine.recording import Recording
from studio.engine.recordings_folder import FolderFile, look_into
from studio.engine.robot import CONTROL_RATE
from studio.engine.skeleton import SIDES, HandState
from studio.engine.trash import Trash

SAVE_EVERY = CONTROL_RATE  # ticks between two writings of changed cards
LOOK_EVERY = 3 * CONTROL_RATE  # ticks between two looks into the recordings folder
NEW_AT_ONCE = 5  # files that one look reads the index of, some 2 ms each
MOST_ADDED = 100  # files of a folder


@dataclass(frozen=True)
class CollectionStatus:
    """What people should know of files."""

    folder: str = ""
    files: tuple[FolderFile, ...] = ()  # in the recordings folder, the newest first
    problem: str = ""  # why the folder cannot be listed
    listed: frozenset[Path] = frozenset()  # files whose demonstrations are listed
    removed: str = ""  # what can be brought back
    goes_too: str = ""  # the file that goes with it, if one does


class Collection:
    """See the module.

    Parameters
    ----------
    folder
        Where recordings are made.
    post
        Asks the session for something, such as reading a file.
    """

    def __init__(self, folder: Path, post: Callable[[Command], None]) -> None:
        self.listed = Listed()
        self._folder, self._post = folder, post
        self._trash = Trash(self.listed)
        self._files: tuple[FolderFile, ...] = ()
        self._problem = ""
        self._unsaved: set[Path] = set()  # files whose cards changed
        self._ticks = 0

    def take(self, command: TeachCommand) -> str:
        """Do what is asked, and return in words what came of it.

        Raises
        ------
        StudioError
            Where it cannot be done.
        """
        match command:
            case Remove(number):
                name = self.listed.entry(number).name
                self._remove(number)
                return f"Deleted {name}. Undo brings it back, until the next one goes."
            case Restore():
                entry = self._trash.restore()
                self._changed(entry)
                return f"{entry.name} is back."
            case DeleteForGood():
                self._ticks = 0
                return self._trash.empty() or "There is nothing left to delete."
            case OpenRecording(name):
                return self._open(name)
            case AddFrom(path):
                return self._add_from(path.expanduser(), command.shown)
            case _:
                return self._change(command)

    def step(self) -> None:
        """Let a tick pass.

        Raises
        ------
        FileError
            Where changed cards cannot be written; they stay as they are on the list.
        """
        self.listed.look()
        if self._ticks % LOOK_EVERY == 0 or any(not file.was_read for file in self._files):
            self._look()
        self._ticks += 1
        if self._ticks % SAVE_EVERY == 0:
            self._save()

    def close(self) -> None:
        """Save what was changed; what was deleted can no longer be undone."""
        try:
            self._save()
        finally:
            self._trash.empty()

    def add(self, recording: Recording, name: str, path: Path, replaces: int | None = None) -> str:
        """List a recording's demonstrations; return in words what was found in it.

        ``path`` is where it was read from or has just been written to. It takes the place of the
        demonstration of the number ``replaces``, which is deleted.

        Raises
        ------
        StudioError
            Where nothing armed in it, it is listed already, or its cards cannot be used; then it
            is listed as it was recorded.
        """
        self._ticks = 0
        file = self._own(path)
        if any(file is not None and entry.file == file for entry in self.listed.entries):
            raise StudioError(f"{name} is on the list already")
        takes, problem = takes_of(recording, name.removesuffix(".mcap"), path)
        if not takes:
            raise NothingTaughtError(why_nothing_armed(recording, name))
        self._trash.spare(file)
        added = self.listed.add(takes, file)
        if replaces is not None and any(e.number == replaces for e in self.listed.entries):
            self._replace(replaces, added)
        if problem:
            raise FileError(problem)
        return recording.warning or f"Added {', '.join(entry.name for entry in added)}."

    def status(self) -> CollectionStatus:
        """Return what people should know."""
        return CollectionStatus(
            folder=str(self._folder),
            files=self._files,
            problem=self._problem,
            listed=frozenset(entry.file for entry in self.listed.entries if entry.file),
            removed=self._trash.name,
            goes_too=self._trash.goes_too,
        )

    def _change(self, command: ListCommand) -> str:
        words = self.listed.take(command)
        if not isinstance(command, Choose):
            self._changed(self.listed.entry(command.number))
        return words

    def _changed(self, entry: Entry) -> None:
        """Have the cards of an entry's recording written, if it is one of the studio's own."""
        if entry.file is not None:
            self._unsaved.add(entry.file)

    def _own(self, path: Path) -> Path | None:
        """Return where a file lies in the recordings folder; None where it lies elsewhere."""
        is_own = path.parent.resolve() == self._folder.resolve()
        return self._folder / path.name if is_own else None

    def _open(self, name: str) -> str:
        file = next((each for each in self._files if each.path.name == name), None)
        if file is None:
            raise StudioError(f"{name} is not in the recordings folder (any more)")
        if any(entry.file == file.path for entry in self.listed.entries):
            raise StudioError(f"{name} is on the list already")
        if not file.can_open:
            raise FileError(f"{name}: {file.problem}")
        return self._add_from(file.path, name)

    def _add_from(self, path: Path, shown: str) -> str:
        if not path.is_dir():
            if path.exists() and not path.is_file():
                raise FileError(f"{path}: a pipe or a device, and no recording: choose a file")
            self._post(OpenSession(path, shown) if is_session(path) else UseFile(path, shown))
            return ""
        found = sorted(file for file in path.glob("*.mcap") if is_mcap(file))[:MOST_ADDED]
        if not found:
            raise FileError(f"{path}: there is no recording in that folder")
        for file in found:
            self._post(UseFile(file))
        return f"Adding {len(found)} recordings of {shown}."

    def _remove(self, number: int) -> int:
        self._ticks = 0  # look into the folder: what was deleted before may be gone now
        return self._trash.remove(number)

    def _replace(self, number: int, added: Sequence[Entry]) -> None:
        """Put what was recorded again where the old one is, which is deleted."""
        for place, entry in enumerate(added, start=self._remove(number)):
            self.listed.move(entry.number, place)

    def _look(self) -> None:
        known = {file.path: file for file in self._files}
        try:
            self._files, self._problem = look_into(self._folder, known, NEW_AT_ONCE), ""
        except FileError as error:
            self._files, self._problem = (), str(error)

    def _save(self) -> None:
        """Write the cards that changed beside their recordings."""
        while self._unsaved:
            file = self._unsaved.pop()
            entries = [entry for entry in self.listed.entries if entry.file == file]
            if entries and file.exists():
                write_cards(card_path(file), entries)


def why_nothing_armed(recording: Recording, name: str) -> str:
    """Return why a recording teaches nothing: what held the robot most of the time, or no signs."""
    bodies = [sample.skeleton for sample in recording.samples if sample.skeleton is not None]
    if bodies and all(
        body.hand(side).state is HandState.UNKNOWN for body in bodies for side in SIDES
    ):
        return (
            f"{name}: nothing armed: its source tells no hand states. Choose the open gate, which "
            "needs no signs, then record it again"
        )
    held = Counter(sample.held for sample in recording.samples if sample.held)
    why = held.most_common(1)[0][0] if held else "it ended too soon"
    return f"{name}: nothing armed for a second or more: {why}"
