"""Every message that a test exchanges, held against the schema that is in the repository."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from websockets.sync.client import ClientConnection

from studio.remote import link

SCHEMA = Path(__file__).resolve().parents[2] / "docs" / "remote.schema.json"


class UndocumentedError(AssertionError):
    """A message that the schema does not know, or not so."""


class Overheard:
    """Both ends' messages; `check` wants all of them documented. Threads may tell it.

    ``garbage`` is what a test sends though it is no message, and says so beforehand.
    """

    def __init__(self) -> None:
        self.garbage: set[str] = set()
        self._messages: list[tuple[str, str]] = []
        self._parts = json.loads(SCHEMA.read_text())["$defs"]
        self._validators: dict[tuple[str, str], Draft202012Validator] = {}

    def __call__(self, side: str, message: str) -> None:
        self._messages.append((side, message))

    def check(self) -> int:
        """Return how many messages were exchanged; raise an error where one is not known."""
        for side, message in dict.fromkeys(self._messages):  # floods are thousands of the same
            if side != "asked" or message not in self.garbage:
                self._check(side, message)
        return len(self._messages)

    def types(self, side: str) -> set[str]:
        """The types of all messages of one side."""
        return {json.loads(text)["type"] for each, text in self._messages if each == side}

    def count(self, side: str, kind: str) -> int:
        """How many messages of one side are of a type."""
        told = (json.loads(text)["type"] for each, text in list(self._messages) if each == side)
        return sum(each == kind for each in told)

    def _check(self, side: str, message: str) -> None:
        try:
            found = json.loads(message)
        except ValueError:
            raise UndocumentedError(f"{side}: not even JSON: {message:.300}") from None
        kind = str(found.get("type")) if isinstance(found, dict) else ""
        for error in self._validator(side, kind).iter_errors(found):
            raise UndocumentedError(f"{side}: {error.json_path}: {error.message:.300}")

    def _validator(self, side: str, kind: str) -> Draft202012Validator:
        """Return the validator of a message: of the one alternative that has its type.

        To try all seventeen of them for each of some thousand messages would take minutes.
        """
        if (side, kind) not in self._validators:
            union = {"asked": "Asked", "told": "Told"}[side]
            names = [each["$ref"].rpartition("/")[2] for each in self._parts[union]["anyOf"]]
            mine = [n for n in names if self._parts[n]["properties"]["type"]["enum"] == [kind]]
            if not mine:
                raise UndocumentedError(
                    f"{side}: there is no message of type {kind!r} in the schema"
                )
            whole = {"$ref": f"#/$defs/{mine[0]}", "$defs": self._parts}
            self._validators[side, kind] = Draft202012Validator(whole)
        return self._validators[side, kind]


class Tapped:
    """The line of a client of ours to a studio in another process: what goes over it is heard."""

    def __init__(self, line: ClientConnection, overheard: Overheard) -> None:
        self._line, self._overheard = line, overheard

    def send(self, message: str) -> None:
        self._overheard("asked", message)
        self._line.send(message)

    def __iter__(self) -> Iterator[str]:
        for message in self._line:
            self._overheard("told", str(message))
            yield str(message)

    def close(self) -> None:
        self._line.close()


@pytest.fixture
def tapped(monkeypatch) -> Iterator[Overheard]:
    """All lines of our client from here on; in the end all that went over them is documented."""
    overheard, opened = Overheard(), link._opened
    monkeypatch.setattr(link, "_opened", lambda *how: Tapped(opened(*how), overheard))
    yield overheard
    assert overheard.check() > 0
