"""A motion begins where it should, comes there softly, and keeps to the limits all the way."""

import numpy as np
import pytest

from studio.engine.arms import ARMS, driven_joints, learned_columns
from studio.engine.engage import ARRIVED_WITHIN
from studio.engine.performance import (
    UnreachableError,
    in_guards_words,
    perform,
    perform_steps,
    rows_as_trajectory,
    start_world,
)
from studio.engine.pipeline import Pipeline, ready_pose
from studio.engine.retarget import MAPPINGS
from studio.engine.robot import CONTROL_PERIOD, load_robot


def away(arms, mapping) -> np.ndarray:
    """Return rows (2, D) [rad] that begin 0.6 rad from the ready pose and stay there."""
    pose = ready_pose(arms, mapping)[learned_columns(arms, mapping)]
    return np.tile(pose - 0.6 * (np.arange(len(pose)) % len(pose) == 0), (2, 1))


@pytest.mark.parametrize("arms", ARMS)
@pytest.mark.parametrize("mapping", MAPPINGS)
def test_it_comes_softly_to_where_the_motion_begins(arms, mapping) -> None:
    rows = away(arms, mapping)
    trajectory = rows_as_trajectory(rows, 1.0)
    with start_world(arms, mapping) as world:
        ticks = list(perform_steps(world, trajectory, 1.0, arms, mapping))
    sent = np.array([ready_pose(arms, mapping), *(tick.command.sent for tick in ticks)])
    speed = np.abs(np.diff(sent, axis=0)).max(axis=1) / CONTROL_PERIOD
    way = [tick for tick in ticks if tick.time < 0.0]
    assert speed[:30].max() <= 0.3 * (1 + 1e-9)
    assert (speed <= load_robot().limits_of(driven_joints(arms)).velocity.max()).all()
    assert np.allclose(way[-1].command.sent[learned_columns(arms, mapping)], rows[0], atol=1e-9)
    assert way[-1].time == pytest.approx(-CONTROL_PERIOD)
    assert 1.0 < len(way) * CONTROL_PERIOD < 3.0


def test_the_way_there_is_no_part_of_the_performance() -> None:
    rows = away("left", "exact")
    found = perform(rows_as_trajectory(rows, 1.0), 1.0, "left", "exact")
    assert found.ticks[0].time == 0.0
    assert len(found.ticks) == round((1.0 + 1.5) / CONTROL_PERIOD)
    columns = [load_robot().joint_index(joint) for joint in driven_joints("left")]
    assert np.allclose(found.start[columns], rows[0], atol=0.03)
    assert np.allclose(found.measured_at(np.array([0.0]))[0], found.start)


IN_THE_DESK = np.array([-1.2, 1.04, 0.0, 0.1])  # [rad] the guard stops 35° short of it


def test_a_beginning_that_cannot_be_reached_is_refused_before_anything_moves() -> None:
    with start_world("left", "exact") as world:
        before = world.state.joint_positions
        steps = perform_steps(world, lambda _: IN_THE_DESK, 1.0, "left", "exact")
        with pytest.raises(UnreachableError, match=r"desk: stopped, 3\d° short of it"):
            next(steps)
        assert np.array_equal(world.state.joint_positions, before)


@pytest.mark.parametrize("mapping", MAPPINGS)
def test_a_performance_of_it_stands_still_and_says_why(mapping) -> None:
    columns = learned_columns("left", mapping)
    found = perform(lambda _: IN_THE_DESK[columns], 1.0, "left", mapping)
    assert "cannot come to where this motion begins" in found.refusal
    assert in_guards_words(found) == found.refusal
    assert len(found.ticks) == round((1.0 + 1.5) / CONTROL_PERIOD)
    for tick in found.ticks:
        assert np.array_equal(tick.command.sent, ready_pose("left", mapping))


def test_a_beginning_just_inside_a_margin_is_near_enough() -> None:
    """The guard stops a way that leads a little too low; the motion begins all the same."""
    ready = ready_pose("left", "exact")
    low = next(
        ready + share * (np.array([0.0, 0.7, 0.0, 0.4]) - ready)
        for share in np.linspace(0.0, 1.0, 200)
        if way_left(ready + share * (np.array([0.0, 0.7, 0.0, 0.4]) - ready)) > 0.01
    )
    assert way_left(low) < ARRIVED_WITHIN
    found = perform(lambda _: low, 0.5, "left", "exact")
    assert not found.refusal
    assert found.guarded_ticks > 0
    assert "desk" in in_guards_words(found)


def way_left(pose: np.ndarray) -> float:
    """Return how far [rad] from a pose the guard stops a straight way to it."""
    pipeline = Pipeline.for_robot(load_robot(), "left")
    sent = ready_pose("left", "exact")
    for _ in range(150):
        step = sent + np.clip(pose - sent, -0.02, 0.02)
        sent = pipeline.guard.step(sent, step, CONTROL_PERIOD).sent
    return float(np.abs(pose - sent).max())


def test_what_the_guard_held_off_for_long_is_caught_up_softly() -> None:
    """Three seconds in the desk's way, then out of it in a jump: the robot does not leap."""
    ready = ready_pose("left", "exact")
    out = ready + np.array([0.3, -0.6, 0.0, 0.0])

    def motion(time: float) -> np.ndarray:
        return ready + min(time, 1.0) * (IN_THE_DESK - ready) if time < 4.0 else out

    found = perform(motion, 8.0, "left", "exact")
    sent = np.array([tick.command.sent for tick in found.ticks])
    speed = np.abs(np.diff(sent, axis=0)).max(axis=1) / CONTROL_PERIOD
    free = round(4.0 / CONTROL_PERIOD)
    assert found.guarded_ticks > 60
    assert np.abs(sent[free - 2] - IN_THE_DESK).max() > 0.3
    assert speed[free : free + 29].max() <= 0.3 * (1 + 1e-9)
    assert np.allclose(sent[-1], out)
    assert f"changed {found.guarded_ticks} of {len(found.ticks)} ticks" in in_guards_words(found)


def test_from_where_it_waits_there_is_no_way() -> None:
    ready = ready_pose("left", "exact")
    found = perform(lambda _: ready, 0.5, "left", "exact")
    assert found.ticks[0].time == 0.0
    assert np.allclose(found.ticks[0].command.sent, ready)
    assert found.guarded_ticks == 0
    assert in_guards_words(found) == ""
