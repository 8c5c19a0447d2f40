"""A session without clock or browser: commands in, snapshots out, nothing lost, nothing crashes."""

from pathlib import Path

import numpy as np
import pytest
from mcap.writer import Writer

from studio.engine import commands
from studio.engine.commands import Command
from studio.engine.errors import StudioError
from studio.engine.follow import follow
from studio.engine.mcap_file import read_recording
from studio.engine.pipeline import Pipeline
from studio.engine.robot import load_robot
from studio.engine.session import Session
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.sources import write_skeletons
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.teaching import LearnerSettings


@pytest.fixture
def session(tmp_path: Path):
    made = Session(tmp_path / "recordings")
    yield made
    made.close()


def do(session: Session, *orders: Command) -> Snapshot:
    for order in orders:
        session.post(order)
    return session.tick()


def until(session: Session, mode: Mode, most: int = 900) -> Snapshot:
    for _ in range(most):
        if session.tick().mode is mode:
            return session.snapshot
    raise AssertionError(f"never {mode}: {session.snapshot.message.text}")


def test_teach_learn_and_reproduce(session: Session, tmp_path: Path) -> None:
    start = session.snapshot
    assert (start.mode, start.entries, start.lesson) == (Mode.IDLE, (), None)
    for take in (1, 2):
        assert do(session, commands.UseDemonstrator(), commands.Record()).mode is Mode.RECORDING
        taught = until(session, Mode.IDLE)
        assert len(taught.entries) == take
        assert taught.entries[-1].block_down
    trained = do(session, commands.Train(LearnerSettings("rbf", 30)))
    assert trained.lesson is not None
    assert (trained.lesson.mse >= trained.lesson.floor).all()
    playing = do(session, commands.PlayReproduction())
    assert (playing.mode, playing.reproduction) == (Mode.PLAYING, None)
    assert playing.ghost is not None
    played = until(session, Mode.IDLE)
    assert played.world.block_down
    assert played.reproduction.performance.block_down
    assert {p.name for p in (tmp_path / "recordings").iterdir()} == {
        "demonstration-001.mcap",
        "demonstration-002.mcap",
    }


def test_live_and_offline_are_one(session: Session) -> None:
    """The session records, tick by tick, what following the same stream offline gives."""
    do(session, commands.UseDemonstrator(), commands.Record())
    until(session, Mode.IDLE)
    live = read_recording(Path(session.snapshot.saved_as))
    offline = follow(demonstrate(0, 1), Pipeline.for_robot(load_robot(), "left"))
    assert len(live.samples) == len(offline.samples)
    for a, b in zip(live.samples, offline.samples, strict=True):
        assert np.array_equal(a.sent, b.sent)
        assert np.array_equal(a.world.joint_positions, b.world.joint_positions)


def test_stop_while_recording_keeps_what_was_recorded(session: Session, tmp_path: Path) -> None:
    do(session, commands.UseDemonstrator(), commands.Record())
    until_armed = 0
    while not session.snapshot.gate or not session.snapshot.gate.armed:
        session.tick()
        until_armed += 1
    for _ in range(60):
        session.tick()
    before = session.snapshot.world.joint_positions
    stopped = do(session, commands.Stop())
    assert stopped.mode is Mode.IDLE
    assert len(stopped.entries) == 1
    assert read_recording(tmp_path / "recordings" / "demonstration-001.mcap").warning == ""
    for _ in range(30):
        held = session.tick()
    moved = np.abs(held.world.joint_positions - before).max()
    assert moved < 0.15  # it comes to rest where it was told to be last


def test_closing_while_recording_finishes_the_file(tmp_path: Path) -> None:
    session = Session(tmp_path)
    do(session, commands.UseDemonstrator(), commands.Record())
    for _ in range(50):
        session.tick()
    session.close()
    assert len(read_recording(tmp_path / "demonstration-001.mcap").samples) == 51


def test_a_full_disk_is_said_and_the_session_lives(session: Session, monkeypatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(28, "No space left on device")

    do(session, commands.UseDemonstrator(), commands.Record())
    monkeypatch.setattr(Writer, "add_message", refuse)
    monkeypatch.setattr(Writer, "finish", refuse)
    stopped = session.tick()
    assert stopped.mode is Mode.IDLE
    assert stopped.message.is_error
    assert "No space left" in stopped.message.text
    monkeypatch.undo()
    assert do(session, commands.Watch()).mode is Mode.WATCHING


@pytest.mark.parametrize(
    ("order", "words"),
    [
        (commands.Watch(), "source"),
        (commands.Record(), "source"),
        (commands.Train(LearnerSettings()), "record one first"),
        (commands.PlayReproduction(), "Train first"),
        (commands.PlayDemonstration(), "no such demonstration"),
        (commands.Choose(3), "no such demonstration"),
        (commands.Remove(0), "no such demonstration"),
        (commands.UseFile(Path("/nowhere/at-all.json")), "at-all.json"),
    ],
)
def test_what_cannot_be_done_is_said_and_the_session_lives(session, order, words: str) -> None:
    refused = do(session, order)
    assert refused.message.is_error
    assert words in refused.message.text
    assert do(session, commands.UseDemonstrator()).source is not None


def test_a_broken_upload_says_so_under_its_own_name(session: Session, tmp_path: Path) -> None:
    path = tmp_path / "x81231"
    path.write_bytes(b"\x00\x01not a skeleton")
    refused = do(session, commands.UseFile(path, "my take.json"))
    assert refused.message.is_error
    assert "my take.json" in refused.message.text
    assert str(tmp_path) not in refused.message.text


def test_a_stream_that_never_arms_teaches_nothing_and_says_why(session, tmp_path: Path) -> None:
    path = tmp_path / "never.jsonl"
    write_skeletons(path, demonstrate(0, 1, (HandState.OPEN, HandState.CLOSED)))
    do(session, commands.UseFile(path), commands.Record())
    ended = until(session, Mode.IDLE)
    assert ended.entries == ()
    assert ended.message.is_error
    assert "waiting for Lasso" in ended.message.text


def test_recordings_come_back_and_go(session: Session, tmp_path: Path) -> None:
    do(session, commands.UseDemonstrator(), commands.Record())
    saved = Path(until(session, Mode.IDLE).saved_as)
    assert len(do(session, commands.UseFile(saved)).entries) == 2
    assert do(session, commands.Choose(1)).chosen == 1
    left = do(session, commands.Remove(1))
    assert (len(left.entries), left.chosen) == (1, 0)
    assert saved.exists()


def test_another_mapping_wants_its_own_demonstrations(session: Session) -> None:
    do(session, commands.UseDemonstrator(), commands.Record())
    until(session, Mode.IDLE)
    do(session, commands.Configure("left", "paper", "sequence"))
    refused = do(session, commands.Train(LearnerSettings()))
    assert "paper mapping" in refused.message.text
    assert refused.lesson is None


def test_an_open_gate_follows_at_once(session: Session) -> None:
    do(session, commands.Configure("right", "paper", "open"), commands.UseDemonstrator())
    assert do(session, commands.Watch()).gate.armed
    refused = do(session, commands.Configure("left", "exact", "sequence"))
    assert "Stop first" in refused.message.text


def test_replaying_a_demonstration_pushes_the_block(session: Session) -> None:
    do(session, commands.UseDemonstrator(), commands.Record())
    until(session, Mode.IDLE)
    do(session, commands.PlayDemonstration())
    replayed = until(session, Mode.IDLE)
    assert replayed.world.block_down
    assert replayed.reproduction is None


def test_a_world_is_its_threads_own(session: Session) -> None:
    import threading  # noqa: PLC0415

    caught: list[BaseException] = []

    def intrude() -> None:
        try:
            session._activity.world.step()
        except StudioError as error:
            caught.append(error)

    thread = threading.Thread(target=intrude)
    thread.start()
    thread.join()
    assert len(caught) == 1
