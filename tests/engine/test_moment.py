"""What is shown at a playhead: exactly what was, and between two ticks what lies between."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings, strategies

from studio.engine.arms import HANGING
from studio.engine.demonstration import Demonstration, demonstrations_of
from studio.engine.follow import follow
from studio.engine.moment import demonstration_at, performance_at, recording_at, skeleton_at
from studio.engine.performance import Performance, perform
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES, load_robot
from studio.engine.sources.demonstrator import demonstrate

lawful = settings(deadline=None, derandomize=True, max_examples=40)
times = strategies.floats(-1.0, 20.0)


@cache
def followed() -> Recording:
    return follow(demonstrate(0, 1), Pipeline.for_robot(load_robot(), "left"))


@cache
def shown() -> Demonstration:
    return demonstrations_of(followed(), "take")[0]


@cache
def played() -> Performance:
    return perform(shown().trajectory(), shown().duration, "left", "exact")


@given(times)
@lawful
def test_joints_of_a_performance_are_those_that_were_measured(time) -> None:
    """Two roads: a tick's neighbors, and numpy over all ticks."""
    expected = played().measured_at(np.array([time]))[0]
    assert performance_at(played(), time).joints == pytest.approx(expected, abs=1e-12)


def test_at_a_tick_there_is_what_the_tick_saw() -> None:
    for k, tick in enumerate(played().ticks):
        moment = performance_at(played(), (k + 1) * CONTROL_PERIOD)
        assert moment.joints == pytest.approx(tick.world.joint_positions, abs=1e-9)
        assert moment.block_poses == pytest.approx(tick.world.block_poses, abs=1e-9)
    for k, sample in enumerate(followed().samples[:-1]):
        moment = recording_at(followed(), (k + 1) * CONTROL_PERIOD)
        assert moment.joints == pytest.approx(sample.world.joint_positions, abs=1e-9)
        assert moment.block_poses == pytest.approx(sample.world.block_poses, abs=1e-9)
        assert recording_at(followed(), k * CONTROL_PERIOD).index == k


@given(times)
@lawful
def test_blocks_lie_between_their_ticks_and_stay_rigid(time) -> None:
    moment = performance_at(played(), time)
    assert np.linalg.norm(moment.block_poses[:, 3:], axis=1) == pytest.approx(np.ones(3))
    place = int(np.clip(np.floor(time / CONTROL_PERIOD), 0, len(played().ticks)))
    ticks = played().ticks
    before, after = (ticks[min(max(k, 0), len(ticks) - 1)].world for k in (place - 1, place))
    lower = np.minimum(before.block_poses, after.block_poses)[:, :3] - 1e-12
    upper = np.maximum(before.block_poses, after.block_poses)[:, :3] + 1e-12
    assert ((lower <= moment.block_poses[:, :3]) & (moment.block_poses[:, :3] <= upper)).all()


def test_a_falling_block_turns_smoothly() -> None:
    """A quaternion and its negative are one turn: between ticks nothing flips."""
    fine = np.arange(0.0, played().duration, CONTROL_PERIOD / 4)
    poses = [performance_at(played(), time).block_poses[0] for time in fine]
    apart = [1.0 - abs(a[3:] @ b[3:]) for a, b in pairwise(poses)]
    coarse = [t.world.block_poses[0, 3:] for t in played().ticks]
    steps = [1.0 - abs(a @ b) for a, b in pairwise(coarse)]
    assert max(apart) < max(steps)
    assert max(steps) > 1e-4  # it fell


def test_a_quaternion_and_its_negative_are_the_same_turn() -> None:
    first, second, *_ = played().ticks
    negative = second.world.block_poses * [1, 1, 1, -1, -1, -1, -1]
    turned = replace(second, world=replace(second.world, block_poses=negative))
    other = replace(played(), ticks=(first, turned))
    for time in (1.3 / 30, 1.5 / 30, 1.9 / 30):
        expected = performance_at(played(), time).block_poses
        assert performance_at(other, time).block_poses == pytest.approx(expected, abs=1e-12)


def test_before_and_after_it_stands() -> None:
    end = len(played().ticks) * CONTROL_PERIOD
    for early, late in ((-5.0, 0.0), (end, end + 99.0)):
        a, b = performance_at(played(), early), performance_at(played(), late)
        assert np.array_equal(a.joints, b.joints)
        assert np.array_equal(a.block_poses, b.block_poses)
    assert performance_at(played(), 0.0).joints == pytest.approx(played().start)
    last = followed().samples[-1].world
    assert np.array_equal(recording_at(followed(), 1e3).joints, last.joint_positions)


@given(times)
@lawful
def test_a_demonstration_is_what_was_sent_and_the_rest_hangs(time) -> None:
    moment = demonstration_at(shown(), time)
    named = dict(zip(JOINT_NAMES, moment.joints.tolist(), strict=True))
    sent = [named.pop(joint) for joint in shown().joints]
    assert sent == pytest.approx(shown().at(np.array([time]))[0])
    hanging = [named.pop(f"right_{joint}") for joint in ("s0", "s1", "e0", "e1")]
    assert hanging == list(HANGING["right"])
    assert not any(named.values())


def test_the_skeleton_of_a_demonstration_is_its_recordings() -> None:
    samples = followed().samples
    for k, since in enumerate(shown().times.tolist()):
        index = demonstration_at(shown(), since).index
        assert index == shown().first_sample + k
        seen = skeleton_at(samples, index)
        assert seen is samples[index].skeleton or samples[index].skeleton is None
    assert demonstration_at(shown(), -1.0).index == shown().first_sample
    assert demonstration_at(shown(), 99.0).index == shown().last_sample
    lost = next(i for i, sample in enumerate(samples) if i > 0 and sample.skeleton is None)
    assert skeleton_at(samples, lost) is samples[lost - 1].skeleton
    assert skeleton_at((), 0) is None
