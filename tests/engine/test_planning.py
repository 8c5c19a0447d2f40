"""A plan is what a performance is told; it begins where it is asked to, or says why it cannot."""

import numpy as np
import pytest

from studio.engine.performance import perform, rows_as_trajectory
from studio.engine.planning import SETTLE, Planner, UnreachableError
from studio.engine.robot import CONTROL_RATE
from tests.engine.sweeps import samples

SHOWN, ROWS = samples(1).demonstrations[0], samples(1).rows[0]
TRAJECTORY = rows_as_trajectory(ROWS, SHOWN.duration)


def test_a_plan_without_a_world_is_what_is_sent_in_one() -> None:
    alone = perform(TRAJECTORY, SHOWN.duration, "left", "exact")
    planned = list(Planner.of("left", "exact").steps(TRAJECTORY, SHOWN.duration))
    motion = [step for step in planned if step.time >= 0.0]
    assert len(motion) == round((SHOWN.duration + SETTLE) * CONTROL_RATE)
    assert np.array_equal(
        [step.command.sent for step in motion], [tick.command.sent for tick in alone.ticks]
    )
    assert [step.time for step in motion] == [tick.time for tick in alone.ticks]


def test_from_another_pose_the_way_leads_to_the_same_beginning() -> None:
    planner = Planner.of("left", "exact")
    start = planner.ready + np.radians([5.0, -4.0, 3.0, 5.0])
    steps = list(planner.steps(TRAJECTORY, SHOWN.duration, start))
    way = [step for step in steps if step.time < 0.0]
    begin = planner.begin(TRAJECTORY, planner.ready)
    assert np.array_equal(way[-1].command.sent, begin)
    moved = np.diff([start, *(step.command.sent for step in way)], axis=0)
    assert np.abs(moved).max() * CONTROL_RATE < 0.31  # [rad/s], as softly as to a person
    usual = list(planner.motion(TRAJECTORY, SHOWN.duration, begin))
    assert np.array_equal(
        [step.command.sent for step in steps[len(way) :]], [step.command.sent for step in usual]
    )


def test_what_the_guard_refuses_is_refused_before_the_first_step() -> None:
    planner = Planner.of("left", "exact")
    into_the_desk = planner.ready + np.array([0.0, 1.5, 0.0, 0.0])
    with pytest.raises(UnreachableError, match=r"desk: stopped, \d+° short of it"):
        next(planner.steps(lambda _: into_the_desk, 1.0))
