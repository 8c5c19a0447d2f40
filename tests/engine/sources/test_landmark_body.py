import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.skeleton import SIDES, Joint, Tracking
from studio.engine.sources import landmark_body
from studio.engine.sources.landmark_body import (
    FIELD_OF_VIEW,
    joints_of,
    landmark,
    place_of,
    to_camera_space,
    tracking_of,
)

SEEN = np.ones(33)
SIZE = np.array([640.0, 480.0])


def people(seed: int) -> np.ndarray:
    """World landmarks (33, 3) [m] of somebody about as large as a person."""
    return np.random.default_rng(seed).normal(size=(33, 3)) * [0.2, 0.5, 0.15]


def picture_of(world: np.ndarray, place: np.ndarray, size: np.ndarray = SIZE) -> np.ndarray:
    """Where a pinhole sees the landmarks: similar triangles, in halves of the longer side."""
    at = world + place
    half = max(size) / 2
    pixels = size / 2 + half * at[:, :2] / at[:, 2:] / math.tan(FIELD_OF_VIEW / 2)
    return pixels / size


places = st.tuples(st.floats(-0.5, 0.5), st.floats(-0.3, 0.3), st.floats(1.5, 6.0)).map(np.array)


@settings(deadline=None, derandomize=True, max_examples=50)
@given(st.integers(0, 1000), places, st.sampled_from([(640, 480), (1280, 720), (480, 640)]))
def test_who_is_projected_is_found_where_they_stood(seed, place, size):
    world, size = people(seed), np.array(size, dtype=float)
    picture = picture_of(world, place, size)
    if np.logical_and(picture >= 0, picture <= 1).all(axis=1).sum() > 6:
        assert np.allclose(place_of(world, SEEN, picture, size), place, atol=1e-6)


def test_what_is_hidden_or_outside_does_not_count():
    world, place = people(1), np.array([0.1, -0.1, 2.5])
    picture = picture_of(world, place)
    visibility = SEEN.copy()
    visibility[:8] = 0.2
    picture[:8] = 0.9
    picture[20:] = -3.0
    assert np.allclose(place_of(world, visibility, picture, SIZE), place)


@pytest.mark.parametrize(
    "picture",
    [
        None,
        np.full((33, 2), 0.5),  # one point
        np.full((33, 2), 2.0),  # all outside
        picture_of(people(2), np.array([0.0, 0.0, 40.0])),  # farther than any room
        1.0 - picture_of(people(2), np.array([0.0, 0.0, 3.0])),  # upside down, so behind
    ],
)
def test_a_degenerate_fit_puts_the_person_at_the_usual_distance(picture):
    place = place_of(people(2), SEEN, picture, SIZE)
    assert place[2] == landmark_body.USUAL_DISTANCE
    assert np.abs(place[:2]).max() < 1.0


def test_the_way_aside_shows_even_where_the_depth_does_not():
    """A dot in the left of the picture is somebody on the left."""
    picture = np.full((33, 2), 0.25)
    assert place_of(people(2), SEEN, picture, SIZE)[0] < -0.3


@settings(deadline=None, derandomize=True, max_examples=30)
@given(st.integers(0, 1000))
def test_joints_turn_and_move_with_the_landmarks(seed):
    world = people(seed)
    assert np.allclose(joints_of(world + 5.0), joints_of(world) + 5.0)
    assert np.allclose(to_camera_space(joints_of(world)), joints_of(to_camera_space(world)))


def test_camera_space_is_right_handed_and_upright():
    x, y, z = to_camera_space(np.eye(3))
    assert np.allclose(np.cross(x, y), z)
    assert (y == [0, -1, 0]).all()


def test_left_is_left():
    """By MediaPipe's published numbers."""
    numbers = {"shoulder": 11, "elbow": 13, "wrist": 15, "hip": 23, "knee": 25, "ankle": 27}
    world = people(3)
    joints = joints_of(world)
    for part, number in numbers.items():
        for side in SIDES:
            at = number + (side == "right")
            assert landmark(part, side) == at
            assert (joints[Joint.of(part, side)] == world[at]).all()
    assert (joints[Joint.FOOT_LEFT] == world[31]).all()
    assert (joints[Joint.THUMB_RIGHT] == world[22]).all()
    assert np.allclose(joints[Joint.SPINE_BASE], (world[23] + world[24]) / 2)
    assert np.allclose(joints[Joint.HEAD], (world[7] + world[8]) / 2)


def test_visibility_is_tracking():
    visibility = np.zeros(33)
    visibility[[11, 12]], visibility[13], visibility[15] = 0.5, 0.1, 0.0999
    states = tracking_of(visibility, None)
    assert states[Joint.SHOULDER_LEFT] == states[Joint.SPINE_SHOULDER] == Tracking.TRACKED
    assert states[Joint.ELBOW_LEFT] == Tracking.INFERRED
    assert states[Joint.WRIST_LEFT] == states[Joint.HAND_LEFT] == Tracking.NOT_TRACKED
    assert states[Joint.KNEE_LEFT] == Tracking.NOT_TRACKED


def test_what_is_outside_of_the_picture_is_inferred_at_best():
    picture = np.full((33, 2), 0.5)
    picture[15] = [0.5, 1.01]
    states = tracking_of(SEEN, picture)
    assert states[Joint.WRIST_LEFT] == Tracking.INFERRED
    assert states[Joint.WRIST_RIGHT] == Tracking.TRACKED


def test_somebody_at_a_desk_has_a_spine():
    """Hips and legs are out of sight; the arm needs the spine."""
    visibility = np.where(np.arange(33) >= 23, 0.01, 0.99)
    states = tracking_of(visibility, None)
    assert states[Joint.SPINE_BASE] == states[Joint.SPINE_MID] == Tracking.INFERRED
    assert states[Joint.HIP_LEFT] == states[Joint.ANKLE_LEFT] == Tracking.NOT_TRACKED
    visibility[11] = 0.0  # a shoulder lost
    assert tracking_of(visibility, None)[Joint.SPINE_BASE] == Tracking.NOT_TRACKED
