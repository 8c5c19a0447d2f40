"""A session without clock or browser: commands in, snapshots out, nothing lost, nothing crashes."""

from pathlib import Path

import numpy as np
import pytest
from mcap.writer import Writer

from studio.engine import commands
from studio.engine.activity import Follow
from studio.engine.arms import driven_joints
from studio.engine.choices import Choices
from studio.engine.errors import StudioError
from studio.engine.follow import follow
from studio.engine.hands import HandOptions
from studio.engine.mcap_file import read_recording
from studio.engine.perform import Perform
from studio.engine.performance import in_guards_words, joint_columns
from studio.engine.pipeline import Pipeline, ready_pose
from studio.engine.robot import load_robot
from studio.engine.session import Session
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.sources import write_skeletons
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.recording import from_skeletons
from studio.engine.teaching import LearnerSettings, Lesson
from tests.engine.people import stand
from tests.engine.sessions import do, read


@pytest.fixture
def session(tmp_path: Path):
    made = Session(tmp_path / "recordings")
    yield made
    made.close()


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


def test_any_fault_in_a_tick_is_said_and_the_session_holds_still(
    session, tmp_path, monkeypatch
) -> None:
    def break_down(*_: object) -> None:
        raise OverflowError("nobody foresaw it")

    do(session, commands.UseDemonstrator(), commands.Record())
    for _ in range(30):
        session.tick()
    monkeypatch.setattr(Writer, "add_message", break_down)
    broken = session.tick()
    assert (broken.mode, broken.message.is_error) == (Mode.IDLE, True)
    assert "nothing recorded is lost" in broken.message.text
    monkeypatch.undo()
    (kept,) = (tmp_path / "recordings").iterdir()
    assert len(read_recording(kept).samples) == 31
    assert do(session, commands.Watch()).mode is Mode.WATCHING


def test_a_fault_in_what_is_drawn_ends_it_and_not_the_studio(session, monkeypatch) -> None:
    def break_down(*_: object) -> None:
        raise OverflowError("nobody foresaw it")

    do(session, commands.UseDemonstrator(), commands.Watch())
    monkeypatch.setattr(Follow, "guarded", property(break_down))
    broken = session.tick()
    assert (broken.mode, broken.message.is_error) == (Mode.IDLE, True)
    assert "OverflowError" in broken.message.text


@pytest.mark.parametrize("fault", [OverflowError(), RecursionError(), KeyError("x"), MemoryError()])
def test_any_fault_in_a_command_is_said_and_the_session_holds_still(
    session, monkeypatch, fault: Exception
) -> None:
    def break_down(*_: object, **__: object) -> None:
        raise fault

    do(session, commands.UseDemonstrator(), commands.Watch())
    monkeypatch.setattr("studio.engine.who_teaches.demonstrate", break_down)
    broken = do(session, commands.UseDemonstrator())
    assert (broken.mode, broken.message.is_error) == (Mode.IDLE, True)
    assert f"Internal fault: {type(fault).__name__}" in broken.message.text
    before = broken.world.joint_positions
    held = [session.tick() for _ in range(30)][-1]
    assert held.message == broken.message
    assert np.abs(held.world.joint_positions - before).max() < 0.15
    assert do(session, commands.Watch()).mode is Mode.WATCHING


@pytest.mark.parametrize(
    ("order", "words"),
    [
        (commands.Watch(), "source"),
        (commands.Record(), "source"),
        (commands.Calibrate(), "source"),
        (commands.Train(LearnerSettings()), "record one first"),
        (commands.PlayReproduction(), "Train first"),
        (commands.PlayDemonstration(), "no such demonstration"),
        (commands.Choose(3), "no such demonstration"),
        (commands.Remove(0), "no such demonstration"),
        (commands.DragHand("left", (0.0, 0.0, 2.0)), "Take the puppet first"),
        (commands.FollowBody("1"), "Take a file or a live stream first"),
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
    refused = read(session, commands.UseFile(path, "my take.json"))
    assert refused.message.is_error
    assert "my take.json" in refused.message.text
    assert str(tmp_path) not in refused.message.text


def test_a_stream_that_never_arms_teaches_nothing_and_says_why(session, tmp_path: Path) -> None:
    path = tmp_path / "never.jsonl"
    write_skeletons(path, demonstrate(0, 1, (HandState.OPEN, HandState.CLOSED)))
    read(session, commands.UseFile(path))
    do(session, commands.Record())
    ended = until(session, Mode.IDLE)
    assert ended.entries == ()
    assert ended.message.is_error
    assert "waiting for Lasso" in ended.message.text


def test_recordings_come_back_and_go(session: Session, tmp_path: Path) -> None:
    do(session, commands.UseDemonstrator(), commands.Record())
    saved = Path(until(session, Mode.IDLE).saved_as)
    twice = read(session, commands.UseFile(saved))
    assert "on the list already" in twice.message.text
    assert len(twice.entries) == 1
    left = do(session, commands.Remove(1))
    assert (left.entries, left.chosen) == ((), -1)
    again = read(session, commands.UseFile(saved))
    assert [entry.number for entry in again.entries] == [2]
    assert again.chosen == 0
    assert saved.exists()


def test_another_mapping_wants_its_own_demonstrations(session: Session) -> None:
    do(session, commands.UseDemonstrator(), commands.Record())
    until(session, Mode.IDLE)
    do(session, commands.Configure(Choices("left", "paper", "sequence")))
    refused = do(session, commands.Train(LearnerSettings()))
    assert "paper mapping" in refused.message.text
    assert refused.lesson is None


def test_an_open_gate_follows_at_once(session: Session) -> None:
    do(session, commands.Configure(Choices("right", "paper", "open")), commands.UseDemonstrator())
    assert do(session, commands.Watch()).gate.armed
    refused = do(session, commands.Configure(Choices("left", "exact", "sequence")))
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


def standing_file(tmp_path: Path, lean: float = 0.1) -> Path:
    path = tmp_path / "stands.jsonl"
    write_skeletons(path, from_skeletons(stand(lean, frames=150), "made up", "test"))
    return path


def test_a_calibration_is_kept_for_what_is_taught_next(session: Session, tmp_path: Path) -> None:
    read(session, commands.UseFile(standing_file(tmp_path)))
    before = session.snapshot.world.joint_positions
    calibrating = do(session, commands.Calibrate())
    assert calibrating.mode is Mode.CALIBRATING
    assert calibrating.calibrating.share == 0.0
    assert session.tick().calibrating.words.startswith("Keep still")
    done = until(session, Mode.IDLE, most=75)
    assert np.abs(done.world.joint_positions - before).max() < 0.05
    assert done.choices.calibration.lean == pytest.approx(0.1, abs=1e-6)
    assert "torso leans 6°: corrected" in done.message.text
    assert (done.calibrated_with, done.calibrating) == ("stands.jsonl", None)
    do(session, commands.Configure(Choices("left", "exact", "open")), commands.Record())
    assert session.snapshot.choices.calibration == done.choices.calibration
    info = read_recording(Path(until(session, Mode.IDLE).saved_as)).info
    assert info.calibration == done.choices.calibration
    assert do(session, commands.ForgetCalibration()).choices.calibration is None


def test_a_calibration_that_fails_keeps_the_one_before(session: Session, tmp_path: Path) -> None:
    read(session, commands.UseFile(standing_file(tmp_path)))
    do(session, commands.Calibrate())
    found = until(session, Mode.IDLE).choices.calibration
    do(session, commands.UseDemonstrator(), commands.Calibrate())
    failed = until(session, Mode.IDLE)
    assert failed.message.is_error
    assert "let both arms hang" in failed.message.text
    assert "Press Calibrate to try again" in failed.message.text
    assert failed.choices.calibration == found
    do(session, commands.Calibrate())
    assert do(session, commands.Stop()).message.text == "Stopped."
    assert session.snapshot.choices.calibration == found


def test_a_lesson_outlives_what_does_not_change_its_joints(session: Session) -> None:
    do(session, commands.UseDemonstrator(), commands.Record())
    until(session, Mode.IDLE)
    lesson = do(session, commands.Train(LearnerSettings("rbf", 20))).lesson
    assert lesson is not None
    held = session._activity.world
    for kept in (
        Choices("left", "exact", "open", mirrored=True),
        Choices("left", "exact", hands=HandOptions(wrist="level")),
    ):
        assert do(session, commands.Configure(kept)).lesson is lesson
        assert session._activity.world is held
    with_fingers = do(session, commands.Configure(Choices(hands=HandOptions(gripper=True))))
    assert with_fingers.lesson is lesson
    assert len(with_fingers.world.fingers) == 4
    assert do(session, commands.Configure(Choices("both"))).lesson is None


def test_what_the_guard_keeps_apart_is_shown_in_teaching(session: Session) -> None:
    """Both arms by somebody whose right one hangs: its elbow comes to the torso's side."""
    do(session, commands.Configure(Choices("both")), commands.UseDemonstrator(), commands.Record())
    seen = set()
    while session.snapshot.mode is Mode.RECORDING:
        seen.add(session.tick().guarded)
    assert any("right elbow" in words and "slowed" in words for words in seen)
    assert "right elbow rests beside the torso" in seen
    assert not any("right elbow" in words and "stopped" in words for words in seen)


def test_what_the_guard_keeps_apart_is_told_in_playing() -> None:
    ready, low = ready_pose("left", "exact"), np.array([0.0, 1.0, 0.0, 0.0])
    playing = Perform(lambda t: ready + t / 3 * (low - ready), 3.0, "left", "exact")
    seen = {playing.guarded}
    while playing.step():
        seen.add(playing.guarded)
    playing.world.close()
    assert "" in seen
    assert any("desk: stopped" in words for words in seen)
    ticks = playing.performance.ticks
    guarded = sum(bool(tick.command.guarded) for tick in ticks)
    assert 0 < guarded == playing.performance.guarded_ticks  # there was no way to go
    assert f"changed {guarded} of {len(ticks)} ticks" in in_guards_words(playing.performance)


def test_a_motion_whose_beginning_cannot_be_reached_is_refused_in_words(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    do(session, commands.UseDemonstrator(), commands.Record())
    until(session, Mode.IDLE)
    do(session, commands.Train(LearnerSettings()))
    into_the_desk = lambda self: lambda _: np.array([-1.2, 1.04, 0.0, 0.1])  # noqa: E731
    monkeypatch.setattr(Lesson, "trajectory", into_the_desk)
    do(session, commands.PlayReproduction())
    refused = until(session, Mode.IDLE)
    assert refused.message.is_error
    assert "cannot come to where this motion begins" in refused.message.text
    assert "from the desk" in refused.message.text
    assert refused.mode is Mode.IDLE
    waits = refused.world.joint_positions[joint_columns(driven_joints("left"))]
    assert np.allclose(waits, ready_pose("left", "exact"), atol=0.03)  # it has not moved
