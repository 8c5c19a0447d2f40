"""What can be done when, and why not: against what a session itself accepts."""

from dataclasses import replace
from pathlib import Path

import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.session import Session
from studio.engine.snapshot import Mode
from studio.engine.teaching import LearnerSettings
from studio.panels.readiness import (
    described,
    fitting,
    next_step,
    why_not_calibrate,
    why_not_configure,
    why_not_play,
    why_not_replay,
    why_not_teach,
    why_not_train,
)

ASKED = {
    why_not_calibrate: commands.Calibrate(),
    why_not_configure: commands.Configure(Choices("left", "exact", "sequence")),
    why_not_teach: commands.Watch(),
    why_not_train: commands.Train(LearnerSettings()),
    why_not_play: commands.PlayReproduction(),
    why_not_replay: commands.PlayDemonstration(),
}
LATER = {why_not_train, why_not_play, why_not_replay}


@pytest.mark.parametrize("why_not", ASKED, ids=lambda each: each.__name__)
def test_a_panel_refuses_at_the_start_what_the_session_refuses(why_not, tmp_path: Path) -> None:
    session = Session(tmp_path)
    try:
        refusal = why_not(session.snapshot)
        session.post(ASKED[why_not])
        assert session.tick().message.is_error is bool(refusal)
    finally:
        session.close()


@pytest.mark.parametrize(
    ("state", "blocked"),
    [
        ("start", {why_not_calibrate, why_not_teach, *LATER}),
        ("sourced", LATER),
        ("armed", set(ASKED)),
        ("recorded", {why_not_play}),
        ("trained", set()),
        ("playing", {why_not_calibrate, why_not_teach}),
        ("played", set()),
    ],
)
def test_each_step_opens_the_next(lesson, state: str, blocked: set) -> None:
    assert {ask for ask in ASKED if ask(lesson[state])} == blocked


@pytest.mark.parametrize(
    ("state", "hint"),
    [
        ("start", "1 Source"),
        ("sourced", "2 Teach"),
        ("armed", "Stop"),
        ("recorded", "3 Learn"),
        ("trained", "4 Compare"),
        ("playing", "block"),
        ("played", "fewer neurons"),
    ],
)
def test_a_newcomer_is_led_on(lesson, state: str, hint: str) -> None:
    assert hint in next_step(lesson[state])


def test_only_demonstrations_of_the_chosen_kind_count(lesson) -> None:
    assert len(fitting(lesson["taught twice"])) == 2
    assert fitting(lesson["open"]) == []  # by now the right arm is chosen
    assert "right arm with the paper mapping" in why_not_train(lesson["open"])


def test_with_all_left_out_there_is_nothing_to_learn_from(lesson) -> None:
    now = lesson["taught twice"]
    left_out = tuple(replace(entry, included=False) for entry in now.entries)
    assert len(fitting(replace(now, entries=(now.entries[0], *left_out[1:])))) == 1
    now = replace(now, entries=left_out)
    assert fitting(now) == []
    assert "left out: include one in 2 Teach" in why_not_train(now)


def test_equal_names_are_told_apart(lesson) -> None:
    (one,) = lesson["recorded"].entries
    assert described(one) != described(replace(one, number=one.number + 1))


def test_while_a_program_drives_stop_comes_first(lesson) -> None:
    driven = replace(lesson["trained"], mode=Mode.DRIVEN)
    for why_not in (why_not_configure, why_not_calibrate, why_not_teach):
        assert why_not(driven) == "A program drives Baxter: press Stop first."
    assert why_not_play(driven) == ""  # which ends it, as Stop does
    assert "Stop ends it" in next_step(driven)
