import json
import math

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.human import ArmVectors, arm_vectors
from studio.engine.skeleton import SIDES, HandState, Joint, Tracking
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.landmark_body import FIELD_OF_VIEW, landmark
from studio.engine.sources.landmarks import bodies_from_landmarks, read, read_list

PARTS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle", "foot", "thumb")


def seen_by_mediapipe(skeleton, width=640, height=480, visibility=0.99) -> dict:
    """What a perfect tracker would say of a Kinect's skeleton."""
    points = np.zeros((33, 3))
    for side in SIDES:
        for part in PARTS:
            points[landmark(part, side)] = skeleton.positions[Joint.of(part, side)]
        hand, wrist = (skeleton.positions[Joint.of(part, side)] for part in ("hand", "wrist"))
        knuckles = (3.0 * hand - wrist) / 2.0
        points[landmark("index_knuckle", side)] = knuckles + np.array([0.03, 0.0, 0.0])
        points[landmark("little_knuckle", side)] = knuckles - [0.03, 0.0, 0.0]
    points[:11] = skeleton.positions[Joint.HEAD]
    points[[29, 30]] = points[[27, 28]]
    focal = width / 2 / math.tan(FIELD_OF_VIEW / 2)
    across = width / 2 - focal * points[:, 0] / points[:, 2]  # the person's right is on the left
    down = height / 2 - focal * points[:, 1] / points[:, 2]
    world = (points - (points[23] + points[24]) / 2) * [-1, -1, 1]
    return {
        "format": "mediapipe-landmarks 1",
        "time": skeleton.time,
        "image": [width, height],
        "pose_world": np.column_stack([world, np.full(33, visibility)]).tolist(),
        "pose_image": np.column_stack([across / width, down / height]).tolist(),
        "left_hand": None,
        "right_hand": None,
    }


@pytest.fixture(scope="module")
def person():
    return demonstrate(0, 1)[150]


def test_a_kinects_skeleton_comes_back_through_the_picture(person):
    (back,) = bodies_from_landmarks(seen_by_mediapipe(person)).bodies
    exact = [Joint.of(part, side) for part in (*PARTS, "hand") for side in SIDES]
    assert np.allclose(back.positions[exact], person.positions[exact], atol=1e-9)
    assert np.linalg.norm(back.positions - person.positions, axis=1).max() < 0.15
    for side in SIDES:
        mine, given = (arm_vectors(each, side) for each in (back, person))
        assert isinstance(mine, ArmVectors)
        assert isinstance(given, ArmVectors)
        assert np.allclose(mine.upper_arm, given.upper_arm, atol=1e-9)
        assert np.dot(mine.torso.x, given.torso.x) > 0.98


def test_who_faces_the_camera_faces_the_camera(person):
    """The torso's forward axis points to the camera, and the left shoulder is on the left of it."""
    (back,) = bodies_from_landmarks(seen_by_mediapipe(person)).bodies
    torso = arm_vectors(back, "left").torso
    assert torso.x[2] < -0.9
    assert torso.z[1] > 0.9
    shoulders = back.positions[[Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT], 0]
    assert shoulders[0] < shoulders[1]


def test_only_the_upper_body_in_sight_is_enough_for_an_arm(person):
    message = seen_by_mediapipe(person)
    for row in message["pose_world"][23:]:
        row[3] = 0.01
    (back,) = bodies_from_landmarks(message).bodies
    assert isinstance(arm_vectors(back, "left"), ArmVectors)
    assert back.tracking[Joint.SPINE_BASE] == Tracking.INFERRED
    assert back.tracking[Joint.FOOT_LEFT] == Tracking.NOT_TRACKED


def open_hand() -> np.ndarray:
    """Landmarks (21, 3) in pixels: fingers straight up in the picture, side by side."""
    points = np.zeros((21, 3))
    for finger in range(5):
        for bone in range(4):
            points[1 + 4 * finger + bone] = [10 * finger - 20, -60 - 25 * bone, 0]
    return points + np.array([320, 300, 0])


def fist() -> np.ndarray:
    points = open_hand()
    for root in (5, 9, 13, 17):
        points[root + 1 : root + 4] = points[root] + [[0, 0, -30], [0, 20, -30], [0, 20, -10]]
    return points


def lasso() -> np.ndarray:
    return np.concatenate([open_hand()[:13], fist()[13:]])


def with_hands(person, left=None, right=None) -> dict:
    size = np.array([640, 480, 640])
    return seen_by_mediapipe(person) | {
        "left_hand": None if left is None else (left / size).tolist(),
        "right_hand": None if right is None else (right / size).tolist(),
    }


@pytest.mark.parametrize(
    ("shape", "state"),
    [(open_hand, HandState.OPEN), (fist, HandState.CLOSED), (lasso, HandState.LASSO)],
)
def test_hands_have_states_in_the_pictures_own_aspect(person, shape, state):
    (back,) = bodies_from_landmarks(with_hands(person, left=shape())).bodies
    assert back.left_hand.state is state
    assert back.left_hand.confidence > 0.6
    assert back.right_hand.state is HandState.NOT_TRACKED
    (back,) = bodies_from_landmarks(with_hands(person, right=shape())).bodies
    assert (back.left_hand.state, back.right_hand.state) == (HandState.NOT_TRACKED, state)


def test_a_hands_own_landmarks_place_its_tip_and_thumb(person):
    (plain,) = bodies_from_landmarks(with_hands(person)).bodies
    (back,) = bodies_from_landmarks(with_hands(person, left=open_hand())).bodies
    wrist, tip = back.positions[[Joint.WRIST_LEFT, Joint.HAND_TIP_LEFT]]
    assert (wrist == plain.positions[Joint.WRIST_LEFT]).all()
    assert np.allclose(tip - wrist, [0.0, 0.09 * 135 / 60, 0.0], atol=1e-9)  # up in the picture
    assert back.tracking[Joint.HAND_TIP_LEFT] == Tracking.TRACKED
    assert plain.tracking[Joint.HAND_TIP_LEFT] == Tracking.INFERRED
    assert back.positions[Joint.THUMB_LEFT][0] > wrist[0]  # left in the picture is +x
    right = [Joint.HAND_TIP_RIGHT, Joint.THUMB_RIGHT, Joint.HAND_RIGHT]
    assert (back.positions[right] == plain.positions[right]).all()


def test_time_is_the_messages_own_unless_told(person):
    message = seen_by_mediapipe(person)
    assert bodies_from_landmarks(message).time == person.time
    told = bodies_from_landmarks(message, 7.25)
    assert (told.time, told.bodies[0].time) == (7.25, 7.25)
    del message["time"]
    assert bodies_from_landmarks(message, 7.25).time == 7.25
    with pytest.raises(StudioError, match='"time" as a finite number'):
        bodies_from_landmarks(message)


def test_nobody_is_a_frame_with_nobody():
    message = {"format": "mediapipe-landmarks 1", "time": 1.5, "pose_world": None}
    assert bodies_from_landmarks(message).bodies == ()
    assert bodies_from_landmarks({"poseWorldLandmarks": [], "time": 2}).bodies == ()


def test_javascripts_results_say_the_same(person, made):
    message = with_hands(person, left=fist())
    script = made.in_javascript(message)
    (ours,) = bodies_from_landmarks(message).bodies
    nested = script | {key: [value] for key, value in script.items() if value}
    for each in (script, nested):
        (theirs,) = bodies_from_landmarks(each, 3.0).bodies
        assert (theirs.positions == ours.positions).all()
        assert (theirs.tracking == ours.tracking).all()
        assert theirs.left_hand == ours.left_hand
        assert theirs.right_hand.state is HandState.NOT_TRACKED


def test_a_pose_without_hands_tells_no_hand_states(person):
    message = seen_by_mediapipe(person)
    del message["left_hand"], message["right_hand"]
    assert not read([json.dumps(message)]).has_hand_states
    assert read([json.dumps(with_hands(person, fist()))]).has_hand_states


def test_a_file_is_its_lines(made):
    files = made.landmark_files()
    ours = read(files["lines"].decode().split("\n"))
    theirs = read(files["JavaScript's lines"].decode().split("\n"))
    listed = read_list(files["JavaScript's list"].decode())
    assert (ours.has_stamps, theirs.has_stamps, listed.has_stamps) == (True, False, False)
    for parsed in (ours, theirs, listed):
        assert [frame.time for frame in parsed.frames] == [0, 1 / 30, 2 / 30]
        assert parsed.has_tracking
        for frame, same in zip(parsed.frames, ours.frames, strict=True):
            assert (frame.bodies[0].positions == same.bodies[0].positions).all()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"format": "mediapipe-landmarks 2"}, '"format": "mediapipe-landmarks 1", found'),
        ({"pose_world": [[0, 0, 0, 1]] * 32}, '33 landmarks in "pose_world", found 32'),
        ({"pose_world": [[0, 0, 0, 1]] * 32 + [[0, 0]]}, '"pose_world", 32: expected 3 coord'),
        ({"pose_world": [[0, 0, 0, 1]] * 32 + [[0, 0, "a", 1]]}, "32: a coordinate.*\"?'a'"),
        ({"pose_world": [[0, 0, 1e300, 1]] * 33}, "coordinates up to 100"),
        ({"pose_world": [{"x": 0, "y": 0}] * 33}, "found None"),
        ({"pose_world": 5}, '"pose_world" as a list'),
        ({"pose_image": [[0, 0]] * 20}, '33 landmarks in "pose_image"'),
        ({"image": [640]}, '"image" as a width and a height'),
        ({"image": [0, 480]}, '"image" as a width and a height'),
        ({"left_hand": [[0, 0, 0]] * 20}, '21 landmarks in "left_hand"'),
        ({"time": math.nan}, '"time" as a finite number'),
    ],
)
def test_whatever_is_wrong_is_named_with_its_place(made, change, words):
    good = made.landmark_line(0.0)
    with pytest.raises(StudioError, match=words):
        bodies_from_landmarks(good | change)
    with pytest.raises(StudioError, match=f"line 2: .*{words}"):
        read([json.dumps(good), json.dumps(good | change)])


def test_a_message_without_a_pose_is_refused():
    with pytest.raises(StudioError, match='expected "pose_world"'):
        bodies_from_landmarks({"time": 1.0})


def test_time_never_runs_backwards(made):
    lines = [json.dumps(made.landmark_line(time)) for time in (1.0, 0.5)]
    with pytest.raises(StudioError, match="line 2: the time goes backwards"):
        read(lines)
