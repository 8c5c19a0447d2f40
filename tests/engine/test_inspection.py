import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.engine.calibration import calibrate_at
from studio.engine.errors import FileError
from studio.engine.follow import follow
from studio.engine.inspection import inspect_file, inspect_recording
from studio.engine.mcap_file import write_recording
from studio.engine.motion_measures import measure_arm
from studio.engine.motion_report import motion_dict
from studio.engine.pipeline import Pipeline
from studio.engine.problems import duplicate_frames
from studio.engine.recorded import Recorded
from studio.engine.robot import load_robot
from studio.engine.skeleton import Hand, HandState, Joint, Skeleton
from studio.engine.sources import read_skeletons, write_skeletons
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.recording import SkeletonRecording, from_skeletons
from tests.engine.people import hanging

REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "kinect"
needs_real = pytest.mark.skipif(not REAL.is_dir(), reason=f"no real recordings at {REAL}")
KEYS = [
    "format",
    "frames",
    "seconds",
    "bodies",
    "left_hand",
    "right_hand",
    "tracking",
    "duplicate_frames",
    "dropped_frames",
    "gate",
    "mirrored",
    "lean_deg",
    "motion",
    "person",
    "problems",
    "recorded",
]


def skeletons(count: int = 6) -> list[Skeleton]:
    """Hand states and tracking states in turn; one body goes, a second later another one comes."""
    rng = np.random.default_rng(1)
    states = list(HandState)
    return [
        Skeleton(
            index / 30 + (index > 3),
            rng.normal(size=(25, 3)),
            [0] * 5 + [1] * 8 + [2] * 12,
            Hand(states[index % 5]),
            Hand(HandState.CLOSED),
            "b" if index > 3 else "a",
        )
        for index in range(count)
    ]


def test_everything_is_counted(tmp_path):
    path = tmp_path / "a.jsonl"
    write_skeletons(path, skeletons())
    told = inspect_file(path).to_dict()
    assert list(told) == KEYS
    assert told["format"] == "studio jsonl 1"
    assert told["frames"] == 6
    assert told["seconds"] == pytest.approx(1 + 5 / 30)
    assert told["bodies"] == [{"id": "a", "frames": 4}, {"id": "b", "frames": 2}]
    assert told["left_hand"] == {
        "unknown": 2,
        "not_tracked": 1,
        "open": 1,
        "closed": 1,
        "lasso": 1,
    }
    assert told["right_hand"]["closed"] == 6
    assert told["tracking"] == {"tracked": 72, "inferred": 48, "not_tracked": 30}
    assert any("2 bodies" in problem for problem in told["problems"])
    assert (told["duplicate_frames"], told["dropped_frames"]) == (0, 30)
    assert told["gate"]["armed"] == []
    assert [arm["arm"] for arm in told["motion"]] == ["left"]
    assert told["recorded"] is None
    assert json.loads(json.dumps(told, allow_nan=False)) == told


def test_only_the_followed_body_is_counted(tmp_path):
    path = tmp_path / "a.jsonl"
    write_skeletons(path, skeletons())
    told = inspect_file(path, body="b").to_dict()
    assert told["frames"] == 6
    assert sum(told["left_hand"].values()) == 2
    assert told["bodies"] == [{"id": "a", "frames": 4}, {"id": "b", "frames": 2}]


def test_a_file_and_its_recording_give_the_same(tmp_path):
    path = tmp_path / "a.jsonl"
    write_skeletons(path, skeletons())
    direct = inspect_recording(from_skeletons(skeletons(), str(path), "studio jsonl 1"))
    assert direct.to_dict() == inspect_file(path).to_dict()


def test_the_text_says_what_the_numbers_say(tmp_path):
    inspection = inspect_recording(from_skeletons(skeletons(), "demonstrator:1", "demonstrator"))
    text = str(inspection)
    assert text.startswith("demonstrator:1: demonstrator, 6 frames, 1.17 s\n")
    assert "a (4 frames), b (2 frames)" in text
    assert "unknown 2, not tracked 1, open 1, closed 1, lasso 1" in text
    assert "tracked 72, inferred 48, not tracked 30" in text
    assert all(problem in text for problem in inspection.problems)


def test_one_frame_and_nobody(tmp_path):
    one = inspect_recording(from_skeletons(skeletons(1), "x", "x"))
    assert (one.frames, one.seconds) == (1, 0.0)
    path = tmp_path / "nobody"
    path.write_text('{"skeleton": 1, "time": 3}\n{"skeleton": 1, "time": 4}\n')
    nobody = inspect_file(path)
    assert (nobody.frames, nobody.seconds, nobody.bodies) == (2, 1.0, {})
    assert set(nobody.left_hand.values()) == {0}
    assert nobody.problems == ("nobody is seen in this file",)
    assert nobody.motion == ()


def test_the_asked_arm_is_measured_with_the_asked_mapping():
    take = demonstrate(0, 1)
    found = inspect_recording(take, "both", "paper")
    assert [(arm.side, arm.mapping) for arm in found.motion] == [
        ("left", "paper"),
        ("right", "paper"),
    ]
    assert found.motion[0].flips == measure_arm(take, "left", "paper").flips
    assert "right arm, paper mapping, as if the gate were open:" in str(found)
    ((first, last),) = found.gate.armed
    assert found.gate.armed_frames == last - first + 1 > 150


def test_a_recording_tells_what_happened_in_it(tmp_path):
    recording = follow(demonstrate(0, 1), Pipeline.for_robot(load_robot(), "left", "paper"))
    write_recording(tmp_path / "a.mcap", recording)
    found = inspect_file(tmp_path / "a.mcap")
    assert found.motion[0].mapping == "paper"  # the recording's own
    assert inspect_file(tmp_path / "a.mcap", mapping="exact").motion[0].mapping == "exact"
    told = found.to_dict()["recorded"]
    assert told == json.loads(json.dumps(Recorded.of(recording).to_dict()))
    assert told["gate"]["armed_frames"] == sum(each.gate.armed for each in recording.samples)
    assert told["limited_ticks"] == sum(each.limited for each in recording.samples)
    assert "as recorded, left arm, paper mapping:" in str(found)


_OTHER = {"LEFT": "RIGHT", "RIGHT": "LEFT"}
_SWAP = re.compile("LEFT|RIGHT")


def in_a_mirror(seen: Skeleton) -> Skeleton:
    """Return the person whom a mirror shows: left is right."""
    order = [Joint[_SWAP.sub(lambda side: _OTHER[side[0]], joint.name)] for joint in Joint]
    positions = seen.positions[order] * [-1.0, 1.0, 1.0]
    return replace(
        seen,
        positions=positions,
        tracking=seen.tracking[order],
        left_hand=seen.right_hand,
        right_hand=seen.left_hand,
    )


def kept(path: Path, stream: SkeletonRecording, mirrored: bool, lean: bool, **options) -> Path:
    """Write what a robot did that follows a stream, the gate open."""
    calibration = calibrate_at(stream, 0.0) if lean else None
    pipeline = Pipeline.for_robot(
        load_robot(), "left", "exact", "open", mirrored, calibration, **options
    )
    write_recording(path, follow(stream, pipeline))
    return path


def test_a_recording_made_in_a_mirror_is_measured_in_one(tmp_path):
    """Two roads: the mirror's arm, and the other arm of the person whom the mirror shows."""
    take = demonstrate(0, 1)
    image = from_skeletons(map(in_a_mirror, take), "image", "test")
    path = kept(tmp_path / "a.mcap", image, mirrored=True, lean=False)
    found = inspect_file(path)
    plain = inspect_recording(take, "left")
    told, other = motion_dict(found.motion[0]), motion_dict(plain.motion[0])
    for key in ("ticks", "inside_limits", "e0_flips", "velocity_limit", "lag_ms", "jitter_mm"):
        assert told[key] == pytest.approx(other[key])
    assert found.mirrored
    assert found.to_dict()["recorded"]["mirrored"]
    assert "left arm, exact mapping, mirrored, as if the gate were open:" in str(found)
    write_skeletons(tmp_path / "image.jsonl", image)
    asked = inspect_file(tmp_path / "image.jsonl", mirrored=True)
    assert motion_dict(asked.motion[0]) == motion_dict(
        inspect_recording(image, mirrored=True).motion[0]
    )
    assert motion_dict(asked.motion[0]) != motion_dict(inspect_recording(image).motion[0])


def leaning(lean: float) -> SkeletonRecording:
    """Return somebody who stands for two seconds, then swings both arms forward and back."""
    swings = [0.0] * 62 + [1.4 * math.sin(i / 15) ** 2 for i in range(120)]
    people = [hanging(i / 30, lean, swing=swing) for i, swing in enumerate(swings)]
    return from_skeletons(people, f"leans {lean}", "test")


def test_a_calibrated_recording_is_measured_calibrated(tmp_path):
    """Two roads: the lean taken away, and nobody who leans."""
    upright = inspect_recording(leaning(0.0))
    path = kept(tmp_path / "a.mcap", leaning(0.2), mirrored=False, lean=True)
    write_skeletons(tmp_path / "a.jsonl", leaning(0.2))
    for found in (inspect_file(path), inspect_file(tmp_path / "a.jsonl", calibrate_at=0.0)):
        assert found.calibration.lean == pytest.approx(0.2, abs=1e-9)
        assert found.to_dict()["lean_deg"] == pytest.approx(math.degrees(0.2))
        assert "exact mapping, torso leans 11°: corrected, as if" in str(found)
        told, other = motion_dict(found.motion[0]), motion_dict(upright.motion[0])
        assert told["position_limits"] == [
            {key: value if key == "joint" else pytest.approx(value, abs=1e-6)
             for key, value in limit.items()}
            for limit in other["position_limits"]
        ]  # fmt: skip
        hangs = [[p for p in each.problems if "hangs below" in p] for each in (found, upright)]
        assert hangs[0] == hangs[1]
    crooked = inspect_recording(leaning(0.2))
    assert motion_dict(crooked.motion[0]) != motion_dict(upright.motion[0])
    with pytest.raises(FileError, match=r"a\.jsonl, 2\.5 s into it: calibration: you moved"):
        inspect_file(tmp_path / "a.jsonl", calibrate_at=2.5)


def test_the_body_asked_for_is_followed_in_a_recording_too(tmp_path):
    people = [hanging(i / 30) for i in range(20)]
    people += [replace(hanging(i / 30), body_id="b") for i in range(20, 50)]
    path = kept(tmp_path / "a.mcap", from_skeletons(people, "two", "test"), False, False)
    with pytest.raises(FileError, match=r"a\.mcap: expected a body.* not 'nobody'; seen: 0, b"):
        inspect_file(path, body="nobody")
    assert sum(inspect_file(path, body="0").left_hand.values()) == 20
    assert sum(inspect_file(path, body="b").left_hand.values()) < 31


@pytest.mark.parametrize("scale", [1e3, 1e200, 1e307])
def test_skeletons_of_any_size_are_inspected(scale):
    wild = [replace(each, positions=scale * each.positions) for each in skeletons()]
    found = inspect_recording(from_skeletons(wild, "x", "x"))
    assert json.dumps(found.to_dict(), allow_nan=False)
    assert str(found)


def test_a_stream_of_many_hours_is_measured_at_its_beginning():
    late = [replace(each, time=20_000.0 * index) for index, each in enumerate(skeletons())]
    found = inspect_recording(from_skeletons(late, "x", "x"))
    assert "the first 10 minutes" in str(found)
    assert found.frames == 6


@needs_real
def test_known_counts_of_a_real_recording():
    path = REAL / "kinect2-socket" / "hands_gestures.json.gz"
    inspection = inspect_file(path)
    assert inspection.frames == 535
    assert inspection.left_hand == {
        "unknown": 63,
        "not_tracked": 25,
        "open": 167,
        "closed": 201,
        "lasso": 79,
    }
    assert duplicate_frames(read_skeletons(path)).sum() == 62
    assert not any("never arms" in problem for problem in inspection.problems)
    assert inspection.duplicates == 62
    assert abs(inspection.gate.armed[0][0] - 485) <= 3
    assert inspection.gate.armed_frames == pytest.approx(50, abs=3)


@needs_real
@pytest.mark.parametrize("name", ["kinect2-socket/test_record.json", "labanotation/joints.csv"])
def test_real_recordings_that_never_arm_say_so(name):
    problems = " ".join(inspect_file(REAL / name).problems)
    assert ("never arms" in problems) != ("--gate open" in problems)


@needs_real
def test_every_real_file_is_inspected_or_refused_in_words():
    files = [path for path in REAL.rglob("*") if path.is_file() and path.suffix != ".md"]
    refused = []
    for path in files:
        try:
            inspection = inspect_file(path)
        except FileError:
            refused.append(path.parent.name)
        else:
            assert inspection.frames == sum(inspection.left_hand.values())
            assert sum(inspection.tracking.values()) == 25 * inspection.frames
    assert files
    assert refused == []
