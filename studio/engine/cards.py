"""What people made of a recording's demonstrations, in a small file beside it.

    {"format": "teaching-studio card", "schema": 1,
     "demonstrations": [{"recorded_from": 61, "name": "push", "first": 75, "last": 230,
                         "included": true}]}

The recording itself is never touched: beside ``demonstration-001.mcap`` lies
``demonstration-001.card.json``. Samples count from 0; ``recorded_from`` is where the whole
demonstration begins, which tells it from others of the same recording.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from studio.engine.demonstration import Demonstration, demonstrations_of
from studio.engine.entry import LONGEST_NAME, Entry
from studio.engine.errors import FileError, StudioError
from studio.engine.export.material import Take, cut
from studio.engine.recording import Recording
from studio.engine.sources.strict_json import as_list, as_object, parse_json
from studio.engine.sources.whole_file import written_whole

FORMAT, SCHEMA = "teaching-studio card", 1
LARGEST = 1 << 20  # [bytes]; ours take 100 a demonstration


@dataclass(frozen=True)
class Card:
    """What was made of one demonstration."""

    recorded_from: int  # the sample with which the whole of it begins
    name: str
    first: int  # sample
    last: int
    included: bool

    @classmethod
    def of(cls, entry: Entry) -> "Card":
        """Return what was made of a listed demonstration."""
        kept = entry.demonstration
        return cls(
            entry.whole.first_sample, kept.name, kept.first_sample, kept.last_sample, entry.included
        )

    def applied(self, whole: Demonstration, recording: Recording) -> Take:
        """Return the take that it makes of a demonstration of its recording.

        Raises
        ------
        StudioError
            Where it says what cannot be done.
        """
        whole = replace(whole, name=self.name)
        if (self.first, self.last) == (whole.first_sample, whole.last_sample):
            return Take(whole, recording, self.included)
        if not whole.first_sample <= self.first < self.last <= whole.last_sample:
            raise StudioError(f"{self.name} is trimmed to what was not recorded")
        return Take(cut(recording, self.name, self.first, self.last), recording, self.included)


def card_path(recording: Path) -> Path:
    """Return where the cards of a recording's file are."""
    return recording.with_suffix(".card.json")


def takes_of(recording: Recording, name: str, file: Path | None) -> tuple[list[Take], str]:
    """Return a recording's demonstrations as people left them, and what went wrong with that."""
    found = demonstrations_of(recording, name)
    try:
        cards = {} if file is None else read_cards(card_path(file))
        return [
            cards[each.first_sample].applied(each, recording)
            if each.first_sample in cards
            else Take(each, recording)
            for each in found
        ], ""
    except StudioError as error:
        words = f"{error}; names and trims are as recorded"
        return [Take(each, recording) for each in found], words


def write_cards(path: Path, entries: Sequence[Entry]) -> None:
    """Write the cards of one recording's demonstrations; raise FileError where that fails."""
    table = {
        "format": FORMAT,
        "schema": SCHEMA,
        "demonstrations": [vars(Card.of(entry)) for entry in entries],
    }
    with written_whole(path) as unfinished:
        unfinished.write_text(json.dumps(table, indent=1), encoding="utf-8")


def read_cards(path: Path) -> dict[int, Card]:
    """Return the cards by where their demonstrations begin; none where there is no such file.

    Raises
    ------
    FileError
        Where the file cannot be read, or is none of the studio's.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise FileError(f"{path}: larger than {LARGEST:,} bytes; delete it")
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return {}
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{path}: cannot be read: {error}") from None
    try:
        table = as_object(parse_json(text), "the cards")
        if (table.get("format"), table.get("schema")) != (FORMAT, SCHEMA):
            raise StudioError(f"expected {FORMAT!r} of schema {SCHEMA}")  # noqa: TRY301
        cards = [_card(value) for value in as_list(table.get("demonstrations"), "demonstrations")]
    except StudioError as error:
        raise FileError(f"{path}: {error}; delete it") from None
    return {card.recorded_from: card for card in cards}


def _card(value: object) -> Card:
    table = as_object(value, "a card")
    name, included = table.get("name"), table.get("included")
    if not isinstance(name, str) or not name.isprintable() or not 0 < len(name) <= LONGEST_NAME:
        raise StudioError(f"expected a name of 1 to {LONGEST_NAME} characters, found {name!r:.80}")
    if not isinstance(included, bool):
        raise StudioError(f"included: expected true or false, found {included!r:.60}")
    numbers = [table.get(key) for key in ("recorded_from", "first", "last")]
    whole = [number for number in numbers if type(number) is int and number >= 0]
    if len(whole) < len(numbers):
        raise StudioError(f"expected numbers of samples, found {numbers!r:.60}")
    return Card(whole[0], name, whole[1], whole[2], included)
