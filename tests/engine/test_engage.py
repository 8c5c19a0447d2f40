"""The robot comes softly: slow for a second whatever happens, always nearer, and always there."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.engage import (
    ARRIVED_WITHIN,
    HELD_OFF_BEYOND,
    LONGEST_HOLD,
    Engage,
    EngageMemory,
    Move,
    Passed,
)

PERIOD = 1 / 30
ENGAGE = Engage()
ANGLES = st.tuples(*[st.floats(-3.0, 3.0)] * 4)


def come(start, wanted, ticks: int) -> list[tuple[EngageMemory, tuple[float, ...]]]:
    """Return memory and target of every tick; ``wanted`` is a function of the tick."""
    memory, at, steps = None, tuple(start), []
    for k in range(ticks):
        memory, at = ENGAGE.step(memory, at, tuple(wanted(k)), k * PERIOD, PERIOD)
        steps.append((memory, at))
    return steps


@settings(deadline=None, derandomize=True)
@given(start=ANGLES, wanted=st.lists(ANGLES, min_size=30, max_size=30))
def test_the_first_second_is_slow_wherever_the_person_goes(start, wanted) -> None:
    before = np.array(start)
    for _, at in come(start, lambda k: wanted[k], 30):
        assert np.abs(np.array(at) - before).max() <= ENGAGE.slow * PERIOD * (1 + 1e-9)
        before = np.array(at)


@settings(deadline=None, derandomize=True)
@given(start=ANGLES, wanted=ANGLES)
def test_to_somebody_who_waits_it_goes_straight_and_arrives(start, wanted) -> None:
    steps = come(start, lambda _: wanted, 210)
    way = np.array(wanted) - start
    left = [np.abs(np.array(wanted) - at).max() for _, at in steps]
    assert (np.diff(left) <= 1e-12).all()
    for (_, at), rest in zip(steps, left, strict=True):
        share = 1.0 - rest / np.abs(way).max() if way.any() else 1.0
        assert np.allclose(at, np.array(start) + share * way, atol=1e-9)
    assert steps[-1][0].released
    assert left[-1] == 0.0


def test_the_cap_never_falls_as_the_gap_closes() -> None:
    steps = [np.array(at) for _, at in come((0.0,) * 4, lambda _: (1.0, 0.0, 0.0, 0.0), 150)]
    speeds = np.diff([at[0] for at in steps]) / PERIOD
    moving = speeds[: np.argmax(np.array([at[0] for at in steps]) > 1.0 - ARRIVED_WITHIN) - 2]
    assert (np.diff(moving) > -1e-9).all()
    assert moving.max() > 2 * ENGAGE.slow


def test_arrived_is_told_as_soon_as_it_is_there_and_stays_so() -> None:
    near = come((0.0,) * 4, lambda _: (ARRIVED_WITHIN / 2, 0.0, 0.0, 0.0), 2)
    assert near[0][0].arrived
    assert not near[0][0].released  # the first second is slow all the same
    away = come((0.0,) * 4, lambda k: (0.0 if k < 5 else 1.0, 0.0, 0.0, 0.0), 20)
    assert all(memory.arrived for memory, _ in away)
    far = come((0.0,) * 4, lambda _: (1.0, 0.0, 0.0, 0.0), 20)
    assert not any(memory.arrived for memory, _ in far)


def test_somebody_who_never_waits_is_followed_at_full_speed_after_five_seconds() -> None:
    steps = come((0.0,) * 4, lambda k: (2.0 * (-1) ** k, 0.0, 0.0, 0.0), 160)
    speeds = np.abs(np.diff([at[0] for _, at in steps])) / PERIOD
    full = int(np.argmax(speeds > ENGAGE.full * (1 - 1e-9))) + 1
    assert abs(full * PERIOD - 5.0) < 2 * PERIOD
    assert not any(memory.released or memory.arrived for memory, _ in steps)  # it never was there


def blocked(gap: float, ticks: int, sliding: float = 0.0) -> list[EngageMemory]:
    """Return the memories of a robot that followed, and that a guard now keeps ``gap`` away.

    Meanwhile it slides along what it must not touch, at a speed [rad/s].
    """
    memory, found = EngageMemory(-9.0, True, True), []
    for k in range(ticks):
        at, wanted = (0.0, sliding * PERIOD * k), (gap, sliding * PERIOD * (k + 1))
        memory, target = ENGAGE.step(memory, at, wanted, k * PERIOD, PERIOD)
        sent = (0.0, sliding * PERIOD * (k + 1))
        passed = Passed(at, target, sent)
        memory = ENGAGE.after(Move(memory, wanted, target), passed, k * PERIOD, PERIOD)
        found.append(memory)
    return found


def test_what_was_held_off_for_long_comes_slowly_anew() -> None:
    memories = blocked(0.5, 60)
    ends = next(k for k, memory in enumerate(memories) if not memory.released)
    assert abs(ends * PERIOD - LONGEST_HOLD) <= 2 * PERIOD
    assert not any(memory.arrived or memory.released for memory in memories[ends:])
    memory, at = memories[-1], (0.0, 0.0)
    for k in range(60, 85):  # free again, with a long way to go: slow for a whole second
        memory, to = ENGAGE.step(memory, at, (2.0, 0.0), k * PERIOD, PERIOD)
        assert abs(to[0] - at[0]) <= ENGAGE.slow * PERIOD * (1 + 1e-9)
        at = to


def test_time_alone_never_ends_an_engagement_that_is_held_off() -> None:
    memory = None
    for k in range(600):
        memory, target = ENGAGE.step(memory, (0.0,), (0.5,), k * PERIOD, PERIOD)
        assert 0.0 < target[0] <= ENGAGE.slow * PERIOD * (1 + 1e-9)
        passed = Passed((0.0,), target, (0.0,))
        memory = ENGAGE.after(Move(memory, (0.5,), target), passed, k * PERIOD, PERIOD)
    assert not memory.released


def test_a_short_hold_a_small_gap_and_a_slide_are_no_hold() -> None:
    assert all(memory.released for memory in blocked(0.5, 10))
    assert all(memory.released for memory in blocked(HELD_OFF_BEYOND * 0.9, 60))
    assert all(memory.released for memory in blocked(0.5, 60, sliding=0.6))
