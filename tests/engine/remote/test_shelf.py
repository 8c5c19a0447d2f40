"""Files of programs: kept under names of our own, capped, and named by nothing but names."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from studio.engine import uploads
from studio.engine.errors import FileError, StudioError
from studio.engine.remote import shelf as module
from studio.engine.remote.shelf import Shelf
from studio.remote.asked import PART, FetchFile, Upload
from studio.remote.files import OnStudio, Recorded, Sample, Uploaded


@pytest.fixture
def shelf():
    made = Shelf()
    yield made
    made.close()


def holding(tmp_path: Path, *names: str) -> SimpleNamespace:
    """A snapshot with files in the recordings folder, all of them exported too."""
    paths = [tmp_path / name for name in names]
    for path in paths:
        path.write_bytes(path.name.encode())
    collection = SimpleNamespace(files=[SimpleNamespace(path=path) for path in paths])
    return SimpleNamespace(collection=collection, export=SimpleNamespace(files=tuple(paths)))


def test_parts_become_one_file_under_a_name_of_our_own(shelf: Shelf, tmp_path: Path) -> None:
    first = shelf.take("program 1", Upload(1, b"ab", "../../evil.mcap"))
    second = shelf.take("program 1", Upload(2, b"cd", upload=first.upload))
    assert (first.size, second.size, second.upload) == (2, 4, first.upload)
    path, name = shelf.find("program 1", Uploaded(first.upload), holding(tmp_path))
    assert path.read_bytes() == b"abcd"
    assert name == "evil.mcap"
    assert "evil" not in str(path)
    shelf.close()
    assert not path.exists()


def test_nobody_gets_at_anothers_uploads(shelf: Shelf, tmp_path: Path) -> None:
    upload = shelf.take("program 1", Upload(1, b"ab", "mine")).upload
    with pytest.raises(StudioError, match="has uploaded no"):
        shelf.find("program 2", Uploaded(upload), holding(tmp_path))
    with pytest.raises(StudioError, match="has uploaded no"):
        shelf.take("program 2", Upload(1, b"cd", upload=upload))


def test_sizes_are_capped(shelf: Shelf, monkeypatch) -> None:
    monkeypatch.setattr(uploads, "LARGEST", 100)
    with pytest.raises(FileError, match="empty"):
        shelf.take("program 1", Upload(1, b"", "nothing"))
    upload = shelf.take("program 1", Upload(1, bytes(60), "much")).upload
    with pytest.raises(FileError, match="much: "):
        shelf.take("program 1", Upload(1, bytes(60), upload=upload))


def test_the_total_is_capped_in_words_and_what_is_freed_is_room_again(
    shelf: Shelf, monkeypatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(module, "MOST_KEPT", 20_000)
    upload = shelf.take("program 1", Upload(1, bytes(9_000), "much")).upload
    shelf.take("program 1", Upload(1, bytes(3_000), upload=upload))
    shelf.take("program 2", Upload(1, b"a", "small"))
    assert shelf.size == 12_000 + 4096  # what a disk gives for the smallest file
    with pytest.raises(FileError, match="most: the studio keeps"):
        shelf.take("program 3", Upload(1, bytes(5_000), "most"))
    with pytest.raises(FileError, match="freed when it leaves"):
        shelf.take("program 3", Upload(1, b"a", "small, and too many"))
    path, _ = shelf.find("program 1", Uploaded(upload), holding(tmp_path))
    assert not shelf.free("program 1", {path})  # the session has to read it
    assert path.exists()
    assert shelf.free("program 1", set())
    assert not path.exists()
    with pytest.raises(StudioError, match="has uploaded no"):
        shelf.find("program 1", Uploaded(upload), holding(tmp_path))
    shelf.take("program 3", Upload(1, bytes(5_000), "most"))


@pytest.mark.parametrize("name", ["", ".", "..", "/etc/passwd", "../a.mcap", "a.mcap/", "A.MCAP"])
def test_only_names_that_are_there_lead_anywhere(shelf: Shelf, tmp_path: Path, name: str) -> None:
    now = holding(tmp_path, "a.mcap", "b.zip")
    for place in (Recorded(name), Sample(name)):
        with pytest.raises(StudioError, match="is not in"):
            shelf.find("program 1", place, now)
    with pytest.raises(StudioError, match="is not in the newest export"):
        shelf.part(FetchFile(1, name), now)


def test_what_is_there_is_found(shelf: Shelf, tmp_path: Path) -> None:
    now = holding(tmp_path, "a.mcap")
    assert shelf.find("program 1", Recorded("a.mcap"), now) == (tmp_path / "a.mcap", "a.mcap")
    path, name = shelf.find("program 1", Sample("demonstration-1.mcap"), now)
    assert (path.is_file(), name) == (True, "demonstration-1.mcap")
    assert shelf.find("program 1", OnStudio("/data"), now) == (Path("/data"), "")


def test_a_file_is_fetched_part_by_part(shelf: Shelf, tmp_path: Path) -> None:
    now = holding(tmp_path, "film.webm")
    content = bytes(range(256)) * (PART // 256 + 3)
    (tmp_path / "film.webm").write_bytes(content)
    fetched = b""
    while len(fetched) < len(content):
        part = shelf.part(FetchFile(1, "film.webm", len(fetched)), now)
        assert (part.size, part.offset) == (len(content), len(fetched))
        assert 0 < len(part.content) <= PART
        fetched += part.content
    assert fetched == content
    with pytest.raises(StudioError, match="and none at"):
        shelf.part(FetchFile(1, "film.webm", len(content) + 1), now)
