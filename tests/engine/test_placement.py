"""Into the robot's world and back, without loss."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies
from hypothesis.extra import numpy as arrays

from studio.engine.placement import SPOT, WORLD_FROM_CAMERA, Placement
from studio.engine.skeleton import Joint, Skeleton, all_tracked
from studio.engine.sources.demonstrator import demonstrate

points = arrays.arrays(np.float64, (25, 3), elements=strategies.floats(-5.0, 5.0))


@given(points, points)
@settings(deadline=None, derandomize=True)
def test_there_and_back(positions, others) -> None:
    placement = Placement.of(Skeleton(0.0, positions, all_tracked()))
    assert placement.to_camera(placement.place(others)) == pytest.approx(others, abs=1e-12)
    assert placement.place(placement.to_camera(others)) == pytest.approx(others, abs=1e-12)


@given(points)
@settings(deadline=None, derandomize=True)
def test_anybody_stands_on_the_floor_beside_the_robot(positions) -> None:
    placed = Placement.of(Skeleton(0.0, positions, all_tracked())).place(positions)
    assert placed[:, 2].min() == pytest.approx(0.0, abs=1e-12)
    assert placed[Joint.SPINE_BASE, :2] == pytest.approx(np.array(SPOT), abs=1e-12)


def test_nobody_is_stretched_or_mirrored() -> None:
    np.testing.assert_allclose(WORLD_FROM_CAMERA @ WORLD_FROM_CAMERA.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(WORLD_FROM_CAMERA) == pytest.approx(1.0)


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
