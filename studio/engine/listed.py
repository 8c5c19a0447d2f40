"""The list of demonstrations: which are learned from, what is wrong with each, which is chosen."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from studio.engine.arms import Arms, in_words
from studio.engine.commands import Choose, Include, ListCommand, Rename, Trim
from studio.engine.demonstration import DemonstrationSet
from studio.engine.entry import Entry
from studio.engine.errors import NothingTaughtError, StudioError
from studio.engine.export.material import Take
from studio.engine.quality import flags_of
from studio.engine.retarget import Mapping
from studio.engine.scene import USUAL, Scene


class Listed:
    """See the module.

    Whatever changes what a demonstration is compared with makes its flags stale; `look` looks at
    one stale demonstration, so that a long list costs each tick little.
    """

    def __init__(self) -> None:
        self.entries: list[Entry] = []
        self.chosen = -1  # a number; -1 while nothing is listed
        self.newest = 0  # the highest number so far
        self._stale: dict[int, None] = {}  # numbers, as an ordered set

    @property
    def index(self) -> int:
        """Where on the list the chosen one is, -1 while nothing is listed."""
        numbers = [entry.number for entry in self.entries]
        return numbers.index(self.chosen) if numbers else -1

    def take(self, command: ListCommand) -> str:
        """Do what is asked, and return in words what came of it.

        Raises
        ------
        StudioError
            Where there is no demonstration of that number, or it cannot be changed so.
        """
        entry = self.entry(command.number)
        match command:
            case Choose():
                self.chosen = entry.number
            case Include(_, included):
                self._replace(entry, replace(entry, included=included))
            case Trim(_, begin, end):
                self._replace(entry, entry.trimmed(begin, end))
            case Rename(_, name):
                self._put(entry.renamed(name))
        return ""

    def add(self, takes: Sequence[Take], file: Path | None = None) -> list[Entry]:
        """List takes of one file, if it is one of the studio's own, and return their cards."""
        added = []
        for take in takes:
            self.newest += 1
            added.append(Entry.of(self.newest, take, file))
        self.entries += added
        for entry in added:
            self._make_stale(entry)
        if self.chosen < 0 and added:
            self.chosen = added[0].number
        return added

    def remove(self, number: int) -> tuple[int, Entry]:
        """Take a demonstration off the list; return where it was, and itself."""
        removed = self.entry(number)
        place = self.entries.index(removed)
        del self.entries[place]
        if self.chosen == number:
            left = self.entries[place : place + 1] or self.entries[-1:]
            self.chosen = left[0].number if left else -1
        self._make_stale(removed)
        return place, removed

    def insert(self, place: int, entry: Entry) -> None:
        """Put a demonstration back to where it was."""
        self.entries.insert(place, entry)
        self.chosen = entry.number
        self._make_stale(entry)

    def move(self, number: int, place: int) -> None:
        """Put a demonstration elsewhere on the list, and choose it."""
        entry = self.entry(number)
        self.entries.remove(entry)
        self.insert(place, entry)

    def entry(self, number: int) -> Entry:
        """Return a listed demonstration; raise StudioError where none has that number."""
        for entry in self.entries:
            if entry.number == number:
                return entry
        raise StudioError("There is no such demonstration on the list")

    def takes(self) -> tuple[Take, ...]:
        """Return all of the list, as exports take it."""
        return tuple(entry.take for entry in self.entries)

    def taught(self, arms: Arms, mapping: Mapping, scene: Scene = USUAL) -> DemonstrationSet:
        """Return the included demonstrations of these arms and mapping, in that scene.

        Raises
        ------
        NothingTaughtError
            Where none is listed, or all are left out.
        """
        listed = [each for each in self.entries if each.is_of(arms, mapping, scene)]
        included = [each.demonstration for each in listed if each.included]
        where = "" if scene.is_same_as(USUAL) else f" in the scene {scene.name_beside(USUAL)}"
        what = f"demonstration by {in_words(arms)} with the {mapping} mapping{where}"
        if not listed:
            raise NothingTaughtError(f"No {what}: record one first")
        if not included:
            raise NothingTaughtError(f"Every {what} is left out: include one first")
        return DemonstrationSet.of(included)

    def look(self) -> bool:
        """Look for what is wrong with one demonstration; return whether more of them wait."""
        if self._stale:
            entry = self.entry(next(iter(self._stale)))
            del self._stale[entry.number]
            peers = [
                each.demonstration
                for each in self.entries
                if each.included and each is not entry and each.is_alike(entry)
            ]
            self._put(replace(entry, flags=flags_of(entry.demonstration, entry.recording, peers)))
        return bool(self._stale)

    def _replace(self, entry: Entry, changed: Entry) -> None:
        """Put a changed demonstration in its place, and compare it and the others anew."""
        self._put(changed)
        self._make_stale(entry)

    def _put(self, entry: Entry) -> None:
        numbers = [each.number for each in self.entries]
        self.entries[numbers.index(entry.number)] = entry

    def _make_stale(self, changed: Entry) -> None:
        """Have all looked at that are compared with a demonstration, itself first of all."""
        alike = [each.number for each in self.entries if each.is_alike(changed)]
        alike.sort(key=lambda number: number != changed.number)
        self._stale.pop(changed.number, None)
        self._stale = dict.fromkeys(alike) | self._stale
