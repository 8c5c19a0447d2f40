"""The person stands beside the robot, on the floor, and faces the way it faces."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies
from hypothesis.extra import numpy as arrays

from studio.engine.skeleton import Hand, HandState, Joint, Skeleton, Tracking, all_tracked
from studio.engine.sources.demonstrator import demonstrate
from studio.panels.palette import HAND
from studio.panels.person import SPOT, Placement, hand_words, joint_colors

coordinates = strategies.floats(-5.0, 5.0)
points = arrays.arrays(np.float64, (25, 3), elements=coordinates)


@given(points)
@settings(deadline=None, derandomize=True)
def test_anybody_stands_on_the_floor_beside_the_robot(positions) -> None:
    skeleton = Skeleton(0.0, positions, all_tracked())
    placed = Placement.of(skeleton).place(positions)
    assert placed[:, 2].min() == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(placed[Joint.SPINE_BASE, :2], SPOT, atol=1e-12)


@given(points)
@settings(deadline=None, derandomize=True)
def test_nobody_is_stretched_or_mirrored(positions) -> None:
    placed = Placement.of(Skeleton(0.0, positions, all_tracked())).place(positions)
    before, after = positions - positions[0], placed - placed[0]
    np.testing.assert_allclose(after @ after.T, before @ before.T, atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(after[1:4]), np.linalg.det(before[1:4]), atol=1e-9)


def test_who_faces_the_sensor_faces_the_robots_way() -> None:
    positions = demonstrate(seed=3)[0].positions
    placed = Placement.of(demonstrate(seed=3)[0]).place(positions)
    left = placed[Joint.SHOULDER_LEFT] - placed[Joint.SHOULDER_RIGHT]
    up = placed[Joint.HEAD] - placed[Joint.SPINE_BASE]
    forward = np.cross(left, up)
    assert forward[0] > 0.9 * np.linalg.norm(forward)  # the robot looks along x
    assert placed[Joint.HEAD, 2] > 1.4
    assert placed[Joint.FOOT_LEFT, 2] < 0.15


def test_a_placement_follows_one_person() -> None:
    """Placed by the first frame; a step aside later is seen as a step."""
    take = demonstrate(seed=3)
    placement = Placement.of(take[0])
    moved = take[0].positions + np.array([0.5, 0.0, 0.0])  # to the right of who faces the sensor
    step = placement.place(moved) - placement.place(take[0].positions)
    np.testing.assert_allclose(step, np.tile((0.0, -0.5, 0.0), (25, 1)), atol=1e-12)


def test_guessed_joints_are_pale() -> None:
    tracking = all_tracked()
    tracking[Joint.WRIST_LEFT] = Tracking.INFERRED
    colors = joint_colors(Skeleton(0.0, np.zeros((25, 3)), tracking))
    assert colors[Joint.WRIST_LEFT].sum() > colors[Joint.HAND_LEFT].sum()
    assert len(np.unique(colors, axis=0)) == 2


def test_each_sign_has_its_color_and_its_word() -> None:
    signs = (HandState.LASSO, HandState.OPEN, HandState.CLOSED)
    assert len({HAND[sign] for sign in (*signs, HandState.UNKNOWN)}) == 4
    assert hand_words(Hand(HandState.NOT_TRACKED).state) == "left hand: NOT TRACKED"
