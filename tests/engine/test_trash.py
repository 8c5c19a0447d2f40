"""Delete really deletes, once nobody can undo it, and never what was not made here."""

from pathlib import Path

import pytest

from studio.engine.cards import card_path
from studio.engine.errors import StudioError
from studio.engine.listed import Listed
from studio.engine.trash import Trash
from tests.engine.cards_at_hand import take, takes


def made(folder: Path, *names: str) -> tuple[Listed, Trash, list[Path]]:
    """Return a list of demonstrations, each of a file with cards, and those files."""
    listed, files = Listed(), [folder / name for name in names]
    for number, file in enumerate(files, start=1):
        file.touch()
        card_path(file).touch()
        listed.add([take(number)], file)
    return listed, Trash(listed), files


def left(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_undo_brings_it_back_to_its_place_and_its_file_was_never_touched(tmp_path: Path) -> None:
    listed, trash, _ = made(tmp_path, "a.mcap", "b.mcap", "c.mcap")
    before, files = list(listed.entries), left(tmp_path)
    trash.remove(2)
    assert [entry.number for entry in listed.entries] == [1, 3]
    assert (trash.name, trash.goes_too) == ("take 2", "b.mcap")
    assert left(tmp_path) == files
    assert trash.restore().name == "take 2"
    assert listed.entries[1].demonstration is before[1].demonstration
    assert (trash.name, trash.goes_too) == ("", "")
    assert trash.empty() == ""
    assert left(tmp_path) == files
    with pytest.raises(StudioError, match="nothing to bring back"):
        trash.restore()


def test_the_next_one_ends_the_time_of_the_one_before(tmp_path: Path) -> None:
    _, trash, _ = made(tmp_path, "a.mcap", "b.mcap")
    trash.remove(1)
    trash.remove(2)
    assert left(tmp_path) == {"b.mcap", "b.card.json"}
    assert "b.mcap are gone for good" in trash.empty()
    assert left(tmp_path) == set()


def test_what_is_not_there_deletes_nothing(tmp_path: Path) -> None:
    _, trash, _ = made(tmp_path, "a.mcap")
    trash.remove(1)
    with pytest.raises(StudioError, match="no such demonstration"):
        trash.remove(7)
    assert left(tmp_path) == {"a.mcap", "a.card.json"}
    assert trash.restore().name == "take 1"


def test_a_file_with_another_demonstration_stays_until_that_goes_too(tmp_path: Path) -> None:
    listed, trash, (file,) = made(tmp_path, "a.mcap")
    listed.add([take(1)], file)
    trash.remove(1)
    assert trash.goes_too == ""
    assert "holds another one, and stays" in trash.empty()
    trash.remove(2)
    assert trash.goes_too == "a.mcap"
    trash.empty()
    assert left(tmp_path) == set()


def test_what_was_not_made_here_stays(tmp_path: Path) -> None:
    listed = Listed()
    listed.add(takes(2))
    trash = Trash(listed)
    trash.remove(1)
    assert trash.goes_too == ""
    assert "was not made here, and stays" in trash.empty()


def test_a_file_that_has_gone_already_is_no_error(tmp_path: Path) -> None:
    _, trash, (file,) = made(tmp_path, "a.mcap")
    trash.remove(1)
    file.unlink()
    assert "gone for good" in trash.empty()
