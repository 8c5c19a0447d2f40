"""Each protocol is told by its message, and what we encode is what is read."""

import json

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.live.player import encoder
from studio.engine.live.protocols import PROTOCOLS, detect, read_objects
from studio.engine.sources.family import Frame
from tests.engine.live.streaming import demonstrated, message

NAMES = {"jsonl": "studio jsonl", "node-kinect2": "node-kinect2", "kinectron": "Kinectron"}
LANDMARKS = {
    "format": "mediapipe-landmarks 1",
    "time": 3.5,
    "image": [640, 480],
    "pose_world": None,
    "pose_image": None,
    "left_hand": None,
    "right_hand": None,
}


def read(text: str, arrival: float = 9.0) -> tuple[str, Frame, bool]:
    objects = read_objects(text)
    protocol = detect(objects[0])
    return protocol.name, protocol.read(objects, arrival), protocol.is_stamped(objects[0])


@pytest.mark.parametrize("kind", NAMES)
def test_what_is_sent_is_what_is_read(kind: str) -> None:
    sent = demonstrated()[40]
    name, frame, is_stamped = read(message(sent, kind))
    (before,), (after,) = sent.bodies, frame.bodies
    assert name == NAMES[kind]
    assert np.array_equal(before.positions, after.positions)
    assert np.array_equal(before.tracking, after.tracking)
    assert (before.left_hand.state, before.body_id) == (after.left_hand.state, after.body_id)
    assert is_stamped is (kind == "jsonl")
    assert frame.time == (sent.time if is_stamped else 9.0)


@pytest.mark.parametrize("kind", NAMES)
def test_nobody_is_a_frame_too(kind: str) -> None:
    assert read(encoder(kind)(Frame(1.0)))[1].bodies == ()


def test_landmarks_have_stamps_or_get_them() -> None:
    name, frame, is_stamped = read(json.dumps(LANDMARKS))
    assert (name, frame.time, is_stamped) == ("MediaPipe landmarks", 3.5, True)
    unstamped = {key: value for key, value in LANDMARKS.items() if key != "time"}
    _, frame, is_stamped = read(json.dumps(unstamped))
    assert (frame.time, is_stamped) == (9.0, False)


def test_one_body_alone_is_kinectrons() -> None:
    body = json.loads(message(demonstrated()[0], "kinectron"))["data"]["bodies"][0]
    assert read(json.dumps(body))[0] == "Kinectron"
    assert read(json.dumps({"event": "trackedBodyFrame", "data": body}))[0] == "Kinectron"


def test_several_lines_are_the_bodies_of_one_frame() -> None:
    first, later = demonstrated()[:2]
    (body,) = first.bodies
    line, other = message(first), json.dumps({**json.loads(message(first)), "body": "other"})
    assert {b.body_id for b in read(f"{line}\n{other}\n")[1].bodies} == {body.body_id, "other"}
    for wrong in (f"{line}\n{message(later)}", f"{line}\n{line}"):
        with pytest.raises(StudioError, match="one frame a message"):
            read(wrong)


@pytest.mark.parametrize(
    "text", ["", "[]", "null", "1", '"text"', "{}", '{"a": 1}', "{", b"\xff\xfe", "\n\n", "{}\n{}"]
)
def test_anything_else_is_refused_in_words(text) -> None:
    with pytest.raises(StudioError, match="expected"):
        read(text)


def test_every_protocol_has_a_name_of_its_own() -> None:
    assert len({protocol.name for protocol in PROTOCOLS}) == len(PROTOCOLS) == 4
