import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.robot import CONTROL_PERIOD
from studio.engine.servo import ACCELERATION, Servo

TOP = np.array([1.5, 4.0])
SERVO = Servo(TOP)
ANGLES = st.tuples(st.floats(-3, 3), st.floats(-3, 3)).map(np.array)


@settings(deadline=None, derandomize=True)
@given(ANGLES, st.lists(ANGLES, min_size=1, max_size=30))
def test_no_setpoint_moves_faster_than_its_joint(
    start: np.ndarray, targets: list[np.ndarray]
) -> None:
    before = SERVO.start(start)
    for target in targets:
        after = SERVO.step(before, target)
        moved = after.positions - before.positions
        assert (np.abs(moved) <= TOP * CONTROL_PERIOD * (1 + 1e-8)).all()
        np.testing.assert_allclose(after.velocities, moved / CONTROL_PERIOD, atol=1e-12)
        before = after


@settings(deadline=None, derandomize=True)
@given(ANGLES, ANGLES)
def test_a_jump_is_reached_exactly_and_never_overshot(
    start: np.ndarray, target: np.ndarray
) -> None:
    setpoint = SERVO.start(start)
    for _ in range(160):
        after = SERVO.step(setpoint, target)
        nearer = np.abs(target - after.positions) <= np.abs(target - setpoint.positions)
        assert nearer.all()
        setpoint = after
    np.testing.assert_array_equal(setpoint.positions, target)
    np.testing.assert_array_equal(setpoint.velocities, 0.0)
    assert not setpoint.catching_up.any()


def test_targets_that_a_joint_can_follow_pass_as_they_are() -> None:
    rng = np.random.default_rng(0)
    setpoint, target = SERVO.start(np.zeros(2)), np.zeros(2)
    for _ in range(100):
        target = target + rng.choice([-1.0, 1.0, 0.3], 2) * TOP * CONTROL_PERIOD
        setpoint = SERVO.step(setpoint, target)
        np.testing.assert_array_equal(setpoint.positions, target)


def test_after_a_jump_speed_grows_and_ends_no_faster_than_told() -> None:
    setpoint, target = SERVO.start(np.zeros(2)), np.array([1.0, 1.0])
    speeds = []
    while (setpoint.positions != target).any():
        setpoint = SERVO.step(setpoint, target)
        speeds.append(setpoint.velocities)
    gains = np.diff(np.array(speeds), axis=0)
    assert gains.max() <= ACCELERATION * CONTROL_PERIOD * (1 + 1e-9)
    assert np.max(speeds, axis=0)[0] == pytest.approx(TOP[0])  # there is way enough for it
    assert speeds[-1].max() < 0.4  # at most what one tick of the acceleration takes away


def test_a_reversed_jump_starts_anew() -> None:
    setpoint = SERVO.start(np.zeros(2))
    for _ in range(10):
        setpoint = SERVO.step(setpoint, np.array([2.0, 2.0]))
    back = SERVO.step(setpoint, np.array([-2.0, -2.0]))
    np.testing.assert_allclose(back.velocities, -ACCELERATION * CONTROL_PERIOD)
