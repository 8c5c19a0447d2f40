"""One soft tick: whatever is wanted, limits and the soft start hold; in the end it is there."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.arms import driven_joints
from studio.engine.engage import EngageMemory
from studio.engine.pipeline import Pipeline, ready_pose
from studio.engine.robot import CONTROL_PERIOD, load_robot
from studio.engine.softly import softly

PIPELINE = Pipeline.for_robot(load_robot(), "left")
READY = ready_pose("left", "exact")
angles = st.lists(st.floats(-4.0, 4.0), min_size=4, max_size=4)


@settings(deadline=None, derandomize=True, max_examples=25)
@given(st.lists(angles, min_size=1, max_size=6))
def test_no_tick_passes_a_limit(goals: list[list[float]]) -> None:
    limits, sent, memory = PIPELINE.limits, READY, None
    assert len(sent) == len(driven_joints("left"))
    for k, goal in enumerate(goals * 5):
        memory, command = softly(PIPELINE, memory, sent, np.array(goal), k * CONTROL_PERIOD)
        assert np.all(command.sent >= limits.lower)
        assert np.all(command.sent <= limits.upper)
        assert np.all(np.abs(command.sent - sent) <= limits.velocity * CONTROL_PERIOD)
        sent = command.sent


def test_it_begins_slowly_and_gets_there() -> None:
    goal, sent, memory = READY + np.array([-0.5, 0.0, 0.2, 0.1]), READY, None
    for k in range(120):
        before = sent
        memory, command = softly(PIPELINE, memory, sent, goal, k * CONTROL_PERIOD)
        sent = command.sent
        if k * CONTROL_PERIOD < PIPELINE.engage.slow_for:
            most = PIPELINE.engage.slow * CONTROL_PERIOD
            assert np.abs(sent - before).max() <= most + 1e-12
    assert np.array_equal(sent, goal)
    assert memory is not None
    assert memory.released


def test_who_has_been_released_is_followed_at_once() -> None:
    memory = EngageMemory(0.0, arrived=True, released=True)
    goal = READY + 0.02
    _, command = softly(PIPELINE, memory, READY, goal, 9.0)
    assert np.array_equal(command.sent, goal)
