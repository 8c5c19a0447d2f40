"""Exports and archives beside a session: in words, off the tick, and the same when opened again."""

import time
from pathlib import Path

import numpy as np
import pytest

from studio.engine import commands, exporting
from studio.engine.choices import Choices
from studio.engine.errors import FileError
from studio.engine.export import KINDS
from studio.engine.export.apart import APART
from studio.engine.export.session_reader import open_session
from studio.engine.opening import ReadSession
from studio.engine.session import Session
from studio.engine.snapshot import Snapshot
from studio.engine.teaching import LearnerSettings
from tests.engine.export.materials import listed
from tests.engine.long_work import PATIENCE

LONG = 4.0 * PATIENCE  # [s] for what another process reads or writes
PAUSE = 0.01  # [s] between ticks, so that the other process gets its turn


@pytest.fixture
def session(tmp_path: Path):
    made = Session(tmp_path / "recordings")
    yield made
    made.close()


def do(session: Session, *orders: commands.Command) -> Snapshot:
    for order in orders:
        session.post(order)
    return session.tick()


def until(session: Session, reached, most: float = LONG) -> Snapshot:
    deadline = time.monotonic() + most
    while not reached(now := session.tick()):
        assert time.monotonic() < deadline, now.message.text
        time.sleep(PAUSE)
    return now


def taught(session: Session, takes: int = 1) -> Snapshot:
    session._listed.add(listed(takes).takes)
    return session.tick()


def learned(session: Session) -> Snapshot:
    do(session, commands.Train(LearnerSettings("rbf", 12)))
    return until(session, lambda now: now.lesson is not None)


def exported(session: Session, *kinds: str, anonymous: bool = False) -> dict[str, Path]:
    before = session.snapshot.export.number
    do(session, commands.Export(kinds, anonymous))
    now = until(session, lambda now: now.export.number > before or now.message.is_error)
    assert not now.message.is_error, now.message.text
    return {path.name: path for path in now.export.files}


def test_a_session_comes_back_the_same(session: Session, tmp_path: Path) -> None:
    do(session, commands.Configure(Choices(gate="open")))
    taught(session, 2)
    do(session, commands.Include(session.snapshot.entries[1].number, False))
    before = learned(session)
    archive = exported(session, "zip")["session.zip"]
    other = Session(tmp_path / "others")
    try:
        taught(other)
        do(other, commands.OpenSession(archive, "lab.zip"))
        assert other.snapshot.export.opening == "lab.zip"
        now = until(other, lambda now: now.lesson is not None)
        assert "Opened lab.zip: 2 demonstrations, and what was learned" in now.message.text
        assert now.choices == before.choices
        assert len({each.number for each in now.entries}) == 3  # beside what was there
        opened = now.entries[1:]
        assert [each.included for each in opened] == [True, False]
        for ours, theirs in zip(before.entries, opened, strict=True):
            assert ours.name == theirs.name
            assert np.array_equal(ours.demonstration.sent, theirs.demonstration.sent)
            assert len(ours.recording.samples) == len(theirs.recording.samples)
        assert now.lesson.settings == before.lesson.settings
        moments = np.linspace(1.0, 142.0, 50)
        assert np.array_equal(
            now.lesson.model.predict(moments), before.lesson.model.predict(moments)
        )
    finally:
        other.close()


def test_names_are_stripped_on_request(session: Session) -> None:
    entry = taught(session).entries[0]
    do(session, commands.Rename(entry.number, "Ada Lovelace"))
    names = []
    for anonymous in (False, True):
        archive = exported(session, "zip", anonymous=anonymous)["session.zip"]
        names.append(open_session(archive).takes[0].demonstration.name)
    assert names == ["Ada Lovelace", "demonstration 1"]


def test_the_session_ticks_on_while_files_are_written(session: Session) -> None:
    taught(session)
    learned(session)
    do(session, commands.Export(("npz", "model")))
    assert session.snapshot.export.running == ("npz", "model")
    ticks = 0
    while session.snapshot.export.running:
        session.tick()
        ticks += 1
        time.sleep(PAUSE)
        assert ticks < 6000
    assert ticks > 20
    assert {path.name for path in session.snapshot.export.files} == {"data.npz", "model.json"}
    assert "2 files" in session.snapshot.message.text
    share = session.snapshot.export.share
    assert share == pytest.approx(1.0)


def test_what_is_missing_is_said(session: Session) -> None:
    refused = do(session, commands.Export(("zip",)))
    assert "record a demonstration first" in refused.message.text
    taught(session)
    assert "Train first" in do(session, commands.Export(("csv",))).message.text
    assert "at least one" in do(session, commands.Export(())).message.text
    assert "no such export" in do(session, commands.Export(("pdf",))).message.text
    assert session.snapshot.export.running == ()


def test_one_at_a_time_and_cancel_leaves_nothing(session: Session) -> None:
    taught(session)
    learned(session)
    do(session, commands.Export(("video",)))
    assert "wait for it" in do(session, commands.Export(("zip",))).message.text
    do(session, commands.CancelExport())
    now = until(session, lambda now: not now.export.running)
    assert "given up" in now.message.text
    assert not now.message.is_error
    assert now.export.files == ()
    assert exported(session, "mcap").keys() == {"recording-001.mcap"}


def test_a_fault_in_writing_is_said(session: Session, monkeypatch) -> None:
    taught(session)

    def fail(*_: object) -> None:
        raise ValueError("odd")

    monkeypatch.setattr(exporting, "written", fail)
    do(session, commands.Export(("zip",)))
    now = until(session, lambda now: now.message.is_error)
    assert "a fault of the studio's own: odd" in now.message.text


def test_no_archive_is_said_under_its_own_name(tmp_path: Path) -> None:
    path = tmp_path / "x1"
    path.write_bytes(b"PK\x03\x04 and no more")
    with pytest.raises(FileError, match=r"mine\.zip") as refused:
        list(ReadSession(commands.OpenSession(path, "mine.zip")).points())
    assert str(path) not in str(refused.value)


def test_closing_in_the_middle_leaves_no_files(tmp_path: Path) -> None:
    made = Session(tmp_path)
    taught(made)
    learned(made)
    do(made, commands.Export(("html",)))
    folder = Path(made._exporting._folder.name)
    assert folder.is_dir()
    made.close()
    assert not folder.exists()


def test_every_kind_can_be_asked_for() -> None:
    assert {*KINDS, "replay"} == set(APART)
