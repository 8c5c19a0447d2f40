"""The filter keeps unit vectors, follows what moves, quiets what does not, and drops outliers."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.smooth import OneEuro, OneEuroMemory

FILTER = OneEuro(min_cutoff=1.5, beta=0.7)
DIRECTIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 1e-2)


def heading(angle: float) -> tuple[float, float, float]:
    return (math.cos(angle), math.sin(angle), 0.0)


@settings(deadline=None, derandomize=True)
@given(steps=st.lists(st.tuples(DIRECTIONS, st.floats(0.0, 0.5)), min_size=1, max_size=30))
def test_what_comes_out_has_length_one_whatever_the_stamps(steps) -> None:
    memory: OneEuroMemory | None = None
    time = 0.0
    for direction, elapsed in steps:
        length = math.hypot(*direction)
        time += elapsed
        memory, smoothed = FILTER.step(memory, tuple(x / length for x in direction), time)
        assert abs(math.hypot(*smoothed) - 1.0) < 1e-9


def test_noise_on_a_still_arm_is_more_than_halved() -> None:
    rng = np.random.default_rng(5)
    memory, before, after = None, [], []
    for i in range(600):
        angle = rng.normal(0.0, 0.02)
        memory, smoothed = FILTER.step(memory, heading(angle), i / 30)
        before.append(angle)
        after.append(math.atan2(smoothed[1], smoothed[0]))
    assert np.std(np.diff(after)) < 0.5 * np.std(np.diff(before))


def test_a_moving_arm_is_followed_within_a_tenth_of_a_second() -> None:
    memory, speed = None, 1.5  # rad/s, as fast as Baxter can
    for i in range(60):
        memory, smoothed = FILTER.step(memory, heading(speed * i / 30), i / 30)
    behind = math.remainder(speed * 59 / 30 - math.atan2(smoothed[1], smoothed[0]), 2 * math.pi)
    assert 0.0 < behind / speed < 0.1


def test_an_outlier_is_dropped_but_a_new_truth_is_believed() -> None:
    memory, _ = FILTER.step(None, heading(0.0), 0.0)
    for i in range(1, 4):  # 3 rad within a frame is 90 rad/s
        memory, smoothed = FILTER.step(memory, heading(3.0), i / 30)
        assert smoothed == heading(0.0)
    for i in range(4, 60):
        memory, smoothed = FILTER.step(memory, heading(3.0), i / 30)
    assert np.allclose(smoothed, heading(3.0), atol=0.01)


def test_forgetting_leaves_no_trace() -> None:
    direction = heading(0.3)
    assert FILTER.step(None, direction, 5.0) == FILTER.step(None, direction, 5.0)
    assert FILTER.step(None, direction, 5.0)[1] == direction


def test_trust_is_the_share_of_the_news_that_is_let_through() -> None:
    start, _ = FILTER.step(None, heading(0.0), 0.0)
    moved = [
        math.atan2(*reversed(FILTER.step(start, heading(0.2), 1 / 30, trust)[1][:2]))
        for trust in (0.0, 0.5, 1.0)
    ]
    assert moved[0] == 0.0
    assert abs(moved[1] / moved[2] - 0.5) < 0.01


def test_a_steady_turn_is_carried_on_for_a_moment_and_then_held() -> None:
    memory = None
    for i in range(60):
        memory, smoothed = FILTER.step(memory, heading(i / 30), i / 30)  # 1 rad/s
    at = math.atan2(smoothed[1], smoothed[0])
    ahead = [math.atan2(*reversed(FILTER.ahead(memory, i / 30)[:2])) - at for i in range(10)]
    assert ahead[0] == 0.0
    assert 0.8 / 30 < ahead[1] < 1.0 / 30  # nearly at the turn's own speed to begin with
    assert (np.diff(ahead[:4]) > 0.0).all()
    assert ahead[4:] == [ahead[4]] * 6
    assert ahead[9] < 0.07
    assert abs(math.hypot(*FILTER.ahead(memory, 0.1)) - 1.0) < 1e-12
