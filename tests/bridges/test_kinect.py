"""The Kinect's bridge against a stand-in of PyKinect2, faults included, and a real socket."""

import ast
import json
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest

from studio.bridges import kinect
from studio.engine.live.access import refusal
from studio.engine.live.protocols import detect, read_objects
from studio.engine.skeleton import SIDES, HandState, Joint, Skeleton, Tracking
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.family import Frame
from tests.bridges.listening import listening

STANDIN = Path(__file__).parent / "standin"
STATES = tuple(HandState)


@pytest.fixture
def runtime(monkeypatch):
    """Return the stand-in's class."""
    monkeypatch.syspath_prepend(str(STANDIN))
    from pykinect2.PyKinectRuntime import PyKinectRuntime  # noqa: PLC0415

    return PyKinectRuntime


def person(skeleton: Skeleton, tracking_id: int = 72057594037929284) -> dict[str, Any]:
    """Return what PyKinect2 would tell of a skeleton."""
    told: dict[str, Any] = {"tracking_id": tracking_id}
    for side in SIDES:
        hand = skeleton.hand(side)
        told[f"hand_{side}_state"] = STATES.index(hand.state)
        told[f"hand_{side}_confidence"] = int(hand.confidence)
    rows = zip(skeleton.positions.tolist(), skeleton.tracking.tolist(), strict=True)
    return told | {"joints": [(*position, tracking) for position, tracking in rows]}


def script(skeletons: list[Skeleton]) -> list[Any]:
    return [(round(each.time * 1e7), [person(each)]) for each in skeletons]


def text_of(frame: list[dict[str, Any]]) -> str:
    return "\n".join(json.dumps(each, allow_nan=False) for each in frame)


def understood(frame: list[dict[str, Any]]) -> Frame:
    """Return what the studio takes a message for."""
    objects = read_objects(text_of(frame))
    protocol = detect(objects[0])
    assert protocol.name == "studio jsonl"
    return protocol.read(objects, 0.0)


def played(sensor: Any, ticks: int) -> list[list[dict[str, Any]] | None]:
    """Return what the bridge makes of each thirtieth of a second, asked twice in each."""
    frames = kinect.BodyFrames(sensor)
    found = []
    for tick in range(ticks):
        sensor.tick()
        found.append(frames.newest(tick / 30))
        assert frames.newest(tick / 30 + 0.01) is None, "a frame is sent once"
    return found


def takes() -> list[Skeleton]:
    return list(demonstrate(seed=3, take=1))[:40]


@pytest.mark.parametrize("generation", ["repository", "packaged"])
def test_what_the_studio_gets_is_what_the_sensor_saw(runtime, generation: str) -> None:
    """Camera space, order of joints and the SDK's numbers are ours; only float32 lies between."""
    seen = takes()
    sent = played(runtime(32, script(seen), generation), len(seen))
    for index, (skeleton, message) in enumerate(zip(seen, sent, strict=True)):
        assert message is not None
        (body,) = understood(message).bodies
        np.testing.assert_allclose(body.positions, skeleton.positions, atol=2e-6)
        assert (body.tracking == skeleton.tracking).all()
        assert (body.left_hand, body.right_hand) == (skeleton.left_hand, skeleton.right_hand)
        assert body.body_id == "72057594037929284"
        expected = skeleton.time if generation == "repository" else index / 30
        assert body.time == pytest.approx(expected, abs=1e-6)


def test_who_faces_the_sensor_has_the_left_hand_at_negative_x(runtime) -> None:
    (message,) = played(runtime(32, script(takes()[:1])), 1)
    (body,) = understood(message or []).bodies
    left, right = (body.positions[Joint.of("shoulder", side)] for side in SIDES)
    assert left[0] < right[0]
    assert left[2] > 0.5


def test_six_people_are_six_lines_of_one_time(runtime) -> None:
    one = takes()[0]
    people = [person(one, tracking_id=100 + seat) for seat in range(6)]
    (message,) = played(runtime(32, [(330_000, people)]), 1)
    frame = understood(message or [])
    assert [body.body_id for body in frame.bodies] == [str(100 + seat) for seat in range(6)]
    assert {body.time for body in frame.bodies} == {frame.time} == {0.033}


def test_no_frame_nobody_and_a_person_who_leaves(runtime) -> None:
    here = (660_000, [person(takes()[0])])
    sensor = runtime(32, [None, (330_000, []), here, (990_000, [])])
    none, empty, somebody, left = played(sensor, 4)
    assert none is None
    assert empty == [{"skeleton": 1, "time": 0.033}]
    assert len(understood(somebody or []).bodies) == 1
    assert understood(left or []) == Frame(0.099)


def test_before_the_first_frame_there_is_none(runtime) -> None:
    class Hasty(runtime):
        def has_new_body_frame(self) -> bool:
            return True

    assert kinect.BodyFrames(Hasty(32, [])).newest(0.0) is None


def test_an_unplugged_sensor_begins_its_time_anew_and_ours_goes_on_rising(runtime) -> None:
    seen = script(takes()[:6])
    again = [(ticks // 7, people) for ticks, people in seen]
    for generation in ("repository", "packaged"):
        sent = played(runtime(32, [*seen, *[None] * 90, *again], generation), 102)
        times = [frame[0]["time"] for frame in sent if frame is not None]
        assert len(times) == 12
        assert (np.diff(times) > 0).all()


def test_lost_joints_and_hands(runtime) -> None:
    lost = person(takes()[0]) | {"hand_left_state": 1, "hand_left_confidence": 0}
    lost["hand_right_state"] = 9  # a number that the SDK does not have
    lost["joints"][Joint.WRIST_LEFT] = (math.inf, math.nan, 0.0, 2)
    lost["joints"][Joint.ELBOW_LEFT] = (*lost["joints"][Joint.ELBOW_LEFT][:3], 1)
    (message,) = played(runtime(32, [(0, [lost])]), 1)
    (body,) = understood(message or []).bodies
    assert body.tracking[Joint.WRIST_LEFT] == Tracking.NOT_TRACKED
    assert body.tracking[Joint.ELBOW_LEFT] == Tracking.INFERRED
    assert (body.left_hand.state, body.left_hand.confidence) == (HandState.NOT_TRACKED, 0.0)
    assert body.right_hand.state == HandState.UNKNOWN


def test_each_failure_to_open_names_its_cure() -> None:
    for error, cure in (
        (ImportError("No module named 'pykinect2'", name="pykinect2"), "pip install pykinect2"),
        (AssertionError(80), "PyKinectV2.py and PyKinectRuntime.py"),
        (ImportError("Wrong version"), "comtypes"),
        (AttributeError("module 'time' has no attribute 'clock'"), "from 3.8 on"),
        (OSError("[WinError 126] kinect20.dll"), "SDK 2.0"),
    ):
        assert cure in kinect.why_no_sensor(error)


def test_it_runs_on_an_old_python_and_alone() -> None:
    """Python 3.6's grammar, and nothing imported but it, websockets and pykinect2."""
    tree = ast.parse(Path(kinect.__file__).read_text(), feature_version=(3, 6))
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add(str(node.module).split(".")[0])
    assert names - sys.stdlib_module_names == {"websockets", "pykinect2"}


def start(url: str, folder: Path, frames: list[Any]) -> subprocess.Popen[str]:
    """Run the bridge as a person does, with the stand-in beside it."""
    (folder / "script.json").write_text(json.dumps(frames))
    return subprocess.Popen(
        [sys.executable, kinect.__file__, "--to", url],
        env=os.environ
        | {"PYTHONPATH": str(STANDIN), "PYKINECT2_SCRIPT": str(folder / "script.json")},
        stderr=subprocess.PIPE,
        text=True,
    )


def test_over_a_real_socket_through_a_restart_and_an_unplugging(tmp_path: Path) -> None:
    seen = script(list(demonstrate(seed=3, take=1)))
    with listening() as first:
        bridge = start(first.url, tmp_path, [*seen[:20], *[None] * 105, *seen[20:]])
        try:
            assert first.wait_for(10)
        finally:
            port = first.port
    with listening(port, answer='{"status": "waiting"}') as second:
        assert second.wait_for(20)
        time.sleep(0.1)
        bridge.send_signal(signal.SIGINT)
        said = bridge.communicate(timeout=10)[1]
    assert bridge.returncode == 130
    assert "Traceback" not in said
    assert "connected to" in said
    assert "the Kinect sends no frames" in said
    assert 'studio: {"status": "waiting"}' in said
    times = [json.loads(text)["time"] for text in first.messages + second.messages]
    assert (np.diff(times) > 0).all()


@pytest.mark.parametrize("url", ["http://somewhere", "ws://127.0.0.1:port"])
def test_an_address_that_is_none(tmp_path: Path, url: str) -> None:
    bridge = start(f"{url}?token=secret", tmp_path, [])
    said = bridge.communicate(timeout=10)[1]
    assert bridge.returncode == 1
    assert said == f"kinect: --to {url}: expected ws://HOST:PORT\n"


@pytest.mark.parametrize("token", ["a b&c=d?/ü", "correct-horse"])
def test_the_environments_token_is_one_that_the_studio_finds(token: str) -> None:
    for url in ("ws://box:1", "ws://box:1/"):
        asked = urlsplit(kinect.with_token(url, token))
        assert (asked.hostname, asked.port) == ("box", 1)
        assert refusal(f"{asked.path}?{asked.query}", "", None, token) == ""
    for own in ("ws://box:1/?token=own", "ws://box:1?token=own"):
        assert kinect.with_token(own, token) == own
    assert kinect.with_token("ws://box:1", "") == "ws://box:1"
