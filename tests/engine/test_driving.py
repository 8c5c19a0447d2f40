"""A robot that a program drives: inside limits and guard, and only as long as there is news."""

import math

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.commands import SetJointTarget
from studio.engine.driving import END_AFTER, HOLD_AFTER, SILENT, Driven
from studio.engine.engage import Engage
from studio.engine.errors import StudioError
from studio.engine.hands import HandOptions
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES, load_robot
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from tests.engine.sessions import do

S0, S1 = JOINT_NAMES.index("left_s0"), JOINT_NAMES.index("left_s1")


@pytest.fixture
def session(tmp_path):
    made = Session(tmp_path)
    yield made
    made.close()


def driven_for(session: Session, ticks: int, **targets: float) -> list[Snapshot]:
    return [do(session, SetJointTarget(targets)) for _ in range(ticks)]


def test_it_goes_there_softly_and_follows_from_there(session: Session) -> None:
    start = session.snapshot.world.joint_positions[S0]
    seen = driven_for(session, 90, left_s0=start - 0.6)
    s0 = np.array([each.world.joint_positions[S0] for each in seen])
    assert s0[-1] == pytest.approx(start - 0.6, abs=0.02)
    soft = Engage()
    first = np.abs(np.diff(s0[: round(soft.slow_for / CONTROL_PERIOD)]))
    assert first.max() <= soft.slow * CONTROL_PERIOD * 1.3
    assert seen[-1].mode is Mode.DRIVEN
    status = seen[-1].driven
    assert status is not None
    assert (status.follows, status.arrived, status.holds) == (True, True, False)
    assert seen[0].driven is not None
    assert not seen[0].driven.follows


def test_no_limit_is_passed_wherever_it_is_sent(session: Session) -> None:
    limits = load_robot().limits
    chance = np.random.default_rng(0)
    before = session.snapshot.world.joint_positions
    for _ in range(120):
        wild = {f"left_{joint}": chance.uniform(-9.0, 9.0) for joint in ("s0", "s1", "e0", "e1")}
        now = do(session, SetJointTarget(wild)).world.joint_positions
        assert np.all(now >= limits.lower - 0.05)
        assert np.all(now <= limits.upper + 0.05)
        assert np.all(np.abs(now - before) <= 1.2 * limits.velocity * CONTROL_PERIOD)
        before = now


def test_the_guard_keeps_it_off_the_desk(session: Session) -> None:
    seen = driven_for(session, 150, left_s0=-0.4, left_s1=1.0, left_e1=0.2)
    words = {each.guarded for each in seen if each.guarded}
    assert any("desk" in each for each in words)
    assert seen[-1].driven is not None
    assert not seen[-1].driven.arrived


def test_without_news_it_holds_then_nobody_drives_it(session: Session) -> None:
    driven_for(session, 60, left_s0=1.4)
    for _ in range(HOLD_AFTER + 1):
        session.tick()
    held = session.snapshot.world.joint_positions[S0]
    assert session.snapshot.driven is not None
    assert session.snapshot.driven.holds
    for _ in range(END_AFTER):
        session.tick()
    assert session.snapshot.mode is Mode.IDLE
    assert session.snapshot.message.text == SILENT
    assert session.snapshot.world.joint_positions[S0] == pytest.approx(held, abs=0.02)


def test_no_targets_at_all_are_a_sign_of_life_but_begin_nothing(session: Session) -> None:
    assert do(session, SetJointTarget()).mode is Mode.IDLE
    driven_for(session, 1, left_s0=0.3)
    for _ in range(3 * HOLD_AFTER):
        now = do(session, SetJointTarget())
    assert now.world.joint_positions[S0] == pytest.approx(0.3, abs=0.02)


def test_joints_that_are_not_named_stay_with_their_targets(session: Session) -> None:
    driven_for(session, 60, left_s0=0.3)
    now = driven_for(session, 60, left_s1=-0.2)[-1].world.joint_positions
    assert now[[S0, S1]] == pytest.approx([0.3, -0.2], abs=0.02)


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (SetJointTarget({"left_w0": 0.0}), "'left_w0' cannot be driven: left arm"),
        (SetJointTarget({"right_s0": 0.0}), "cannot be driven"),
        (SetJointTarget({"left_s0": math.nan}), "left_s0: an angle is finite"),
        (SetJointTarget(closed=True), "no fingers to close"),
    ],
)
def test_what_cannot_be_is_said_and_changes_nothing(session: Session, command, words: str) -> None:
    now = do(session, command)
    assert now.message.is_error
    assert words in now.message.text
    assert now.mode is Mode.IDLE
    driven_for(session, 1, left_s0=0.3)
    now = do(session, command)
    assert now.message.is_error
    assert now.mode is Mode.DRIVEN


def test_wrists_and_fingers_where_there_are_any() -> None:
    choices = Choices("right", hands=HandOptions(gripper=True, wrist="level"))
    with choices.start_world() as world:
        driven = Driven(world, choices, SetJointTarget({"right_w0": 0.4}, closed=True))
        for _ in range(90):
            driven.take(SetJointTarget())
            assert driven.step()
        state = world.state
    assert state.joint_positions[JOINT_NAMES.index("right_w0")] == pytest.approx(0.4, abs=0.03)
    assert state.fingers[2:].max() < 0.003
    assert state.fingers[:2].min() > 0.015


@pytest.mark.parametrize("command", [commands.Record(), commands.Watch(), commands.Calibrate()])
def test_whoever_teaches_is_not_driven_away(session: Session, command) -> None:
    do(session, commands.UseDemonstrator(), command)
    mode = session.snapshot.mode
    now = do(session, SetJointTarget({"left_s0": 0.3}))
    assert now.mode is mode
    assert "Stop first" in now.message.text


def test_stop_and_let_go_end_it_at_once(session: Session) -> None:
    for command, words in ((commands.Stop(), "Stopped."), (commands.LetGo("Gone."), "Gone. Stop")):
        do(session, commands.BeginDriving())
        driven_for(session, 3, left_s0=1.0)
        now = do(session, command)
        assert now.mode is Mode.IDLE
        assert now.message.text.startswith(words)


def test_after_a_stop_nothing_but_to_begin_anew_lets_targets_count(session: Session) -> None:
    driven_for(session, 3, left_s0=1.0)
    do(session, commands.Stop(), SetJointTarget({"left_s0": 1.0}))
    for other in (commands.PutBlockBack(), commands.LetGo("Gone."), commands.UseDemonstrator()):
        do(session, other)
        now = driven_for(session, 5, left_s0=1.0)[-1]
        assert (now.mode, now.driven, now.stopped) == (Mode.IDLE, None, True)
    stands = now.world.joint_positions[S0]
    now = do(session, commands.BeginDriving())
    assert (now.mode, now.stopped) == (Mode.IDLE, False)
    assert now.world.joint_positions[S0] == pytest.approx(stands, abs=1e-3)
    assert driven_for(session, 1, left_s0=1.0)[-1].mode is Mode.DRIVEN
    assert not do(session, commands.BeginDriving()).message.is_error  # as often as one likes
    assert session.snapshot.mode is Mode.DRIVEN


def test_while_somebody_teaches_there_is_nothing_to_begin(session: Session) -> None:
    do(session, commands.Stop(), commands.UseDemonstrator(), commands.Watch())
    now = do(session, commands.BeginDriving())
    assert "Stop first" in now.message.text
    assert now.stopped


def test_what_is_chosen_stays_meanwhile_and_a_fresh_world_ends_it(session: Session) -> None:
    driven_for(session, 3, left_s0=1.0)
    assert "Stop first" in do(session, commands.Configure(Choices("both"))).message.text
    now = do(session, commands.PutBlockBack())
    assert now.mode is Mode.IDLE
    assert now.world.time < 0.1


def test_the_world_that_it_takes_over_is_the_one_that_was_there(session: Session) -> None:
    session.tick()
    time = session.snapshot.world.time
    assert driven_for(session, 1, left_s0=0.2)[0].world.time > time


def test_its_errors_are_the_studios() -> None:
    choices = Choices()
    with choices.start_world() as world, pytest.raises(StudioError):
        Driven(world, choices, SetJointTarget({"nothing": 0.0}))
