"""The measures against slow and obvious versions of themselves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.arms import driven_joints
from studio.engine.hands import HandOptions, HandTrack
from studio.engine.measures import deviation, dtw_distance, hand_path
from studio.engine.performance import Performance, Tick, joint_columns, whole_body
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.world import WorldState


def slow_dtw(a: np.ndarray, b: np.ndarray) -> float:
    """Try every path: the least sum of distances, and among those the fewest matches."""

    def best(i: int, j: int) -> tuple[float, int]:
        here = float(np.linalg.norm(a[i] - b[j]))
        before = [(i - 1, j), (i, j - 1), (i - 1, j - 1)]
        earlier = [best(*p) for p in before if min(p) >= 0] or [(0.0, 0)]
        total, matches = min(earlier)
        return total + here, matches + 1

    total, matches = best(len(a) - 1, len(b) - 1)
    return total / matches


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=st.integers(0, 10**6), n=st.integers(1, 5), m=st.integers(1, 5))
def test_dtw_equals_trying_every_path(seed: int, n: int, m: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(n, 3)), rng.normal(size=(m, 3))
    assert dtw_distance(a, b) == pytest.approx(slow_dtw(a, b))


def test_dtw_forgives_timing_and_nothing_else() -> None:
    path = np.column_stack([np.linspace(0, 1, 50), np.zeros(50), np.zeros(50)])
    late = path[np.repeat(np.arange(50), 2)]
    assert dtw_distance(path, late) == pytest.approx(0.0, abs=1e-12)
    assert dtw_distance(path, path + np.array([0.0, 0.1, 0.0])) == pytest.approx(0.1)


def performance_of(rows: np.ndarray, duration: float) -> Performance:
    """Return a performance that measured exactly ``rows`` (T, 15) at even stamps."""
    count = round(duration / CONTROL_PERIOD)
    stamps = np.linspace(0, duration, len(rows))
    at = [[np.interp((k + 1) * CONTROL_PERIOD, stamps, c) for c in rows.T] for k in range(count)]
    still = np.zeros((1, 7))
    ticks = tuple(
        Tick(
            k * CONTROL_PERIOD,
            None,
            WorldState(0.0, np.array(q), np.zeros(15), still, False, 0.0, False),
        )
        for k, q in enumerate(at)
    )
    return Performance("left", "exact", duration, rows[0], ticks)


def test_a_performance_without_error_measures_none_and_an_offset_measures_itself() -> None:
    joints = driven_joints("left")
    rows = np.linspace((0.0, -0.5, 0.1, 1.0), (0.5, 0.2, -0.3, 1.5), 142)
    exact = performance_of(whole_body(rows, joints), 3.0)
    none = deviation(exact, rows, joints)
    assert none.joint_rmse == pytest.approx(0.0, abs=1e-9)
    assert (none.hand_mean, none.hand_max) == pytest.approx((0.0, 0.0), abs=1e-9)
    off = deviation(exact, rows + np.array([0.1, 0.0, 0.0, 0.0]), joints)
    assert off.joint_rmse == pytest.approx([0.1, 0.0, 0.0, 0.0], abs=1e-9)
    # Turning s0 by 0.1 rad moves the hand on a circle about the shoulder's upright axis.
    hand = hand_path(whole_body(rows, joints), "left")
    radius = np.linalg.norm((hand - [0.0640, 0.2590, 0.0])[:, :2], axis=1)
    assert off.hand_mean == pytest.approx(2 * np.sin(0.05) * radius.mean(), rel=0.01)
    assert off.hand_dtw <= off.hand_mean <= off.hand_max


def test_a_wrist_that_does_what_it_should_is_no_error_of_the_hand() -> None:
    joints = driven_joints("left")
    rows = np.linspace((0.0, -0.5, 0.1, 1.0), (0.5, 0.2, -0.3, 1.5), 142)
    options, times = HandOptions(wrist="level"), np.linspace(0.0, 3.0, 142)
    wrist = np.linspace((0.0, 0.5, 0.0), (0.3, -0.5, 0.2), 142)
    hands = HandTrack(options, times, wrist, np.zeros(142, dtype=bool))
    body = whole_body(np.hstack([rows, wrist]), (*joints, *options.wrist_joints("left")))
    performed = performance_of(body, 3.0)
    assert deviation(performed, rows, joints, hands).hand_max == pytest.approx(0.0, abs=1e-9)
    assert deviation(performed, rows, joints).hand_mean > 0.03


def test_columns_are_the_arms() -> None:
    assert joint_columns(("right_s0", "right_e1")) == [7, 10]
