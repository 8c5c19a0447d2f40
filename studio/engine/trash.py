"""What was deleted last: it comes back, until another one is deleted or it is deleted for good.

Then its file goes too, if the studio made it and no listed demonstration is in it. Files from
elsewhere, the samples first of all, stay.
"""

from pathlib import Path

from studio.engine.cards import card_path
from studio.engine.entry import Entry
from studio.engine.errors import StudioError
from studio.engine.listed import Listed


class Trash:
    """See the module."""

    def __init__(self, listed: Listed) -> None:
        self._listed = listed
        self._removed: tuple[int, Entry] | None = None  # and where it was on the list

    @property
    def name(self) -> str:
        """What can be brought back, or nothing."""
        return "" if self._removed is None else self._removed[1].name

    @property
    def goes_too(self) -> str:
        """The name of the file that goes with it, or nothing."""
        return "" if self._removed is None else self._file_of(self._removed[1])

    def remove(self, number: int) -> int:
        """Take a demonstration off the list, which ends the time of the one before.

        Returns
        -------
        int
            Where on the list it was.

        Raises
        ------
        StudioError
            Where there is no demonstration of that number; then nothing is deleted.
        """
        self._listed.entry(number)
        self.empty()
        self._removed = self._listed.remove(number)
        return self._removed[0]

    def restore(self) -> Entry:
        """Bring back what was deleted last, and return it.

        Raises
        ------
        StudioError
            Where there is nothing to bring back.
        """
        if self._removed is None:
            raise StudioError("There is nothing to bring back")
        (place, entry), self._removed = self._removed, None
        self._listed.insert(place, entry)
        return entry

    def spare(self, file: Path | None) -> None:
        """Keep a file, whose demonstrations are about to be listed again."""
        if file is not None and self._removed is not None and self._removed[1].file == file:
            self._removed = None

    def empty(self) -> str:
        """Delete for good what was deleted last; return in words what became of it, if anything."""
        if self._removed is None:
            return ""
        (_, entry), self._removed = self._removed, None
        file = self._file_of(entry)
        if entry.file is not None and file:
            card_path(entry.file).unlink(missing_ok=True)
            entry.file.unlink(missing_ok=True)
            return f"{entry.name} and its file {file} are gone for good."
        is_shared = any(each.recording is entry.recording for each in self._listed.entries)
        why = "holds another one" if is_shared else "was not made here"
        return f"{entry.name} is gone; its file {why}, and stays."

    def _file_of(self, entry: Entry) -> str:
        others = {each.file for each in self._listed.entries}
        return "" if entry.file is None or entry.file in others else entry.file.name
