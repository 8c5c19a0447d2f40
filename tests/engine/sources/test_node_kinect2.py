import json

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.sources.node_kinect2 import read, read_list


def ids(parsed):
    return [[body.body_id for body in frame.bodies] for frame in parsed.frames]


def test_lines_are_frames_at_thirty_a_second(made):
    messages = [made.node_message([made.skeleton(0, "a"), made.skeleton(0, "b")])]
    messages += [made.node_message([]), made.node_message([made.skeleton(2, "b")])]
    parsed = read([json.dumps(messages[0]), "", *map(json.dumps, messages[1:])])
    assert ids(parsed) == [["a", "b"], [], ["b"]]
    assert [frame.time for frame in parsed.frames] == [0, 1 / 30, 2 / 30]
    assert (parsed.format, parsed.has_hand_states) == ("node-kinect2", True)
    assert (parsed.has_tracking, parsed.has_stamps) == (True, False)
    assert np.array_equal(parsed.frames[0].bodies[1].tracking, made.skeleton(0).tracking)


def test_a_kinectron_recording_has_stamps_and_no_tracking(made):
    people = [made.skeleton(frame) for frame in (0, 1, 4)]
    parsed = read_list(json.dumps(made.kinectron_list(people)))
    assert [frame.time for frame in parsed.frames] == [0.0, 0.033, 0.133]
    assert (parsed.format, parsed.has_hand_states) == ("kinectron", True)
    assert (parsed.has_tracking, parsed.has_stamps) == (False, True)


def stamped(made, *stamps):
    """A recording of bodies told by (name, ms)."""
    body = made.node_body(made.skeleton(0), tracking=False)
    return [
        body | {"trackingId": name, "record_startime": 5_000, "record_timestamp": time}
        for name, time in stamps
    ]


def test_bodies_sent_together_are_one_frame(made):
    entries = stamped(made, ("a", 11), ("b", 12), ("a", 44), ("a", 45), ("b", 78), ("a", 79))
    entries += stamped(made, ("b", 111), ("a", 125))
    parsed = read_list(json.dumps(entries))
    assert ids(parsed) == [["a", "b"], ["a"], ["a"], ["b", "a"], ["b"], ["a"]]
    times = [0.011, 0.044, 0.045, 0.078, 0.111, 0.125]
    assert [frame.time for frame in parsed.frames] == times
    for frame in parsed.frames:
        assert all(body.time == frame.time for body in frame.bodies)


def test_recordings_one_after_the_other_share_a_clock(made):
    first, second = stamped(made, ("a", 0), ("a", 900))
    second["record_startime"] = 15_000
    parsed = read_list(json.dumps([first, second]))
    assert [frame.time for frame in parsed.frames] == [0.0, 10.9]


def test_whole_frames_may_be_recorded_too(made):
    frames = [
        made.node_message([made.skeleton(0, "a"), made.skeleton(0, "b")])
        | {"record_startime": 0, "record_timestamp": time}
        for time in (5, 9)
    ]
    parsed = read_list(json.dumps(frames))
    assert ids(parsed) == [["a", "b"], ["a", "b"]]
    assert [frame.time for frame in parsed.frames] == [0.005, 0.009]
    bare = read_list(json.dumps([made.node_message([made.skeleton(0)])] * 2))
    assert [frame.time for frame in bare.frames] == [0.0, 1 / 30]
    assert not bare.has_stamps


def test_a_file_without_hand_states_says_so(made):
    body = made.node_body(made.skeleton(0))
    del body["leftHandState"], body["rightHandState"]
    assert not read([json.dumps(body)]).has_hand_states


@pytest.mark.parametrize(
    ("stamps", "words"),
    [
        ((("a", 9), ("a", 8)), "entry 1: the time goes backwards"),
        ((("a", 9), ("a", None)), 'entry 1: expected "record_timestamp" as a finite number'),
        ((("a", 9), ("", 10)), "entry 1: body 0: .*printable"),
        ((("a", 1e18),), "entry 0: expected a time in seconds"),
    ],
)
def test_whatever_is_wrong_is_named_with_its_entry(made, stamps, words):
    with pytest.raises(StudioError, match=words):
        read_list(json.dumps(stamped(made, *stamps)))


def test_a_line_cut_off_is_named(made):
    lines = [json.dumps(made.node_message([made.skeleton(0)]))] * 2
    with pytest.raises(StudioError, match=r"line 2: column \d+: .*cut off"):
        read([lines[0], lines[1][:-9]])
