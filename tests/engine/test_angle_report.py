"""The paper's angles over a recording: those of the person's arm that is asked for."""

import json
import math
import re
from dataclasses import replace

import pytest

from studio.engine.angle_report import NAMES, angle_ranges
from studio.engine.human import human_arm_angles
from studio.engine.inspection import inspect_recording
from studio.engine.skeleton import Joint, Tracking
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.recording import SkeletonRecording, from_skeletons
from tests.engine.people import person


def bending(frames: int = 101) -> SkeletonRecording:
    """Return somebody whose left elbow opens from 90° to 180°, a straight arm."""
    turns = [math.pi / 2 * i / (frames - 1) for i in range(frames)]
    arms = [((1.0, 0.0, 0.0), (math.sin(t), 0.0, math.cos(t))) for t in turns]
    return from_skeletons([person(i / 30, arm) for i, arm in enumerate(arms)], "x", "x")


def test_percentiles_of_an_elbow_that_opens() -> None:
    found = angle_ranges(bending(), "left")
    low, high = map(math.degrees, found.ranges["elbow_pitch"])
    assert (low, high) == (pytest.approx(94.5), pytest.approx(175.5))
    assert re.search(r"elbow pitch 9[45]° to 17[56]°, elbow roll", str(found))
    assert "hand_yaw" in found.ranges
    still = angle_ranges(bending(), "right").ranges["elbow_pitch"]
    assert still[0] == pytest.approx(still[1])


def test_every_angle_lies_between_its_percentiles_or_outside_for_one_frame_in_ten() -> None:
    take = demonstrate(0, 1)
    found = angle_ranges(take, "left")
    assert found.frames == len(take)
    assert tuple(found.ranges) == NAMES
    for name, (low, high) in found.ranges.items():
        angles = [getattr(human_arm_angles(each, "left"), name) for each in take]
        inside = sum(low <= angle <= high for angle in angles)
        assert inside == pytest.approx(0.9 * len(take), abs=2)


def test_what_is_not_seen_is_not_told() -> None:
    unseen = person().tracking.copy()
    unseen[Joint.THUMB_LEFT] = Tracking.NOT_TRACKED
    lost = from_skeletons([replace(each, tracking=unseen) for each in bending()], "x", "x")
    found = angle_ranges(lost, "left")
    assert (found.frames, found.ranges, str(found)) == (0, {}, "never seen whole")
    told = found.to_dict()
    assert told["elbow_pitch_deg"] is None
    assert json.loads(json.dumps(told, allow_nan=False)) == told
    assert angle_ranges(lost, "right").frames == 101


def test_an_inspection_tells_the_arm_that_the_robots_follows() -> None:
    plain, mirrored = (inspect_recording(bending(), "left", mirrored=m) for m in (False, True))
    assert [each.side for each in plain.angles] == ["left"]
    assert [each.side for each in mirrored.angles] == ["right"]
    assert "person      right arm, 5th to 95th percentile: shoulder yaw" in str(mirrored)
    assert plain.to_dict()["person"][0]["elbow_pitch_deg"][0] == pytest.approx(94.5)
    both = inspect_recording(bending(), "both", mirrored=True)
    assert [each.side for each in both.angles] == ["right", "left"]
