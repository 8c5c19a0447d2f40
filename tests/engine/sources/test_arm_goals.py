"""Poses of a person's arm that lead Baxter's hand somewhere."""

import math

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.retarget import arm_angles
from studio.engine.robot import BASE_HEIGHT, load_robot
from studio.engine.sources.arm_goals import ArmPose, HandGoal, Reacher
from studio.engine.sources.demonstrator_body import direction

REACHER, READY = Reacher.usual(), ArmPose(20.0, 45.0, -48.0, 15.0)
PUSHES = [HandGoal((x, y, 0.84), -45.0) for x in (0.65, 0.75) for y in (-0.1, 0.1, 0.3)]
GRASPS = [HandGoal((0.95, y, z), -10.0, True, 0.14) for y in (0.06, 0.3) for z in (0.83, 0.95)]


def sought(goal: HandGoal) -> np.ndarray:
    return REACHER.seek(goal, REACHER.joints(READY))


@pytest.mark.parametrize("goal", PUSHES + GRASPS)
def test_the_pose_leads_the_hand_there_by_the_exact_mapping(goal: HandGoal) -> None:
    """Another way to the same place: the person's directions, the mapping, the kinematics."""
    pose = REACHER.pose(sought(goal))
    upper, fore = np.radians(pose.angles).reshape(2, 2)
    joints = arm_angles(direction(*upper), direction(*fore), "left")
    if goal.level:
        place = REACHER.reached(joints, goal)[:3]
    else:
        body = np.zeros(15)
        body[:4] = joints
        hand = load_robot().forward_kinematics("left_hand", body)
        place = hand[:3, 3] + goal.ahead * hand[:3, 2] + [0.0, 0.0, BASE_HEIGHT]
    assert np.linalg.norm(place - goal.point) < 0.01


@pytest.mark.parametrize("goal", PUSHES)
def test_the_forearm_has_the_tilt_that_was_asked_for(goal: HandGoal) -> None:
    assert REACHER.pose(sought(goal)).fore_elevation == pytest.approx(goal.turn, abs=1.0)


@pytest.mark.parametrize("goal", GRASPS)
def test_a_level_hand_points_where_it_is_asked_to(goal: HandGoal) -> None:
    turn = REACHER.reached(sought(goal), goal)[3]
    assert math.degrees(turn) == pytest.approx(goal.turn, abs=2.0)


def test_a_place_out_of_reach_is_refused_with_the_cure() -> None:
    with pytest.raises(StudioError, match=r"does not reach x 1\.60.*nearer"):
        sought(HandGoal((1.6, 0.1, 0.84), -45.0))


def test_a_pose_and_its_joints_lead_back_to_it() -> None:
    assert REACHER.pose(REACHER.joints(READY)).angles == pytest.approx(READY.angles)
