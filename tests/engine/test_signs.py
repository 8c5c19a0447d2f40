"""A hold is the time for which a sign was observed: no more, and the same at any frame rate."""

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.signs import LONGEST_SIGHT, NANOSECONDS, HandMemory, nanoseconds, reaches
from studio.engine.skeleton import HandState

LASSO, OPEN, UNKNOWN = HandState.LASSO, HandState.OPEN, HandState.UNKNOWN
GAP = nanoseconds(0.8)


def after(*shown: tuple[float, HandState]) -> HandMemory:
    """Return the memory after frames at times [s]."""
    memory = HandMemory()
    for time, state in shown:
        memory = memory.forgotten(nanoseconds(time), GAP).showing(state, 1.0, nanoseconds(time))
    return memory


@pytest.mark.parametrize("rate", [15, 30, 60])
def test_a_hold_is_as_long_as_the_sign_was_shown(rate: int) -> None:
    shown = [(i / rate, LASSO) for i in range(rate // 5)] + [(0.2, OPEN)]
    assert after(*shown[:-1]).held_by(nanoseconds(0.2)) == pytest.approx(0.2 * NANOSECONDS, abs=9)
    assert after(*shown).held == 0


def test_a_hold_outlasts_what_is_unseen_but_does_not_grow() -> None:
    memory = after((0.0, LASSO), (0.05, UNKNOWN), (0.3, LASSO))
    assert (memory.held, memory.sign, memory.lost_since) == (nanoseconds(0.05), LASSO, None)
    assert memory.held_by(nanoseconds(0.35)) == nanoseconds(0.1)


def test_a_long_loss_is_forgotten() -> None:
    assert after((0.0, LASSO), (0.05, UNKNOWN), (0.85, UNKNOWN)).sign is LASSO
    assert after((0.0, LASSO), (0.05, UNKNOWN), (0.86, UNKNOWN)).sign is None
    assert after((0.0, LASSO), (0.05, UNKNOWN), (0.86, LASSO)).held == 0


def test_a_sensor_that_stalls_has_seen_next_to_nothing() -> None:
    assert after((0.0, LASSO)).held_by(nanoseconds(60.0)) == LONGEST_SIGHT


def test_stamps_that_stay_or_run_back_add_nothing() -> None:
    memory = after((1.0, LASSO), (1.05, LASSO), (1.05, LASSO), (0.5, LASSO))
    assert memory.held == nanoseconds(0.05)


def test_a_hold_becomes_long_enough_once() -> None:
    """Whatever its stamps were rounded to."""
    needed = nanoseconds(0.3)
    held = [round(i * NANOSECONDS / 30) for i in range(20)]
    crossed = [reaches(a, b, needed) for a, b in pairwise(held)]
    assert crossed.index(True) == 8
    assert sum(crossed) == 1
    assert reaches(0, needed - 5, needed)


@settings(deadline=None, derandomize=True)
@given(
    st.lists(st.tuples(st.integers(0, 10**9), st.sampled_from([LASSO, OPEN, UNKNOWN])), max_size=30)
)
def test_a_hold_is_never_longer_than_the_time(steps: list[tuple[int, HandState]]) -> None:
    memory, now = HandMemory(), 0
    for elapsed, state in steps:
        now += elapsed
        memory = memory.forgotten(now, GAP).showing(state, 1.0, now)
        assert 0 <= memory.held <= now
        assert memory.sign is None or memory.lost_for(now) <= GAP
