import json
from pathlib import Path

import numpy as np
import pytest

from studio.engine.errors import FileError
from studio.engine.inspection import inspect_file, inspect_recording
from studio.engine.problems import duplicate_frames
from studio.engine.skeleton import Hand, HandState, Skeleton
from studio.engine.sources import read_skeletons, write_skeletons
from studio.engine.sources.recording import from_skeletons

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
    "problems",
]


def skeletons(count: int = 6) -> list[Skeleton]:
    """Hand states and tracking states in turn, two bodies taking turns after frame 3."""
    rng = np.random.default_rng(1)
    states = list(HandState)
    return [
        Skeleton(
            index / 30,
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
    assert told["seconds"] == pytest.approx(5 / 30)
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
    assert direct == inspect_file(path)


def test_the_text_says_what_the_numbers_say(tmp_path):
    inspection = inspect_recording(from_skeletons(skeletons(), "demonstrator:1", "demonstrator"))
    text = str(inspection)
    assert text.startswith("demonstrator:1: demonstrator, 6 frames, 0.17 s\n")
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
    assert len(files) > len(refused)
    assert set(refused) <= {"kinectron"}
