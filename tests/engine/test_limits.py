"""No command passes a limit, whatever is wanted; what is not finite is refused."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import StudioError
from studio.engine.limits import Limits
from studio.engine.pipeline import Pipeline, ready_angles
from studio.engine.retarget import DRIVEN_JOINTS, MAPPINGS
from studio.engine.robot import CONTROL_PERIOD, load_robot
from studio.engine.skeleton import JOINT_COUNT, SIDES, Hand, HandState, Side, Skeleton, all_tracked

ANY = st.floats(allow_nan=False, allow_infinity=False)
laws = settings(deadline=None, derandomize=True, max_examples=150)


def limits_of(side: Side) -> Limits:
    return Pipeline.for_robot(load_robot(), side).limits


@laws
@given(wanted=st.lists(st.tuples(*[ANY] * 4), min_size=1, max_size=20),
       elapsed=st.floats(1e-4, 1.0), side=st.sampled_from(SIDES))  # fmt: skip
def test_never_too_far_and_never_too_fast(wanted, elapsed: float, side: Side) -> None:
    limits = limits_of(side)
    sent = ready_angles(side, "exact")
    for target in wanted:
        command = limits.step(sent, target, elapsed)
        assert (np.abs(command.sent - sent) <= limits.velocity * elapsed).all()
        assert (limits.lower <= command.sent).all()
        assert (command.sent <= limits.upper).all()
        sent = command.sent


@laws
@given(data=st.data(), side=st.sampled_from(SIDES), mapping=st.sampled_from(MAPPINGS))
def test_arbitrary_skeletons_never_carry_a_command_over_a_limit(data, side: Side, mapping) -> None:
    """The law end to end: any finite positions, through the whole pipeline with an open gate."""
    pipeline = Pipeline.for_robot(load_robot(), side, mapping, "open")
    memory, limits = pipeline.start(), limits_of(side)
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    for i in range(12):
        scale = 10.0 ** rng.uniform(-300, 300)
        positions = scale * rng.normal(size=(JOINT_COUNT, 3)) * rng.integers(0, 2, (JOINT_COUNT, 1))
        skeleton = Skeleton(i / 30, positions, all_tracked(), Hand(HandState.UNKNOWN))
        before = memory.sent
        memory, outcome = pipeline.advance(memory, skeleton, i / 30)
        sent = outcome.command.sent
        assert np.isfinite(sent).all()
        assert (np.abs(sent - before) <= limits.velocity * CONTROL_PERIOD).all()
        assert ((limits.lower <= sent) & (sent <= limits.upper)).all()


def test_it_gets_where_it_may_and_says_what_bit() -> None:
    limits = limits_of("left")
    sent = np.zeros(4)
    far = limits.step(sent, limits.upper + 1.0, 0.1)
    assert far.position_limited.all()
    assert far.velocity_limited.all()
    near = limits.step(sent, [0.01] * 4, 0.1)
    assert not near.limited
    assert np.array_equal(near.sent, [0.01] * 4)
    for _ in range(100):
        sent = limits.step(sent, limits.upper + 1.0, 0.1).sent
    assert np.allclose(sent, limits.upper)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_refused(bad: float) -> None:
    with pytest.raises(StudioError, match="finite"):
        limits_of("left").step(np.zeros(4), [0.0, bad, 0.0, 0.0], 0.1)
    with pytest.raises(StudioError, match="not finite"):
        Skeleton(0.0, np.full((JOINT_COUNT, 3), bad), all_tracked())


@pytest.mark.parametrize("elapsed", [0.0, -1.0, math.nan])
def test_a_step_takes_time(elapsed: float) -> None:
    with pytest.raises(StudioError, match="time step"):
        limits_of("left").step(np.zeros(4), np.zeros(4), elapsed)


def test_the_limits_are_the_urdfs() -> None:
    limits = load_robot().limits_of([f"left_{joint}" for joint in DRIVEN_JOINTS])
    assert np.allclose(limits.velocity, 1.5)
    assert limits.upper[1] == pytest.approx(1.047)
