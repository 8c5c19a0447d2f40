"""The gate arms after Lasso, Open, Closed and after nothing else, at any frame rate."""

from collections.abc import Sequence
from itertools import product

import pytest

from studio.engine.gate import Gate, GateStatus
from studio.engine.skeleton import HandState
from tests.engine.people import held, person

LASSO, OPEN, CLOSED = HandState.LASSO, HandState.OPEN, HandState.CLOSED
UNKNOWN, NOT_TRACKED = HandState.UNKNOWN, HandState.NOT_TRACKED
LONG = 12  # frames; believed after 10, that is 0.3 s


def run(
    states: Sequence[HandState], rate: float = 30.0, gate: Gate | None = None
) -> list[GateStatus]:
    """Return the status after every frame."""
    gate, memory, found = gate or Gate(), None, []
    for i, state in enumerate(states):
        memory, status = gate.step(memory, person(i / rate, hand=state), i / rate)
        found.append(status)
    return found


def first_armed(states: Sequence[HandState], rate: float = 30.0) -> int | None:
    """Return the first frame that is armed."""
    return next((i for i, status in enumerate(run(states, rate)) if status.armed), None)


def test_arms_when_closed_has_been_seen_for_its_time() -> None:
    states = held((LASSO, LONG), (OPEN, LONG), (CLOSED, LONG))
    assert first_armed(states) == 2 * LONG + 9


@pytest.mark.parametrize("rate", [15, 30, 60])
def test_time_decides_and_not_frames(rate: int) -> None:
    """The end of a real recording, at three frame rates: armed at the same moment, once."""
    at_30 = held(
        *((LASSO, 35), (UNKNOWN, 2), (CLOSED, 7), (UNKNOWN, 2)),
        *((NOT_TRACKED, 14), (OPEN, 19), (CLOSED, 33)),
    )
    states = [at_30[int(i * 30 / rate)] for i in range(int(len(at_30) * rate / 30))]
    armed = [i for i, status in enumerate(run(states, rate)) if status.armed]
    assert armed == list(range(armed[0], len(states)))
    assert armed[0] / rate == pytest.approx(88 / 30, abs=0.1)


@pytest.mark.parametrize("order", list(product((LASSO, OPEN, CLOSED), repeat=3)))
def test_only_the_one_order_arms(order: tuple[HandState, ...]) -> None:
    armed = first_armed(held(*((state, LONG) for state in order)))
    assert (armed is not None) == (order == (LASSO, OPEN, CLOSED))


@pytest.mark.parametrize("skipped", [0, 1, 2])
def test_a_sign_too_short_is_no_sign(skipped: int) -> None:
    lengths = [LONG] * 3
    lengths[skipped] = 9  # frames, of which the first begins the time: 8/30 s
    signs = zip((LASSO, OPEN, CLOSED), lengths, strict=True)
    assert first_armed(held(*signs)) is None


@pytest.mark.parametrize("unseen", [UNKNOWN, NOT_TRACKED])
@pytest.mark.parametrize(
    ("gap", "arms"), [(2, True), (12, True), (23, True), (26, False), (60, False)]
)
def test_gaps_are_bridged_for_a_bounded_time(unseen: HandState, gap: int, arms: bool) -> None:
    for where in (1, 2):
        runs = [(LASSO, LONG), (OPEN, LONG), (CLOSED, LONG)]
        runs.insert(where, (unseen, gap))
        assert (first_armed(held(*runs)) is not None) == arms


def test_an_unseen_hand_is_never_open() -> None:
    assert first_armed(held((LASSO, LONG), (UNKNOWN, LONG), (CLOSED, LONG))) is None


def test_the_next_sign_must_come_in_time() -> None:
    flicker = [(CLOSED, 4), (LASSO, 4)]
    patient = held((LASSO, LONG), *flicker, *flicker, (OPEN, LONG), (CLOSED, LONG))
    assert first_armed(patient) is not None
    slow = held((LASSO, LONG), *[(CLOSED, 4), (OPEN, 4)] * 9, (OPEN, LONG), (CLOSED, LONG))
    assert first_armed(slow) is None


def test_time_without_sight_does_not_count_as_holding() -> None:
    """Eight frames of Lasso, then a stalled sensor: 0.23 + 0.1 s of sight, not 5.23 s."""
    gate, memory = Gate(believe_after=0.5), None
    for i in range(8):
        memory, status = gate.step(memory, person(i / 30, hand=LASSO), i / 30)
    memory, status = gate.step(memory, person(8 / 30 + 0.4, hand=LASSO), 8 / 30 + 0.4)
    assert status.lit == 0
    assert status.held == pytest.approx(7 / 30 + 0.1)


ARMING = held((LASSO, LONG), (OPEN, LONG), (CLOSED, LONG))


def test_lasso_held_disarms_and_does_not_arm_again_by_itself() -> None:
    statuses = run([*ARMING, *held((LASSO, 40), (OPEN, LONG), (CLOSED, LONG))])
    after = [status.armed for status in statuses[len(ARMING) :]]
    assert after[:15] == [True] * 15
    assert not any(after[15:])


def test_a_flicker_of_lasso_does_not_disarm() -> None:
    statuses = run([*ARMING, *held((LASSO, 10), (CLOSED, 10))])
    assert all(status.armed for status in statuses[len(ARMING) :])


def test_a_hand_lost_while_armed_disarms_after_two_seconds() -> None:
    after = [status.armed for status in run([*ARMING, *held((UNKNOWN, 80))])][len(ARMING) :]
    assert after == [True] * 61 + [False] * 19


def test_a_lost_body_disarms_after_half_a_second() -> None:
    gate, memory, armed = Gate(), None, []
    for i, state in enumerate(ARMING):
        memory, _ = gate.step(memory, person(i / 30, hand=state), i / 30)
    for i in range(len(ARMING), len(ARMING) + 20):
        memory, status = gate.step(memory, None, i / 30)
        armed.append(status.armed)
    assert armed == [True] * 15 + [False] * 5
    assert status.reason == "nobody in sight"


def test_a_body_that_a_stream_leaves_out_is_lost_too() -> None:
    """Stamps that jump by more than half a second, without frames that show nobody."""
    gate, memory = Gate(), None
    for i, state in enumerate(ARMING):
        memory, status = gate.step(memory, person(i / 30, hand=state), i / 30)
    assert status.armed
    later = len(ARMING) / 30 + 0.5
    _, status = gate.step(memory, person(later, hand=CLOSED), later)
    assert not status.armed
    assert "nobody in sight" in status.detail


def test_another_person_does_not_inherit_the_gate() -> None:
    gate, memory = Gate(), None
    for i, state in enumerate(ARMING):
        memory, _ = gate.step(memory, person(i / 30, hand=state), i / 30)
    memory, status = gate.step(memory, person(2.0, hand=CLOSED, body_id="other"), 2.0)
    assert not status.armed
    assert "another person" in status.detail


def test_an_open_gate_follows_whoever_is_in_sight() -> None:
    gate = Gate(mode="open")
    assert all(status.armed for status in run(held((UNKNOWN, 5)), gate=gate))
    _, status = gate.step(None, None, 0.0)
    assert not status.armed


def test_every_refusal_has_words() -> None:
    for status in run(held((UNKNOWN, 5), (LASSO, LONG), (UNKNOWN, 30), (OPEN, LONG), (CLOSED, 40))):
        assert status.armed or (status.reason and status.detail)
