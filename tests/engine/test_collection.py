"""Demonstrations and their files: what comes in, what stays with it, and what goes for good."""

import os
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from studio.engine import commands
from studio.engine.collection import LOOK_EVERY, SAVE_EVERY, Collection
from studio.engine.errors import FileError, StudioError
from studio.engine.experiment import Setup
from studio.engine.export import Job, Material
from studio.engine.export.session_file import write as write_session
from studio.engine.export.session_reader import is_session
from studio.engine.mcap_file import read_recording, write_recording
from studio.engine.mcap_log import is_mcap
from studio.engine.recording import Recording
from studio.engine.resources import samples_folder
from studio.engine.skeleton import Hand
from tests.engine.cards_at_hand import sample, takes


class Desk:
    """A collection without a session: what it asks the session for is only written down."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.asked = folder, []
        self.collection = Collection(folder, self.asked.append)

    def record(self, number: int = 1, replaces: int | None = None) -> str:
        """Let a recording be made."""
        path = self.folder / f"demonstration-{len(list(self.folder.glob('*.mcap'))) + 1:03d}.mcap"
        write_recording(path, sample(number))
        return self.collection.add(sample(number), path.stem, path, replaces)

    def read_what_was_asked(self) -> None:
        """Do what the session does with a recording."""
        for file in self.asked:
            self.collection.add(read_recording(file.path), file.shown, file.path)
        self.asked.clear()

    def wait(self, ticks: int = LOOK_EVERY + 1) -> None:
        for _ in range(ticks):
            self.collection.step()

    @property
    def files(self) -> set[str]:
        return {path.name for path in self.folder.iterdir()}

    @property
    def names(self) -> list[str]:
        return [entry.name for entry in self.collection.listed.entries]


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    (tmp_path / "recordings").mkdir()
    return Desk(tmp_path / "recordings")


def test_what_was_made_of_it_comes_back_with_the_recording(desk: Desk) -> None:
    assert desk.record() == "Added demonstration-001."
    take = desk.collection.take
    take(commands.Rename(1, "../Push"))
    take(commands.Trim(1, 1.0, 4.0))
    take(commands.Include(1, included=False))
    desk.wait(SAVE_EVERY)
    assert desk.files == {"demonstration-001.mcap", "demonstration-001.card.json"}
    kept = desk.collection.listed.entry(1)

    later = Desk(desk.folder)
    later.wait(1)
    (file,) = later.collection.status().files
    later.collection.take(commands.OpenRecording(file.path.name))
    later.read_what_was_asked()
    back = later.collection.listed.entry(1)
    assert (back.name, back.included, back.span) == ("../Push", False, kept.span)
    later.collection.take(commands.Trim(1, 0.0, 60.0))
    assert not later.collection.listed.entry(1).is_trimmed


def test_what_was_changed_before_deleting_is_saved_once_it_is_back(desk: Desk) -> None:
    desk.record()
    desk.collection.take(commands.Rename(1, "kept"))
    desk.collection.take(commands.Remove(1))
    desk.wait(SAVE_EVERY)
    assert desk.files == {"demonstration-001.mcap"}
    desk.collection.take(commands.Restore())
    desk.wait(SAVE_EVERY)
    assert "kept" in (desk.folder / "demonstration-001.card.json").read_text()


def test_a_file_is_listed_once_and_spared_when_it_is_opened_again(desk: Desk) -> None:
    desk.record()
    file = desk.folder / "demonstration-001.mcap"
    with pytest.raises(StudioError, match="on the list already"):
        desk.collection.add(sample(), file.name, desk.folder / ".." / "recordings" / file.name)
    desk.collection.take(commands.Remove(1))
    desk.collection.add(sample(), file.name, file)
    assert desk.collection.status().removed == ""
    desk.collection.close()
    assert file.exists()
    assert desk.names == ["demonstration-001"]


def test_closing_keeps_the_last_change_and_ends_undo(desk: Desk) -> None:
    desk.record()
    desk.record(2)
    desk.collection.take(commands.Rename(1, "kept"))
    desk.collection.take(commands.Remove(2))
    desk.collection.close()
    assert desk.files == {"demonstration-001.mcap", "demonstration-001.card.json"}
    assert "kept" in (desk.folder / "demonstration-001.card.json").read_text()


def test_deleting_and_undoing_are_told(desk: Desk) -> None:
    desk.record()
    take = desk.collection.take
    assert "Undo brings it back" in take(commands.Remove(1))
    assert desk.collection.status().goes_too == "demonstration-001.mcap"
    assert take(commands.Restore()) == "demonstration-001 is back."
    take(commands.Remove(1))
    assert "gone for good" in take(commands.DeleteForGood())
    assert desk.files == set()
    desk.wait(1)
    assert desk.collection.status().files == ()
    assert take(commands.DeleteForGood()) == "There is nothing left to delete."


def test_samples_are_never_deleted(tmp_path: Path) -> None:
    """As in a clone, whose samples lie within the recordings folder."""
    folder = tmp_path / "recordings"
    (folder / "samples").mkdir(parents=True)
    file = folder / "samples" / "demonstration-1.mcap"
    shutil.copy(samples_folder() / file.name, file)
    desk = Desk(folder)
    desk.collection.take(commands.AddFrom(file))
    desk.read_what_was_asked()
    desk.collection.take(commands.Rename(1, "mine now"))
    desk.collection.take(commands.Remove(1))
    assert desk.collection.status().goes_too == ""
    desk.collection.close()
    assert [path.name for path in file.parent.iterdir()] == ["demonstration-1.mcap"]
    assert file.read_bytes() == (samples_folder() / file.name).read_bytes()


def test_what_was_recorded_again_takes_the_place_of_the_old_one(desk: Desk) -> None:
    for number in (1, 2, 3):
        desk.record(number)
    desk.record(4, replaces=2)
    assert desk.names == ["demonstration-001", "demonstration-004", "demonstration-003"]
    assert desk.collection.listed.chosen == 4
    desk.collection.take(commands.Restore())
    assert desk.names[1:3] == ["demonstration-002", "demonstration-004"]


def test_a_recording_without_hand_states_is_told_of_the_open_gate(desk: Desk) -> None:
    recorded = sample()
    still = [
        replace(each, skeleton=replace(each.skeleton, left_hand=Hand(), right_hand=Hand()))
        for each in recorded.samples[:20]
        if each.skeleton is not None
    ]
    with pytest.raises(StudioError, match="Choose the open gate"):
        desk.collection.add(Recording(recorded.info, tuple(still)), "mute", desk.folder / "m.mcap")


def test_recording_again_what_arms_nothing_keeps_the_old_one(desk: Desk) -> None:
    desk.record()
    nothing = Recording(sample().info, sample().samples[:20])
    with pytest.raises(StudioError, match="again: nothing armed"):
        desk.collection.add(nothing, "again", desk.folder / "again.mcap", replaces=1)
    assert desk.names == ["demonstration-001"]
    desk.record(2, replaces=77)  # deleted meanwhile
    assert len(desk.names) == 2


def test_the_folder_is_looked_into_now_and_then_and_after_changes(desk: Desk) -> None:
    desk.wait(1)
    assert desk.collection.status().files == ()
    shutil.copy(samples_folder() / "demonstration-2.mcap", desk.folder / "copied.mcap")
    desk.wait()
    (file,) = desk.collection.status().files
    assert (file.path.name, file.problem) == ("copied.mcap", "")
    desk.record()
    desk.wait(2)
    status = desk.collection.status()
    assert len(status.files) == 2
    assert [path.name for path in status.listed] == ["demonstration-002.mcap"]
    shutil.rmtree(desk.folder)
    desk.folder.write_text("a file in its place")
    desk.wait()
    assert "cannot be listed" in desk.collection.status().problem


def test_only_what_lies_in_the_folder_is_opened_by_name(desk: Desk) -> None:
    outside = desk.folder.parent / "outside.mcap"
    shutil.copy(samples_folder() / "demonstration-1.mcap", outside)
    (desk.folder / "broken.mcap").write_text("no" * 50)
    desk.record()
    desk.wait(2)
    for name, words in (
        ("../outside.mcap", "not in the recordings folder"),
        (str(outside), "not in the recordings folder"),
        ("broken.mcap", "not an MCAP"),
        ("demonstration-002.mcap", "on the list already"),
    ):
        with pytest.raises(StudioError, match=words):
            desk.collection.take(commands.OpenRecording(name))
    assert desk.asked == []


def test_a_second_folder_adds_its_recordings_with_their_names(desk: Desk, tmp_path: Path) -> None:
    other = tmp_path / "other"
    other.mkdir()
    elsewhere = Desk(other)
    elsewhere.record(1)
    elsewhere.record(2)
    elsewhere.collection.take(commands.Rename(2, "from elsewhere"))
    elsewhere.collection.close()
    (other / "broken.mcap").write_text("no")
    desk.record(3)
    words = desk.collection.take(commands.AddFrom(other))
    assert words == "Adding 2 recordings of other."
    desk.read_what_was_asked()
    assert desk.names == ["demonstration-001", "demonstration-001", "from elsewhere"]
    desk.collection.take(commands.Remove(3))
    desk.collection.close()
    assert (other / "demonstration-002.mcap").exists()  # theirs is not ours to delete
    with pytest.raises(FileError, match="no recording in that folder"):
        desk.collection.take(commands.AddFrom(tmp_path))


def test_a_sessions_archive_is_for_the_session_to_open(desk: Desk, tmp_path: Path) -> None:
    (archive,) = write_session(Material(Setup(), tuple(takes(1))), Job(tmp_path))
    desk.collection.take(commands.AddFrom(archive, "theirs.zip"))
    assert desk.asked == [commands.OpenSession(archive, "theirs.zip")]


def test_a_card_that_cannot_be_read_is_told_and_costs_nothing(desk: Desk) -> None:
    desk.record()
    (desk.folder / "demonstration-001.card.json").write_text("{")
    later = Desk(desk.folder)
    with pytest.raises(FileError, match=r"card\.json.*as recorded"):
        later.collection.add(sample(), "x", desk.folder / "demonstration-001.mcap")
    assert later.names == ["x"]


def test_what_cannot_be_saved_is_told_once(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    desk.record()
    desk.collection.take(commands.Rename(1, "other"))

    def refuse(*_: object) -> None:
        raise FileError("disk full")

    monkeypatch.setattr("studio.engine.collection.write_cards", refuse)
    with pytest.raises(FileError, match="disk full"):
        desk.wait()
    desk.wait()
    assert desk.names == ["other"]


def test_a_pipe_is_refused_and_not_waited_for(desk: Desk) -> None:
    pipe = desk.folder / "pipe.mcap"
    os.mkfifo(pipe)
    assert not is_session(pipe)
    assert not is_mcap(pipe)
    with pytest.raises(FileError, match="pipe or a device"):
        desk.collection.take(commands.AddFrom(pipe))
    with pytest.raises(FileError, match="no recording in that folder"):
        desk.collection.take(commands.AddFrom(desk.folder))
    assert desk.asked == []
