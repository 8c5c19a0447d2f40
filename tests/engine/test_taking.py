"""Takes by hand, automatically and once more: each is whole, saved, and in its place."""

from pathlib import Path

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.export import Take
from studio.engine.mcap_file import read_recording
from studio.engine.session import Session
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings
from tests.engine.cards_at_hand import DEFECTS, sample
from tests.engine.sessions import do


@pytest.fixture
def session(tmp_path: Path):
    made = Session(tmp_path)
    yield made
    made.close()


def until(session: Session, reached, most: int = 900) -> Snapshot:
    for _ in range(most):
        if reached(now := session.tick()):
            return now
    raise AssertionError(session.snapshot.message.text)


def recorded(session: Session) -> Snapshot:
    do(session, commands.UseDemonstrator(), commands.Record())
    return until(session, lambda now: now.mode is Mode.IDLE)


def test_a_take_by_hand_is_what_was_sent_between_two_presses(session: Session) -> None:
    do(session, commands.UseDemonstrator(), commands.Watch())
    until(session, lambda now: now.mode is Mode.ARMED and not now.held)
    assert do(session, commands.BeginTake()).mode is Mode.RECORDING
    sent = [session._activity.newest.sent]
    for _ in range(80):
        session.tick()
        sent.append(session._activity.newest.sent)
    assert session.snapshot.recorded == len(sent)
    ended = do(session, commands.EndTake())
    assert (ended.mode, ended.recorded) == (Mode.ARMED, 0)  # it follows on
    (entry,) = ended.entries
    assert np.array_equal(entry.demonstration.sent, sent)
    assert entry.demonstration.times[0] == 0.0
    kept = read_recording(Path(ended.saved_as))
    assert kept.samples[0].time == 0.0
    assert [s.sent.tobytes() for s in kept.samples] == [each.tobytes() for each in sent]


def test_several_takes_by_hand_are_several_files(session: Session, tmp_path: Path) -> None:
    do(session, commands.Configure(Choices("left", "exact", "open")))
    do(session, commands.UseDemonstrator(), commands.Watch())
    until(session, lambda now: not now.held)
    for count in (1, 2):
        do(session, commands.BeginTake())
        for _ in range(60):
            session.tick()
        assert len(do(session, commands.EndTake()).entries) == count
    stopped = do(session, commands.BeginTake(), commands.Stop())  # nothing recorded, no file left
    assert stopped.mode is Mode.IDLE
    assert sorted(path.name for path in tmp_path.glob("*.mcap")) == [
        "demonstration-001.mcap",
        "demonstration-002.mcap",
    ]


def test_stop_ends_a_take_by_hand_too(session: Session) -> None:
    do(session, commands.UseDemonstrator(), commands.Watch())
    until(session, lambda now: now.mode is Mode.ARMED and not now.held)
    do(session, commands.BeginTake())
    for _ in range(50):
        session.tick()
    assert len(do(session, commands.Stop()).entries) == 1


@pytest.mark.parametrize(
    ("orders", "words"),
    [
        ((commands.BeginTake(),), "Press Watch first"),
        ((commands.EndTake(),), "Press Watch first"),
        ((commands.UseDemonstrator(), commands.Watch(), commands.EndTake()), "Begin a take first"),
        (
            (commands.UseDemonstrator(), commands.Record(), commands.BeginTake()),
            "being recorded already",
        ),
        ((commands.RecordAgain(),), "Choose a source first"),
        ((commands.UseDemonstrator(), commands.RecordAgain(9)), None),
    ],
)
def test_what_cannot_be_done_is_said(session: Session, orders, words: str | None) -> None:
    refused = do(session, *orders)
    if words is None:  # with an empty list there is nothing to replace: it just records
        assert refused.mode is Mode.RECORDING
        return
    assert refused.message.is_error
    assert words in refused.message.text


def test_a_take_before_the_gate_opened_teaches_nothing_and_says_why(session: Session) -> None:
    do(session, commands.UseDemonstrator(), commands.Watch(), commands.BeginTake())
    session.tick()
    refused = do(session, commands.EndTake())
    assert refused.message.is_error
    assert "nothing armed" in refused.message.text
    assert (refused.mode, refused.entries) == (Mode.WATCHING, ())


def test_again_replaces_the_chosen_one_by_another_take(session: Session, tmp_path: Path) -> None:
    recorded(session)
    before = recorded(session).entries
    do(session, commands.Choose(1), commands.RecordAgain())
    after = until(session, lambda now: now.mode is Mode.IDLE)
    assert [entry.number for entry in after.entries] == [3, 2]
    shown = after.entries[0].demonstration
    assert shown.sent.tobytes() not in [entry.demonstration.sent.tobytes() for entry in before]
    assert after.collection.removed == "demonstration-001"
    assert len(list(tmp_path.glob("*.mcap"))) == 3
    back = do(session, commands.Restore())
    assert [entry.number for entry in back.entries] == [1, 3, 2]


def test_again_while_recording_replaces_what_is_being_recorded(session: Session) -> None:
    recorded(session)
    do(session, commands.UseDemonstrator(), commands.Record())
    until(session, lambda now: now.gate is not None and now.gate.armed and not now.held)
    for _ in range(60):
        session.tick()
    again = do(session, commands.RecordAgain())
    assert (again.mode, [entry.number for entry in again.entries]) == (Mode.RECORDING, [1, 2])
    after = until(session, lambda now: now.mode is Mode.IDLE)
    assert [entry.number for entry in after.entries] == [1, 3]
    assert after.collection.removed == "demonstration-002"


def test_again_that_arms_nothing_keeps_what_was_there(session: Session) -> None:
    recorded(session)
    do(session, commands.RecordAgain(1))
    for _ in range(20):
        session.tick()
    stopped = do(session, commands.Stop())
    assert stopped.message.is_error
    assert [entry.number for entry in stopped.entries] == [1]
    assert stopped.collection.removed == ""


def signed(session: Session, *states: HandState) -> None:
    """Let the puppet sign, each sign for long enough."""
    for state in states:
        do(session, commands.Sign("left", state))
        for _ in range(20):
            session.tick()


def test_one_take_after_another_without_a_hand_on_the_mouse(
    session: Session, tmp_path: Path
) -> None:
    """Each has its own recording, and a fresh world with the block upright."""
    do(session, commands.UsePuppet(), commands.Record(repeats=True))
    for count in (1, 2):
        signed(session, HandState.LASSO, HandState.OPEN, HandState.CLOSED)
        assert until(session, lambda now: now.gate.armed, 30).mode is Mode.RECORDING
        for _ in range(120):
            session.tick()
        do(session, commands.Sign("left", HandState.LASSO))  # disarms
        after = until(session, lambda now, n=count: len(now.entries) == n, 90)
        assert after.mode is Mode.RECORDING
        assert after.time < 0.2  # in a world of its own
    for _ in range(10):
        session.tick()
    stopped = do(session, commands.Stop())
    assert stopped.message.text.endswith("after the last take is kept as demonstration-003.mcap.")
    assert stopped.mode is Mode.IDLE
    assert not stopped.message.is_error
    assert len(stopped.entries) == 2
    assert {entry.file.name for entry in stopped.entries} == {
        "demonstration-001.mcap",
        "demonstration-002.mcap",
    }


def test_the_sessions_own_list_finds_what_was_planted(session: Session) -> None:
    """All five defects at once among clean takes, looked at while the session ticks."""
    clean = [Take(entry.demonstration, entry.recording) for entry in recorded(session).entries]
    assert len(clean) == 1
    add = session._collection.add
    for number in (1, 2, 3, 4):
        add(sample(number), f"clean {number}", Path("elsewhere.mcap"))
    for name, plant in DEFECTS.items():
        add(plant(1), name, Path("elsewhere.mcap"))
    number_of = {entry.name: entry.number for entry in session.tick().entries}
    for name in DEFECTS:  # one bad take at a time among the good ones, as in a class
        do(session, commands.Include(number_of[name], included=False))
    for _ in range(40):
        now = session.tick()
    flags = {entry.name: [flag.name for flag in entry.flags] for entry in now.entries}
    for name in DEFECTS:
        assert name in flags.pop(name)
    assert list(flags.values()) == [[]] * 5


def test_training_takes_included_ones_only(session: Session) -> None:
    for number in (1, 2, 3):
        session._collection.add(sample(number), f"push {number}", Path("elsewhere.mcap"))
    do(session, commands.Include(2, included=False))
    do(session, commands.Train(LearnerSettings("rbf", 20)))
    lesson = until(session, lambda now: now.lesson is not None, 30).lesson
    assert [each.name for each in lesson.taught.demonstrations] == ["push 1", "push 3"]
