import math
from collections.abc import Sequence

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.skeleton import Joint, Skeleton, all_tracked
from studio.engine.sources.family import Frame, ParsedFile
from studio.engine.sources.recording import SkeletonRecording, follow, from_skeletons


def body(name: str, x: float, z: float, time: float = 0.0) -> Skeleton:
    positions = np.zeros((25, 3))
    positions[Joint.SPINE_MID] = x, 5.0, z  # the height must not count
    return Skeleton(time, positions, all_tracked(), body_id=name)


def parsed(*frames: list[Skeleton]) -> ParsedFile:
    listed = [Frame(index / 30, tuple(bodies)) for index, bodies in enumerate(frames)]
    return ParsedFile("made up", listed, True, True, True)


def names(recording: SkeletonRecording) -> list[str]:
    return [skeleton.body_id for skeleton in recording]


def test_who_is_followed_frame_by_frame():
    far, near = body("far", 0.1, 3.0), body("near", 0.0, 2.0)
    recording = follow(parsed([far, near], [], [far], [near, far]), "a.json")
    assert names(recording) == ["near", "near"]
    assert recording.frame_indices.tolist() == [0, 3]
    assert recording.frames == 4
    assert recording.seconds == pytest.approx(3 / 30)


def test_the_body_asked_for_is_the_only_one():
    recording = follow(parsed([body("a", 0, 1), body("b", 0, 2)], [body("a", 0, 1)]), "a.json", "b")
    assert names(recording) == ["b"]
    assert recording.bodies == {"a": 2, "b": 1}
    assert [(time, seen is not None) for time, seen in recording.by_frame()] == [
        (0.0, True),
        (1 / 30, False),
    ]


def test_an_unknown_body_is_an_error_that_lists_the_known():
    with pytest.raises(StudioError, match="not 'c'; seen: a, b"):
        follow(parsed([body("b", 0, 1), body("a", 0, 2)]), "a.json", "c")


def test_a_recording_is_a_sequence_that_nobody_can_change():
    recording = follow(parsed([body("a", 0, 1)], [body("a", 0, 2)]), "a.json")
    assert isinstance(recording, Sequence)
    assert recording[1] is list(recording)[1] is recording[-1] is recording[1:][0]
    with pytest.raises(IndexError):
        recording[2]
    with pytest.raises(ValueError, match="read-only"):
        recording.frame_times[0] = 1.0
    with pytest.raises(AttributeError):
        recording.path = "b"


def test_frames_with_nobody_make_a_recording_without_skeletons():
    recording = follow(parsed([], []), "a.json")
    assert (len(recording), recording.frames, recording.bodies) == (0, 2, {})


def test_skeletons_from_elsewhere_become_a_recording():
    recording = from_skeletons(
        [body("a", 0, 1, 5.0), body("a", 0, 1, 5.0), body("b", 0, 2, 5.0)], "demo:1", "demo"
    )
    assert (recording.path, recording.format) == ("demo:1", "demo")
    assert recording.frame_times.tolist() == [5.0, 5.0]  # the second a starts a new frame, with b
    assert recording.bodies == {"a": 2, "b": 1}
    assert not recording.has_hand_states  # nothing but unknown


def test_time_that_runs_backwards_is_refused():
    with pytest.raises(StudioError, match="backwards"):
        from_skeletons([body("a", 0, 1, 5.0), body("a", 0, 1, math.nextafter(5.0, 0))], "x", "x")
