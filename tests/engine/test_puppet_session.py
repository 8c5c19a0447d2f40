"""Whoever has neither sensor nor camera teaches the whole push, by a session's commands alone."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.mcap_file import read_recording
from studio.engine.session import Session
from studio.engine.skeleton import HandState, Joint
from studio.engine.snapshot import Mode, Snapshot
from tests.engine.puppet.dragging import SEQUENCE, from_shoulder
from tests.engine.sessions import do

HEIGHT = -0.2  # [m] of the hand below the shoulder


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    made = Session(tmp_path / "recordings")
    yield made
    made.close()


def wait(session: Session, seconds: float) -> Snapshot:
    for _ in range(round(seconds * 30)):
        session.tick()
    return session.snapshot


def drag(session: Session, forward: float, outward: float, up: float = HEIGHT) -> None:
    x, y, z = from_shoulder("left", forward, outward, up).tolist()
    session.post(commands.DragHand("left", (x, y, z)))


def sign(session: Session, state: HandState, seconds: float) -> Snapshot:
    do(session, commands.Sign("left", state))
    return wait(session, seconds)


def push(session: Session) -> None:
    """Drag inward and back, as jerkily as a mouse: a place ten times a second."""
    for begin, end in ((0.5, -0.5), (-0.5, 0.5)):
        for k in range(1, 21):
            angle = begin + (end - begin) * k / 20
            drag(session, 0.44 * np.cos(angle), 0.44 * np.sin(angle))
            wait(session, 0.1)


def test_a_dragged_hand_teaches_the_push(session: Session, tmp_path: Path) -> None:
    do(session, commands.UsePuppet())
    drag(session, 0.39, 0.21)  # to where it begins, before anything is recorded
    wait(session, 1.5)
    assert do(session, commands.Record()).mode is Mode.RECORDING
    for lit, state in enumerate(SEQUENCE, start=1):
        now = sign(session, state, 0.5)
        assert now.gate.lit == lit
    wait(session, 3.0)  # Baxter comes
    assert not session.snapshot.held
    push(session)
    assert session.snapshot.world.block_down
    assert sign(session, HandState.LASSO, 1.0).gate.armed is False
    now = do(session, commands.Stop())
    assert now.mode is Mode.IDLE
    (entry,) = wait(session, 0.2).entries
    assert entry.block_down
    (file,) = (tmp_path / "recordings").glob("*.mcap")
    recording = read_recording(file)
    assert recording.warning == ""
    assert recording.info.source == "puppet (dragged by hand)"
    assert any(sample.gate.armed for sample in recording.samples)


def test_the_strip_shows_the_signs_in_their_order(session: Session) -> None:
    do(session, commands.UsePuppet(), commands.Watch())
    assert [run.state for run in session.snapshot.who.strip] == [HandState.UNKNOWN]
    for state in SEQUENCE:
        sign(session, state, 0.5)
    runs = session.snapshot.who.strip
    assert [run.state for run in runs] == [HandState.UNKNOWN, *SEQUENCE, HandState.CLOSED]
    assert [run.armed for run in runs] == [False] * 4 + [True]
    assert runs[1].end - runs[1].start == pytest.approx(0.5, abs=0.04)
    do(session, commands.Stop())
    assert session.snapshot.who.strip == ()
    wait(session, 0.5)
    do(session, commands.Watch())
    assert len(session.snapshot.who.strip) == 1  # another run begins anew


def test_a_handle_and_its_joint_come_together(session: Session) -> None:
    """What is dragged out of reach comes back to where the hand can be."""
    now = do(session, commands.UsePuppet())
    drag(session, 3.0, 0.0)
    now = wait(session, 3.0)
    goal = now.who.puppet.goals[Joint.HAND_LEFT]
    assert now.skeleton.positions[Joint.HAND_LEFT] == pytest.approx(goal, abs=1e-3)
    far = from_shoulder("left", 3.0, 0.0, HEIGHT)
    assert np.linalg.norm(goal - far) > 1.0


def test_a_hand_that_is_dragged_keeps_up(session: Session) -> None:
    """At the pace of a person's drag, half a meter a second, the hand is 9 cm behind, not more."""
    do(session, commands.UsePuppet(), commands.Watch())
    behind = []
    for k in range(30):
        place = (0.4, 0.25 - 0.5 * k / 30, HEIGHT)
        drag(session, *place)
        now = session.tick()
        hand = now.skeleton.positions[Joint.HAND_LEFT]
        behind.append(np.linalg.norm(hand - from_shoulder("left", *place)))
    assert max(behind[5:]) < 0.09


def test_another_source_lets_the_puppet_go(session: Session) -> None:
    assert do(session, commands.UsePuppet()).who.puppet is not None
    assert do(session, commands.UseDemonstrator()).who.puppet is None
    refused = do(session, commands.PuppetHome())
    assert refused.message.is_error
    assert "Take the puppet first" in refused.message.text
