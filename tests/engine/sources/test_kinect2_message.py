import json

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.sources.kinect2_message import bodies_from_message


def same_body(body, other) -> bool:
    """Whether all but the hands' confidence, which these messages do not tell, is equal."""
    return (
        np.array_equal(body.positions, other.positions)
        and np.array_equal(body.tracking, other.tracking)
        and all(body.hand(side).state is other.hand(side).state for side in ("left", "right"))
        and body.body_id == other.body_id
    )


def test_a_frame_is_what_was_written(made):
    people = [made.skeleton(0, "72057594037928243"), made.skeleton(3, "72057594037928244", z=3.0)]
    frame = bodies_from_message(made.node_message(people), 12.5)
    assert frame.time == 12.5
    assert [body.time for body in frame.bodies] == [12.5, 12.5]
    assert all(map(same_body, frame.bodies, people))


def test_kinectrons_envelopes_hold_the_same(made):
    body = made.skeleton(4)
    message = made.node_message([body])
    bare = made.node_body(body)
    wrapped = {"event": "bodyFrame", "data": message}
    followed = {"event": "trackedBodyFrame", "data": bare}
    for each in (message, wrapped, bare, followed, json.loads(json.dumps(wrapped))):
        (found,) = bodies_from_message(each, 0.0).bodies
        assert same_body(found, body)


def test_without_tracking_every_joint_passes(made):
    (body,) = bodies_from_message(made.node_body(made.skeleton(0), tracking=False), 0.0).bodies
    assert (body.tracking == 2).all()


def test_empty_seats_are_nobody(made):
    assert bodies_from_message(made.node_message([]), 1.0).bodies == ()
    assert bodies_from_message({"bodies": []}, 1.0).bodies == ()


@pytest.mark.parametrize(
    ("ids", "name"), [({"trackingId": "9"}, "9"), ({"bodyIndex": 4}, "4"), ({}, "0")]
)
def test_a_body_has_the_best_name_there_is(made, ids, name):
    body = made.node_body(made.skeleton(0))
    del body["trackingId"], body["bodyIndex"]
    assert bodies_from_message(body | ids, 0.0).bodies[0].body_id == name


def test_an_azure_kinects_body_is_called_by_name(made):
    azure = {"bodies": [{"id": 1, "bodyIndex": 0, "skeleton": {"joints": [{}] * 32}}]}
    with pytest.raises(StudioError, match=r"body 0: .*Azure Kinect"):
        bodies_from_message(azure, 0.0)


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ((), {"hello": 1}, '"bodies".*or "joints".*found an object with 1 keys'),
        (("bodies",), 5, '"bodies" as a list'),
        (("bodies", 0), None, "a body as an object"),
        (("bodies", 0, "joints"), [], "body 0: expected 25 joints, found 0"),
        (("bodies", 0, "joints", 6), {"cameraX": 0}, r"body 0: joint 6 \(wrist_left\).*cameraZ"),
        (
            ("bodies", 0, "joints", 6, "cameraY"),
            None,
            r"joint 6 .*y as a finite number, found None",
        ),
        (("bodies", 0, "joints", 6, "cameraY"), float("nan"), "found nan"),
        (("bodies", 0, "joints", 6, "trackingState"), 3, '"trackingState" 0, 1 or 2, found 3'),
        (("bodies", 0, "joints", 6, "jointType"), 7, '"jointType" 6.*order, found 7'),
        (("bodies", 0, "leftHandState"), 5, '"leftHandState" as 0 to 4'),
        (("bodies", 0, "trackingId"), "", "1 to 100 printable"),
        (("bodies", 0, "trackingId"), [], "trackingId.*whole number or text"),
        (("bodies", 1, "trackingId"), "a", "body 1: expected each id once in a frame, found a"),
    ],
)
def test_whatever_is_wrong_is_named_with_its_place(made, path, value, words):
    message = made.node_message([made.skeleton(0, "a"), made.skeleton(0, "b")])
    at = message
    for key in path[:-1]:
        at = at[key]
    if path:
        at[path[-1]] = value
    with pytest.raises(StudioError, match=words):
        bodies_from_message(message if path else value, 0.0)


def test_a_time_that_is_none_is_refused(made):
    with pytest.raises(StudioError, match="a time in seconds"):
        bodies_from_message(made.node_message([]), float("inf"))
