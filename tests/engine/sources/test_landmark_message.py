import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import StudioError
from studio.engine.sources.landmark_message import parse_landmarks

json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=8,
)


def test_what_was_written_is_what_is_read(made):
    message = made.landmark_line(0.0)
    seen = parse_landmarks(message)
    assert np.array_equal(seen.world, np.array(message["pose_world"])[:, :3])
    assert (seen.visibility == 1.0).all()
    assert np.array_equal(seen.picture, message["pose_image"])
    assert np.array_equal(seen.hands["left"], message["left_hand"])
    assert seen.hands["right"] is None
    assert seen.size.tolist() == [640, 480]


def test_what_is_left_out_is_assumed(made):
    message = made.landmark_line(0.0)
    bare = {"pose_world": [row[:3] for row in message["pose_world"]]}
    seen = parse_landmarks(bare)
    assert (seen.visibility == 1.0).all()
    assert (seen.picture, seen.hands, seen.size.tolist()) == (None, {}, [640, 480])


def test_visibility_is_kept_between_0_and_1(made):
    message = made.landmark_line(0.0)
    message["pose_world"][0][3], message["pose_world"][1][3] = -0.5, 1.5
    assert parse_landmarks(message).visibility[:2].tolist() == [0.0, 1.0]


@settings(deadline=None, derandomize=True, max_examples=150)
@given(
    st.sampled_from(
        ["format", "image", "pose_world", "pose_image", "left_hand", "poseWorldLandmarks"]
    ),
    st.integers(-1, 32),
    json_values,
)
def test_any_value_anywhere_is_read_or_refused(made, key, index, value):
    message = made.landmark_line(0.0)
    if index < 0 or not isinstance(message.get(key), list) or index >= len(message[key]):
        message[key] = value
    else:
        message[key][index] = value
    try:
        seen = parse_landmarks(message)
    except StudioError as error:
        assert str(error).isprintable()  # noqa: PT017 - either is fine
    else:
        assert seen is None or np.isfinite(seen.world).all()


def test_a_refusal_names_the_landmark(made):
    message = made.landmark_line(0.0)
    message["left_hand"][7] = [0.5, None, 0.1]
    with pytest.raises(StudioError, match=r'"left_hand", 7: a coordinate as a finite.*None'):
        parse_landmarks(message)
