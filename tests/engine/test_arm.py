"""One arm's stages: what is mirrored, corrected, weighted, carried on, and refused."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.arm import ArmMemory, ArmStages
from studio.engine.calibration import Calibration
from studio.engine.reach import Reach
from studio.engine.robot import load_robot
from studio.engine.skeleton import (
    SIDES,
    Joint,
    Side,
    Skeleton,
    Tracking,
    all_tracked,
    other_side,
)
from tests.engine.people import person

DIRECTIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 0.1)


def stages(side: Side = "left", **settings_of) -> ArmStages:
    return ArmStages(Reach.for_robot(load_robot(), side, "exact"), **settings_of)


def reflected(skeleton: Skeleton) -> Skeleton:
    """Return the person as a mirror shows: x reflected, left and right changed."""
    swapped = [
        Joint[joint.name.replace("LEFT", "_").replace("RIGHT", "LEFT").replace("_" * 2, "_RIGHT")]
        for joint in Joint
    ]
    positions = skeleton.positions[swapped] * [-1.0, 1.0, 1.0]
    return Skeleton(skeleton.time, positions, skeleton.tracking[swapped])


@settings(deadline=None, derandomize=True, max_examples=40)
@given(arm=st.tuples(DIRECTIONS, DIRECTIONS), side=st.sampled_from(SIDES), yaw=st.floats(-1.0, 1.0))
def test_mirrored_is_what_one_would_see_of_a_mirrored_person(arm, side: Side, yaw: float) -> None:
    """Two roads: the other arm reflected in the torso's frame, and a reflected skeleton."""
    seen = person(0.0, arm, other_side(side), yaw=yaw)
    mirrored = stages(side, mirrored=True).step(ArmMemory(), seen, 0.0)
    plain = stages(side).step(ArmMemory(), reflected(seen), 0.0)
    assert np.allclose(mirrored.upper_arm.direction, plain.upper_arm.direction, atol=1e-9)
    assert np.allclose(mirrored.forearm.direction, plain.forearm.direction, atol=1e-9)
    assert stages(side, mirrored=True).persons_side == other_side(side)


def test_the_arms_of_a_mirrored_person_are_each_others_mirror_image() -> None:
    arm = ((0.8, 0.5, 0.3), (0.7, 0.2, -0.7))
    left = stages("left").step(ArmMemory(), person(0.0, arm, "left"), 0.0).wanted
    right = stages("right", mirrored=True).step(ArmMemory(), person(0.0, arm, "left"), 0.0).wanted
    assert np.allclose(right, np.array([-1, 1, -1, 1]) * left, atol=1e-9)


def test_a_calibration_turns_both_bones() -> None:
    arm = ((0.8, 0.5, 0.3), (0.7, 0.2, -0.7))
    calibration = Calibration((math.sin(0.2), 0.0, -math.cos(0.2)))
    seen = stages(calibration=calibration).step(ArmMemory(), person(0.0, arm), 0.0)
    for direction, bone in zip((seen.upper_arm, seen.forearm), arm, strict=True):
        expected = calibration.correct(tuple(np.array(bone) / np.linalg.norm(bone)))
        assert np.allclose(direction.direction, expected, atol=1e-9)


@pytest.mark.parametrize(("part", "halves"), [("shoulder", (1, 0)), ("elbow", (1, 1)),
                                              ("wrist", (0, 1)), ("hand", (0, 0))])  # fmt: skip
def test_of_an_inferred_joint_half_of_the_news_is_let_through(part: str, halves) -> None:
    line, before, after = stages(), person(0.0), person(1 / 30, ((1, 0.3, 0.1), (0.2, 0.1, 1)))
    start = line.step(ArmMemory(), before, 0.0)
    sure = line.step(start, after, 1 / 30)
    guessed = all_tracked()
    guessed[Joint.of(part, "left")] = Tracking.INFERRED
    unsure = line.step(start, Skeleton(1 / 30, after.positions, guessed), 1 / 30)
    for name, half in zip(("upper_arm", "forearm"), halves, strict=True):
        first, whole, weighted = (
            np.array(getattr(memory, name).direction) for memory in (start, sure, unsure)
        )
        share = np.linalg.norm(weighted - first) / np.linalg.norm(whole - first)
        assert share == pytest.approx(0.5 if half else 1.0, abs=0.02)


def turning(time: float) -> Skeleton:
    angle = 0.8 * time
    return person(time, ((1.0, 0.2, 0.0), (0.3, math.cos(angle), math.sin(angle))))


def test_a_short_gap_is_bridged_by_going_on_and_a_long_one_by_holding() -> None:
    """Against the same arm seen all the time: nearer than by stopping; then still."""
    line = stages()
    seen = missed = ArmMemory()
    for i in range(30):
        seen = missed = line.step(seen, turning(i / 30), i / 30)
    stopped = np.array(missed.wanted)
    wanted = []
    for i in range(30, 50):
        seen, missed = line.step(seen, turning(i / 30), i / 30), line.step(missed, None, i / 30)
        wanted.append(missed.wanted)
        if i < 34:
            far = np.abs(np.array(missed.wanted) - seen.wanted).max()
            assert far < 0.6 * np.abs(stopped - seen.wanted).max()
    assert wanted[3:] == [wanted[3]] * len(wanted[3:])  # longest_ahead is over


def test_a_still_arm_stays_where_it_was_through_a_gap() -> None:
    line, memory = stages(), ArmMemory()
    for i in range(30):
        memory = line.step(memory, person(i / 30), i / 30)
    assert np.allclose(line.step(memory, None, 1.1).wanted, memory.wanted, atol=1e-12)


def test_a_refusal_lasts_until_the_arm_is_seen_again() -> None:
    line = stages()
    lost = all_tracked()
    lost[Joint.WRIST_LEFT] = Tracking.NOT_TRACKED
    memory = line.step(ArmMemory(), Skeleton(0.0, person(0.0).positions, lost), 0.0)
    assert (memory.wanted, memory.refusal) == (None, "left wrist not tracked")
    memory = line.step(memory, None, 0.1)
    assert memory.refusal
    memory = line.step(memory, person(0.2), 0.2)
    assert memory.refusal == ""
    assert memory.wanted is not None
