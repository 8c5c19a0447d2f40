"""What was made of a recording comes back with it, and a broken card never costs the recording."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.cards import LARGEST, card_path, read_cards, takes_of, write_cards
from studio.engine.entry import LONGEST_NAME, Entry
from studio.engine.errors import FileError
from tests.engine.cards_at_hand import sample, take

CARD = Entry.of(1, take(1))
names = st.text(st.characters(codec="utf-8"), min_size=1, max_size=LONGEST_NAME).filter(
    lambda name: name.isprintable() and name == name.strip() != ""
)


@settings(deadline=None, derandomize=True, max_examples=40)
@given(names, st.booleans(), st.floats(0.0, 2.0), st.floats(3.5, 6.6))
def test_there_and_back(tmp_path_factory, name, included, begin, end) -> None:
    folder = tmp_path_factory.mktemp("cards", numbered=True)
    file = folder / "a.b.mcap"
    made = CARD.renamed(name).trimmed(begin, end)
    made = Entry(1, made.demonstration, made.whole, made.recording, included)
    write_cards(card_path(file), [made])
    (back,), problem = takes_of(sample(), "as recorded", file)
    assert problem == ""
    assert (back.demonstration.name, back.included) == (name, included)
    assert back.demonstration.sent.tobytes() == made.demonstration.sent.tobytes()
    assert back.demonstration.times.tobytes() == made.demonstration.times.tobytes()
    assert [path.name for path in folder.iterdir()] == ["a.b.card.json"]  # no name made a path


def test_without_a_card_it_is_as_recorded(tmp_path: Path) -> None:
    for file in (None, tmp_path / "none.mcap"):
        (shown,), problem = takes_of(sample(), "as recorded", file)
        assert (shown.demonstration.name, shown.included, problem) == ("as recorded", True, "")


def good() -> dict:
    return {
        "format": "teaching-studio card",
        "schema": 1,
        "demonstrations": [
            {
                "recorded_from": CARD.whole.first_sample,
                "name": "push",
                "first": CARD.whole.first_sample + 10,
                "last": CARD.whole.last_sample,
                "included": False,
            }
        ],
    }


def put(table: dict, key: str, value: object) -> str:
    table["demonstrations"][0][key] = value
    return json.dumps(table)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "valid JSON"),
        ("[]", "an object"),
        (json.dumps({**good(), "schema": 2}), "schema 1"),
        (json.dumps({**good(), "demonstrations": {}}), "a list"),
        (put(good(), "name", ""), "a name"),
        (put(good(), "name", "two\nlines"), "a name"),
        (put(good(), "name", 7), "a name"),
        (put(good(), "included", 1), "true or false"),
        (put(good(), "first", -1), "numbers of samples"),
        (put(good(), "last", 1e3), "numbers of samples"),
        (put(good(), "last", True), "numbers of samples"),
        (put(good(), "last", 10**30), "not recorded"),
        (put(good(), "first", 0), "not recorded"),
        ('{"a": ' * 100_000, "nested"),
    ],
)
def test_a_broken_card_is_told_and_leaves_the_recording_as_it_is(
    tmp_path: Path, text: str, words: str
) -> None:
    file = tmp_path / "demonstration-001.mcap"
    card_path(file).write_text(text)
    (shown,), problem = takes_of(sample(), "as recorded", file)
    assert (shown.demonstration.name, shown.included) == ("as recorded", True)
    assert words in problem
    assert "as recorded" in problem


def test_a_card_that_is_none_is_not_read_whole(tmp_path: Path) -> None:
    large = tmp_path / "large.card.json"
    large.write_bytes(b" " * (LARGEST + 1))
    with pytest.raises(FileError, match="larger"):
        read_cards(large)
    folder = tmp_path / "folder.card.json"
    folder.mkdir()
    with pytest.raises(FileError, match="cannot be read"):
        read_cards(folder)
    blob = tmp_path / "blob.card.json"
    blob.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(FileError, match="cannot be read"):
        read_cards(blob)


def test_only_the_demonstration_it_speaks_of_is_changed(tmp_path: Path) -> None:
    file = tmp_path / "demonstration-001.mcap"
    table = good()
    table["demonstrations"][0]["recorded_from"] += 1
    card_path(file).write_text(json.dumps(table))
    (shown,), problem = takes_of(sample(), "as recorded", file)
    assert (shown.demonstration.name, problem) == ("as recorded", "")
