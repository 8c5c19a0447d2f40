"""What is read off a pose agrees with the mappings, the kinematics and the person."""

import math
from dataclasses import replace

import numpy as np
import pytest

from studio.engine.arm_arcs import NAMES
from studio.engine.calibration import Calibration
from studio.engine.choices import Choices
from studio.engine.human import human_arm_angles
from studio.engine.pose_reading import COUNTERPARTS, read_pose
from studio.engine.puppet import PuppetTeacher
from studio.engine.robot import load_robot
from studio.engine.skeleton import Joint, Tracking
from tests.engine.puppet.dragging import from_shoulder

BODY = np.linspace(-0.7, 0.7, 15)


def person(forward: float, outward: float, up: float):
    puppet = PuppetTeacher()
    puppet.drag_hand("left", from_shoulder("left", forward, outward, up))
    for _ in range(120):
        puppet.idle()
    return puppet.skeleton


def test_every_angle_has_a_joint_beside_it() -> None:
    (reading,) = read_pose(person(0.3, 0.1, -0.2), Choices(), BODY)
    assert tuple(COUNTERPARTS) == NAMES == tuple(reading.joints)
    index = load_robot().joint_index("left_e1")
    assert reading.joints["elbow_pitch"] == BODY[index]
    assert reading.angles == human_arm_angles(person(0.3, 0.1, -0.2), "left")


def test_the_exact_mapping_is_exact_and_the_papers_is_not() -> None:
    for place in ((0.3, 0.1, -0.2), (0.1, 0.4, 0.2), (0.4, -0.1, 0.0)):
        (reading,) = read_pose(person(*place), Choices(), BODY)
        assert reading.errors["exact"] == pytest.approx(0.0, abs=1e-4)
        assert reading.errors["paper"] > math.radians(3)


def test_the_papers_forearm_stays_in_the_upright_plane_of_the_arm() -> None:
    """With e0 at 0 the forearm cannot leave that plane: so an arm bent in it is met exactly."""
    skeleton = person(0.3, 0.1, -0.2)
    positions = skeleton.positions.copy()
    shoulder = positions[Joint.SHOULDER_LEFT]
    positions[Joint.ELBOW_LEFT] = shoulder + np.array([0.0, -0.05, -0.27])  # forward
    on_and_down = np.array([0.0, -0.2, -0.1])
    positions[Joint.WRIST_LEFT] = positions[Joint.ELBOW_LEFT] + on_and_down
    (reading,) = read_pose(replace(skeleton, positions=positions), Choices(), BODY)
    # The paper's angles are those of Baxter's joint axes, 11° and 2° beside the lines between them.
    assert reading.errors["paper"] < math.radians(13)


def test_a_mirror_reads_the_other_arm() -> None:
    skeleton = person(0.3, 0.1, -0.2)
    both = read_pose(skeleton, Choices(arms="both", mirrored=True), BODY)
    assert [(each.robots, each.persons) for each in both] == [("left", "right"), ("right", "left")]
    assert all(each.errors["exact"] < 1e-4 for each in both)
    leaning = Choices(calibration=Calibration((0.2, 0.0, -1.0)))
    assert read_pose(skeleton, leaning, BODY)[0].errors["exact"] < 1e-4


def test_an_arm_that_is_not_seen_has_no_error() -> None:
    skeleton = person(0.3, 0.1, -0.2)
    tracking = skeleton.tracking.copy()
    tracking[Joint.WRIST_LEFT] = Tracking.NOT_TRACKED
    (reading,) = read_pose(replace(skeleton, tracking=tracking), Choices(), BODY)
    assert reading.errors == {}
