"""The recordings folder at a glance: what is broken is listed with the reason."""

import os
import shutil
from pathlib import Path

import pytest

from studio.engine.errors import FileError
from studio.engine.mcap_file import read_recording
from studio.engine.recordings_folder import MOST_FILES, FolderFile, look_into
from studio.engine.resources import samples_folder
from studio.engine.sources import mcap_skeletons
from studio.engine.sources.family import Frame, ParsedFile

SAMPLES = sorted(samples_folder().glob("*.mcap"))


def look(folder: Path) -> dict[str, FolderFile]:
    return {file.path.name: file for file in look_into(folder, {}, MOST_FILES)}


def test_a_recording_tells_its_length_and_date_without_being_read(tmp_path: Path) -> None:
    for number, path in enumerate(SAMPLES):
        shutil.copy(path, tmp_path)
        os.utime(tmp_path / path.name, (0, 1_000 + number))
    files = look_into(tmp_path, {}, MOST_FILES)
    assert [file.path.name for file in files] == [path.name for path in reversed(SAMPLES)]
    for file in files:
        samples = read_recording(file.path).samples
        assert file.seconds == pytest.approx(samples[-1].time - samples[0].time, abs=1e-6)
        assert (file.problem, file.can_open, file.is_session) == ("", True, False)
    assert [file.modified for file in files] == [1_003, 1_002, 1_001, 1_000]


def test_what_is_broken_says_why(tmp_path: Path) -> None:
    whole = SAMPLES[0].read_bytes()
    (tmp_path / "cut.mcap").write_bytes(whole[:-5_000])
    (tmp_path / "empty.mcap").write_bytes(b"")
    (tmp_path / "text.mcap").write_text("not at all " * 9)
    (tmp_path / "head.mcap").write_bytes(whole[:8])
    (tmp_path / "tail.mcap").write_bytes(whole[:4_000] + b"\xa5" * 4_000 + whole[-40:])
    (tmp_path / "no.zip").write_text("no archive")
    mcap_skeletons.write(
        tmp_path / "people.mcap", ParsedFile("test", [Frame(0.0)], True, True, True)
    )
    (tmp_path / "folder.mcap").mkdir()
    (tmp_path / "notes.txt").write_text("of no concern")
    files = look(tmp_path)
    assert {name: file.can_open for name, file in files.items()} == {
        "cut.mcap": True,
        "empty.mcap": False,
        "text.mcap": False,
        "head.mcap": False,
        "tail.mcap": True,
        "no.zip": False,
        "people.mcap": False,
    }
    reasons = {name: file.problem for name, file in files.items()}
    assert "cut off" in reasons["cut.mcap"]
    assert "cut off" in reasons["tail.mcap"]
    assert "nothing is in it" in reasons["empty.mcap"]
    assert "not an MCAP" in reasons["text.mcap"]
    assert "1 Source" in reasons["people.mcap"]
    assert "not an archive" in reasons["no.zip"]


def test_what_is_known_is_not_read_again_and_little_is_read_at_once(tmp_path: Path) -> None:
    for path in SAMPLES:
        shutil.copy(path, tmp_path)
    known: dict[Path, FolderFile] = {}
    for looks in range(1, 5):
        files = look_into(tmp_path, known, 1)
        assert sum(file.was_read for file in files) == looks
        known = {file.path: file for file in files}
    again = look_into(tmp_path, known, 1)
    assert all(a is b for a, b in zip(again, files, strict=True))
    changed = tmp_path / SAMPLES[2].name
    changed.write_bytes(b"")
    (found,) = [f for f in look_into(tmp_path, known, 1) if f not in files]
    assert (found.path, found.problem) == (changed, "nothing is in it")


def test_a_folder_that_is_not_there_is_empty_and_a_file_is_none(tmp_path: Path) -> None:
    assert look_into(tmp_path / "none", {}, 5) == ()
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot be listed"):
        look_into(tmp_path / "file", {}, 5)
