"""The demonstrator's script: between two places of the hand it moves along a line."""

from dataclasses import replace

import numpy as np
import pytest

from studio.engine.scene_file import read_scene, scene_names
from studio.engine.skeleton import FRAME_RATE, HandState
from studio.engine.sources.arm_goals import ArmPose, HandGoal, Reacher
from studio.engine.sources.demonstrator import FULL_SEQUENCE, demonstrate
from studio.engine.sources.script import READY, REST, Step, poses_at, script_of, varied

OPEN = HandState.OPEN


@pytest.mark.parametrize("name", scene_names())
def test_every_script_signs_first_and_comes_back_at_last(name: str) -> None:
    steps = script_of(read_scene(name), FULL_SEQUENCE)
    assert [step.sign for step in steps[2:5]] == list(FULL_SEQUENCE)
    assert [step.left for step in steps[-2:]] == [READY, REST]
    assert steps[-2].sign is HandState.LASSO
    assert all((step.right is not None) == (name == "both-arms") for step in steps)


def test_a_stroke_is_straight_and_each_angle_a_smooth_curve() -> None:
    ends = HandGoal((0.7, 0.4, 0.9), -45.0), HandGoal((0.7, 0.1, 0.84), -45.0)
    steps = [Step(READY, 0.5, OPEN), *(Step(end, 2.0, OPEN) for end in ends)]
    times = np.arange(0.0, 4.5, 1.0 / FRAME_RATE)
    left, right = poses_at(steps, times)
    assert right is None
    reacher = Reacher.usual()
    places = [
        reacher.reached(reacher.joints(ArmPose(*np.degrees(pose))), ends[0])[:3]
        for pose in left[times > 2.5]
    ]
    start, end = (np.array(each.point) for each in ends)
    ahead = (end - start) / np.linalg.norm(end - start)
    off = (places - start) - np.outer((places - start) @ ahead, ahead)
    assert np.linalg.norm(off, axis=1).max() < 0.003
    assert np.abs(np.diff(left, axis=0)).max() < np.radians(4.0)


def test_takes_differ_by_centimeters_in_pushes_and_by_millimeters_in_grasps() -> None:
    for name, least, most in (("push-into-zone", 0.004, 0.03), ("pick-and-place", 0.0005, 0.007)):
        steps = script_of(read_scene(name), FULL_SEQUENCE)
        apart = []
        for seed in range(20):
            for one, other in zip(steps, varied(steps, np.random.default_rng(seed)), strict=True):
                if isinstance(one.left, HandGoal):
                    apart.append(np.subtract(other.left.point, one.left.point))
        assert least < np.std(apart) < most
        assert np.abs(apart).max() < most


def test_a_goal_that_comes_twice_is_missed_the_same_way_both_times() -> None:
    steps = script_of(read_scene("pick-and-place"), FULL_SEQUENCE)
    found = varied(steps, np.random.default_rng(1))
    pairs = dict(zip((step.left for step in steps), (step.left for step in found), strict=True))
    assert [pairs[step.left] for step in steps] == [step.left for step in found]


@pytest.mark.parametrize("name", scene_names())
def test_a_seed_gives_the_same_bytes_in_every_scene(name: str) -> None:
    scene = read_scene(name)
    first, second = demonstrate(5, 2, scene=scene), demonstrate(5, 2, scene=scene)
    assert len(first) == len(second)
    for a, b in zip(first, second, strict=True):
        assert a.positions.tobytes() == b.positions.tobytes()
        assert (a.time, a.left_hand, a.right_hand) == (b.time, b.left_hand, b.right_hand)


def test_without_a_scene_it_is_the_papers() -> None:
    given, usual = demonstrate(3, 1, scene=read_scene("push-down")), demonstrate(3, 1)
    assert [s.positions.tobytes() for s in given] == [s.positions.tobytes() for s in usual]


def test_a_scene_of_ones_own_that_has_the_papers_name_is_shown_by_its_own_blocks() -> None:
    usual = read_scene("push-down")
    own = usual.with_block_at(0.7, 0.05)
    assert own.name == usual.name
    assert script_of(own, ()) == script_of(replace(own, name="mine"), ())
    assert script_of(usual.taught_by("right"), ()) == script_of(usual, ()) != script_of(own, ())
