"""A table of a TOML file, read strictly: each key is asked for once, and none may be left over.

Every problem names the file, the place in it, what was expected, and what comes nearest.
"""

import difflib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from studio.engine.errors import FileError


@dataclass(frozen=True)
class Range:
    """What a number may be, its ends included."""

    least: float
    most: float
    unit: str = ""

    def __str__(self) -> str:
        return f"{self.least:g} to {self.most:g} {self.unit}".rstrip()


@dataclass(frozen=True)
class Table:
    """A table and where it stands: ``file`` as people know it, ``place`` as ``block 2``.

    All that reads raises FileError where what is there is not what was asked for.
    """

    file: str
    place: str  # empty for the file's top level
    values: Mapping[str, object]
    asked: set[str] = field(default_factory=set)

    def text(self, key: str, longest: int) -> str:
        """Return a text of one line that is not empty, of ``longest`` characters at most."""
        value = self._take(key, "a text")
        if not isinstance(value, str) or not value.strip():
            raise self.wrong(key, f"expected a text in quotes, found {_shown(value)}")
        if len(value) > longest:
            raise self.wrong(
                key, f"expected {longest} characters at most, found {len(value):,}: shorten it"
            )
        if not value.isprintable():
            raise self.wrong(
                key,
                "expected one line that can be printed, without control characters, found "
                f"{_shown(value)}: leave them out",
            )
        return value

    def one_of(self, key: str, choices: Iterable[str], default: str | None = None) -> str:
        """Return a text that is one of ``choices``."""
        known = tuple(choices)
        value = self._take(key, f"one of {', '.join(known)}", default)
        if value not in known:
            near = _nearest(value, known) if isinstance(value, str) else ""
            raise self.wrong(
                key, f"expected one of {', '.join(known)}, found {_shown(value)}{near}"
            )
        return str(value)

    def flag(self, key: str, default: bool | None = None) -> bool:
        """Return true or false."""
        value = self._take(key, "true or false", default)
        if not isinstance(value, bool):
            raise self.wrong(key, f"expected true or false, without quotes, found {_shown(value)}")
        return value

    def number(self, key: str, within: Range) -> float:
        """Return a number within a range."""
        return self._number(key, self._take(key, f"a number, {within}"), within)

    def numbers(self, key: str, count: int, within: Range) -> tuple[float, ...]:
        """Return so many numbers, each within a range."""
        value = self._take(key, f"{count} numbers")
        if not isinstance(value, list) or len(value) != count:
            raise self.wrong(key, f"expected {count} numbers in brackets, found {_shown(value)}")
        return tuple(self._number(f"{key}[{i}]", each, within) for i, each in enumerate(value))

    def table(self, key: str) -> "Table":
        """Return the table of that name."""
        value = self._take(key, f"a table [{key}]")
        if not isinstance(value, dict):
            raise self.wrong(key, f"expected a table [{key}], found {_shown(value)}")
        return Table(self.file, self._at(key), value)

    def tables(self, key: str, needed: bool = False) -> list["Table"]:
        """Return all tables [[key]]; one at least where they are ``needed``."""
        default: list[object] | None = None if needed else []
        value = self._take(key, f"one table [[{key}]] or more", default)
        if not isinstance(value, list) or not all(isinstance(each, dict) for each in value):
            raise self.wrong(
                key, f"expected tables [[{key}]], in two brackets, found {_shown(value)}"
            )
        if needed and not value:
            raise self.wrong(key, f"expected one table [[{key}]] or more, found none")
        return [
            Table(self.file, f"{self._at(key)} {number}", each)
            for number, each in enumerate(value, 1)
        ]

    def end(self) -> None:
        """Say that there is nothing more to read here; raise FileError for any other key."""
        for key in self.values:
            if key not in self.asked:
                keys = ", ".join(sorted(self.asked))
                near = _nearest(key, self.asked)
                raise self.wrong(key, f"there is no such key here{near}. There are: {keys}")

    def wrong(self, key: str, what: str) -> FileError:
        """Return the error that says what is wrong with a key."""
        return FileError(f"{self.file}: {self._at(key)}: {what}")

    def unknown(self, key: str, what: str, name: str, known: Iterable[str]) -> FileError:
        """Return the error of a name that nothing has."""
        names = tuple(known)
        there = ", ".join(repr(each) for each in names) or "none at all"
        near = _nearest(name, names)
        return self.wrong(key, f"there is no {what} {name!r}{near}. There are: {there}")

    def _take(self, key: str, what: str, default: object = None) -> object:
        self.asked.add(key)
        if key in self.values:
            return self.values[key]
        if default is None:
            near = difflib.get_close_matches(key, set(self.values) - self.asked, n=1)
            instead = f"; is {near[0]!r} meant to be it?" if near else f": add {key} = ..."
            raise self.wrong(key, f"expected {what}, found nothing{instead}")
        return default

    def _number(self, key: str, value: object, within: Range) -> float:
        number = _as_float(value)
        if not math.isfinite(number):
            raise self.wrong(key, f"expected a number, {within}, found {_shown(value)}")
        if not within.least <= number <= within.most:
            nearest = min(max(number, within.least), within.most)
            raise self.wrong(
                key, f"expected {within}, found {number:g}; the nearest is {nearest:g}"
            )
        return number

    def _at(self, key: str) -> str:
        return f"{self.place}.{key}" if self.place else key


def _as_float(value: object) -> float:
    """Return a number; NaN for what is none, or a whole one beyond all floats."""
    if not isinstance(value, int | float) or isinstance(value, bool):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.nan


def _shown(value: object) -> str:
    """Return a value as it may stand in a message: not at any length."""
    try:
        return f"{value!r:.80}"
    except ValueError:  # Python writes out no whole number of more than some thousand digits
        return "a number of thousands of digits"


def _nearest(name: str, known: Iterable[str]) -> str:
    near = difflib.get_close_matches(name, list(known), n=1, cutoff=0.5)
    return f"; the nearest is {near[0]!r}" if near else ""
