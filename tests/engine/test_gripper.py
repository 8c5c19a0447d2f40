from collections.abc import Sequence
from dataclasses import replace

import pytest

from studio.engine.gripper import GripMemory, Gripper
from studio.engine.skeleton import Hand, HandState, Side
from tests.engine.people import person

OPEN, CLOSED, LASSO = HandState.OPEN, HandState.CLOSED, HandState.LASSO
UNKNOWN, NOT_TRACKED = HandState.UNKNOWN, HandState.NOT_TRACKED


def play(
    *runs: tuple[HandState, float],
    rate: float = 30.0,
    armed: bool = True,
    confidence: float = 1.0,
    side: Side = "right",
    memory: GripMemory | None = None,
) -> list[bool]:
    """Return whether the gripper is closed after each frame of these states, held so long."""
    memory, found = memory or GripMemory(), []
    states = [state for state, seconds in runs for _ in range(round(seconds * rate))]
    for i, state in enumerate(states):
        seen = replace(person(i / rate), **{f"{side}_hand": Hand(state, confidence)})
        memory = Gripper().step(memory, seen, armed, i / rate)
        found.append(memory.closed)
    return found


@pytest.mark.parametrize("rate", [15.0, 30.0, 60.0])
def test_a_sign_is_believed_after_the_same_time_at_any_rate(rate: float) -> None:
    found = play((CLOSED, 1.0), rate=rate)
    assert found.index(True) / rate == pytest.approx(0.3, abs=1 / rate + 1e-9)
    assert all(found[found.index(True) :])


def test_open_opens_again() -> None:
    found = play((CLOSED, 1.0), (OPEN, 1.0))
    assert found[29]
    assert not found[-1]


@pytest.mark.parametrize("state", [UNKNOWN, NOT_TRACKED, LASSO])
def test_what_says_nothing_holds_what_was(state: HandState) -> None:
    assert play((CLOSED, 1.0), (state, 3.0))[-1]
    assert not play((OPEN, 1.0), (state, 3.0))[-1]


@pytest.mark.parametrize("flicker", [0.1, 0.2])
def test_a_flicker_does_nothing(flicker: float) -> None:
    runs: Sequence[tuple[HandState, float]] = [(CLOSED, 1.0), *[(OPEN, flicker), (CLOSED, 0.5)] * 5]
    assert all(play(*runs)[15:])


def test_only_an_armed_gate_lets_it_move() -> None:
    assert not any(play((CLOSED, 2.0), armed=False))
    assert all(play((OPEN, 2.0), armed=False, memory=GripMemory(closed=True)))


def test_the_other_hand_and_a_doubtful_one_do_nothing() -> None:
    assert not any(play((CLOSED, 2.0), side="left"))
    assert not any(play((CLOSED, 2.0), confidence=0.3))


@pytest.mark.parametrize(("gap", "closes"), [(0.5, True), (1.0, False), (60.0, False)])
@pytest.mark.parametrize("state", [UNKNOWN, NOT_TRACKED])
def test_what_is_bridged_is_bounded(state: HandState, gap: float, closes: bool) -> None:
    """Closed for 0.2 s on both sides of a gap is a sign only where the gap is short."""
    assert any(play((CLOSED, 0.2), (state, gap), (CLOSED, 0.2))) == closes


def test_two_halves_of_a_sign_on_both_sides_of_another_are_none() -> None:
    assert not any(play((CLOSED, 0.2), (OPEN, 0.1), (CLOSED, 0.2)))
    assert not any(play((CLOSED, 0.2), (LASSO, 0.1), (CLOSED, 0.2)))


@pytest.mark.parametrize(("gap", "closes"), [(0.5, True), (1.0, False), (60.0, False)])
def test_a_gap_without_frames_is_bridged_as_shortly(gap: float, closes: bool) -> None:
    memory = GripMemory()
    for start in (0.0, 0.2 + gap):
        for i in range(6):
            time = start + i / 30
            seen = replace(person(time), right_hand=Hand(CLOSED))
            memory = Gripper().step(memory, seen, True, time)
    assert memory.closed == closes


def test_no_new_frame_changes_nothing() -> None:
    memory = GripMemory(closed=True)
    assert Gripper().step(memory, None, True, 1.0) is memory
