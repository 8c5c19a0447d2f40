"""The webcam's bridge without MediaPipe and OpenCV: messages, videos' times, and a real socket."""

import contextlib
import itertools
import json
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.bridges import webcam
from studio.engine import clock
from studio.engine.live.access import Address
from studio.engine.live.listener import Listener
from studio.engine.live.protocols import detect, read_objects
from studio.engine.live.source import LiveSource
from studio.engine.skeleton import HandState, Joint
from studio.engine.sources import read_skeletons
from tests.bridges.listening import listening

# MediaPipe's numbers of landmarks, and where they are in who stands and faces the camera, in
# meters from the hips: x to the picture's right, where the person's left is.
STANDING = {
    0: (0.0, -0.65, -0.1),  # nose
    11: (0.18, -0.5, 0.0),
    12: (-0.18, -0.5, 0.0),
    13: (0.25, -0.25, 0.0),
    14: (-0.25, -0.25, 0.0),
    15: (0.25, -0.1, -0.2),
    16: (-0.25, 0.0, 0.0),
    23: (0.1, 0.0, 0.0),
    24: (-0.1, 0.0, 0.0),
}


def landmarks(places: list[tuple[float, float, float]]) -> Any:
    marks = [SimpleNamespace(x=x, y=y, z=z, visibility=0.9) for x, y, z in places]
    return SimpleNamespace(landmark=marks)


def standing(hand: Any = None) -> Any:
    """Return MediaPipe's results for a standing person 2 m away, whose left hand may be seen."""
    world = [STANDING.get(index, (0.0, 0.0, 0.0)) for index in range(33)]
    picture = [(0.5 + x / 2.0, 0.5 + y / 1.5, z) for x, y, z in world]
    return SimpleNamespace(
        pose_world_landmarks=landmarks(world),
        pose_landmarks=landmarks(picture),
        left_hand_landmarks=hand,
        right_hand_landmarks=None,
    )


NOBODY = SimpleNamespace(
    pose_world_landmarks=None,
    pose_landmarks=None,
    left_hand_landmarks=None,
    right_hand_landmarks=None,
)


def test_the_studio_understands_the_message_and_takes_left_for_left() -> None:
    text = json.dumps(webcam.message(1.25, 640, 480, standing()))
    objects = read_objects(text)
    frame = detect(objects[0]).read(objects, 99.0)
    (body,) = frame.bodies
    assert frame.time == 1.25
    assert body.positions[Joint.SHOULDER_LEFT][0] < body.positions[Joint.SHOULDER_RIGHT][0]
    assert body.positions[Joint.WRIST_LEFT][2] < body.positions[Joint.SHOULDER_LEFT][2]
    assert body.left_hand.state == body.right_hand.state == HandState.NOT_TRACKED


def test_what_was_not_found_is_null() -> None:
    seen = webcam.message(0.0, 640, 480, standing(landmarks([(0.1, 0.2, 0.3)] * 21)))
    assert seen["left_hand"] == [[0.1, 0.2, 0.3]] * 21
    assert seen["right_hand"] is None
    assert len(seen["pose_world"]) == len(seen["pose_image"]) == 33
    empty = webcam.message(0.0, 640, 480, NOBODY)
    assert [empty[key] for key in ("pose_world", "pose_image", "left_hand")] == [None] * 3


def test_the_file_is_one_that_the_studio_reads(tmp_path: Path) -> None:
    path = tmp_path / "seen.jsonl"
    with webcam.file_sink(path) as send:
        for index, found in enumerate([standing(), NOBODY, standing()]):
            send(json.dumps(webcam.message(index / 10, 640, 480, found)))
        assert not path.exists()
    read = read_skeletons(path)
    assert (len(read), read.frames) == (2, 3)
    assert [path] == list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["seen.jsonl", "seen.jsonl.unfinished"])
def test_no_file_is_overwritten(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("precious")
    with (
        pytest.raises(webcam.BridgeError, match=f"{name} is there already"),
        webcam.file_sink(tmp_path / "seen.jsonl") as send,
    ):
        send("{}")
    assert [(each.name, each.read_text()) for each in tmp_path.iterdir()] == [(name, "precious")]


def test_an_interrupted_file_keeps_what_was_written_and_an_empty_one_does_not_appear(
    tmp_path: Path,
) -> None:
    for count in (0, 1):
        path = tmp_path / f"{count}.jsonl"
        with contextlib.suppress(KeyboardInterrupt), webcam.file_sink(path) as send:
            for _ in range(count):
                send("{}")
            raise KeyboardInterrupt
    assert [each.name for each in tmp_path.iterdir()] == ["1.jsonl"]


class FakeCapture:
    """OpenCV's capture of a video whose pictures are their own numbers."""

    def __init__(self, count: int, rate: float, tells_times: bool) -> None:
        self._count, self._rate, self._tells = count, rate, tells_times
        self._at = -1

    def get(self, what: str) -> float:
        if what == "fps":
            return self._rate
        return max(self._at, 0) / self._rate * 1e3 if self._tells else 0.0

    def grab(self) -> bool:
        self._at += 1
        return self._at < self._count

    def retrieve(self) -> tuple[bool, int]:
        return True, self._at


@pytest.fixture
def video(monkeypatch, tmp_path):
    """Return what makes a video that is read by a stand-in of OpenCV."""

    def make(count: int, rate: float = 100.0, tells_times: bool = True) -> Path:
        cv2 = SimpleNamespace(
            CAP_PROP_FPS="fps",
            CAP_PROP_POS_MSEC="ms",
            VideoCapture=lambda _: FakeCapture(count, rate, tells_times),
        )
        monkeypatch.setitem(sys.modules, "cv2", cv2)
        (tmp_path / "video").touch()
        return tmp_path / "video"

    return make


@pytest.mark.parametrize("tells_times", [True, False])
def test_at_speed_0_every_picture_comes_on_the_videos_time(video, tells_times: bool) -> None:
    found = list(webcam.video_pictures(video(50, 25.0, tells_times), 0.0, loop=False))
    assert [picture for _, picture in found] == list(range(50))
    np.testing.assert_allclose([stamp for stamp, _ in found], np.arange(50) / 25, atol=1e-9)


def test_time_rises_evenly_over_the_ends_of_a_loop(video) -> None:
    pictures = webcam.video_pictures(video(10, 25.0), 0.0, loop=True)
    times = [stamp for stamp, _ in itertools.islice(pictures, 35)]
    np.testing.assert_allclose(times, np.arange(35) / 25, atol=1e-9)


def test_at_a_speed_pictures_come_when_due_and_a_slow_tracker_skips_some(video) -> None:
    began = time.monotonic()
    found = []
    for stamp, picture in webcam.video_pictures(video(60, 100.0), 2.0, loop=False):
        found.append((stamp, picture))
        assert time.monotonic() - began >= stamp - 1e-6
        time.sleep(0.02)  # four pictures' time
    assert 5 < len(found) < 40
    assert all(stamp == pytest.approx(picture / 200) for stamp, picture in found)


def test_a_video_that_was_held_up_goes_on_from_where_it_was(video, monkeypatch) -> None:
    monkeypatch.setattr(webcam, "HELD_UP", 0.05)
    pictures = webcam.video_pictures(video(40, 100.0), 1.0, loop=False)
    next(pictures)
    time.sleep(0.2)
    assert next(pictures)[1] == 1


def test_videos_that_cannot_be_read(video, tmp_path: Path) -> None:
    for path, words in ((video(0), "no picture"), (tmp_path / "missing", "no such file")):
        with pytest.raises(webcam.BridgeError, match=words) as raised:
            list(webcam.video_pictures(path, 0.0, loop=True))
        assert str(path) in str(raised.value)


@given(
    others=st.lists(st.integers(1, webcam.CAMERAS_TRIED - 1), unique=True).map(sorted),
)
@settings(deadline=None, derandomize=True)
def test_a_missing_camera_names_those_that_are_there(others: list[int]) -> None:
    words = webcam.without_camera(0, others)
    assert words.startswith("camera 0 does not open")
    assert (f"--camera {others[0]}" if others else "--video FILE") in words


def test_it_asks_each_camera_and_says_so(monkeypatch, capsys) -> None:
    asked = []

    def capture(index: int) -> Any:
        asked.append(index)
        return SimpleNamespace(isOpened=lambda: index == 4)

    monkeypatch.setitem(sys.modules, "cv2", SimpleNamespace(VideoCapture=capture))
    with pytest.raises(webcam.BridgeError, match="--camera 4"):
        next(webcam.camera_pictures(0))
    assert asked == list(range(webcam.CAMERAS_TRIED))


def test_options_are_checked(capsys) -> None:
    for bad in ("-1", "nan", "inf", "fast"):
        with pytest.raises(SystemExit):
            webcam.parse([f"--speed={bad}"])
    assert "--speed" in capsys.readouterr().err


def test_the_status_tells_shares(capsys) -> None:
    status = webcam.Status()
    hand = landmarks([(0.0, 0.0, 0.0)] * 21)
    for found in (standing(), standing(hand), NOBODY, NOBODY):
        status.count(0.04, webcam.message(0.0, 640, 480, found))
    status.tell()
    said = capsys.readouterr().err
    assert "40 ms each; body in 50%, left hand in 25%, right in 0%" in said
    status.tell()
    assert not capsys.readouterr().err


@pytest.fixture
def said(capsys, monkeypatch) -> Iterator[list[str]]:
    """Return what the bridge says; retries come soon."""
    lines: list[str] = []
    monkeypatch.setattr(webcam, "say_once", lines.append)
    monkeypatch.setattr(webcam, "RETRY_EVERY", 0.05)
    return lines


def test_it_waits_for_the_studio_hears_it_and_comes_back_after_its_restart(said) -> None:
    with listening() as first, webcam.StudioSink(first.url) as send:
        send("before")
        assert first.wait_for(1)
        port = first.port
    with webcam.StudioSink(f"ws://127.0.0.1:{port}") as send:
        waiting = threading.Thread(target=send, args=("waited",))
        waiting.start()
        time.sleep(0.3)
        assert waiting.is_alive()
        with listening(port, answer="driving") as second:
            waiting.join(10)
            assert second.wait_for(1)
            time.sleep(0.1)
            send("after")
            assert second.wait_for(2)
        with listening(port) as third:
            for number in range(3):
                send(f"again {number}")
            assert third.wait_for(1)
    assert second.messages == ["waited", "after"]
    assert third.messages[-1] == "again 2"
    for words in ("no studio takes frames", "connected to", "studio: driving", "has closed"):
        assert [line for line in said if words in line], words


@pytest.mark.parametrize("url", ["http://somewhere", "ws://127.0.0.1:port"])
def test_an_address_that_is_none(said, url: str) -> None:
    with (
        pytest.raises(webcam.BridgeError, match="expected ws://HOST:PORT") as raised,
        webcam.StudioSink(url, "secret") as send,
    ):
        send("never")
    assert "secret" not in str(raised.value)


def test_the_token_is_one_that_the_studio_finds_and_is_not_said(said) -> None:
    token = "a b&c=d?/ü"
    with (
        Listener(LiveSource(clock.now), Address("127.0.0.1", 0), token) as listener,
        webcam.StudioSink(listener.address.url, token) as send,
    ):
        send(json.dumps(webcam.message(0.0, 640, 480, standing())))
    assert said[0] == f"connected to {listener.address.url}"
    assert not any("token" in line for line in said)


def test_a_picture_that_repeats_the_one_before_is_no_news(said) -> None:
    camera = [np.full((2, 2, 3), value) for value in (1, 1, 2, 2, 2, 1, 3)]
    new = list(webcam.new_pictures((stamp, picture) for stamp, picture in enumerate(camera)))
    assert [stamp for stamp, _ in new] == [0, 2, 5, 6]
    assert all(picture is camera[stamp] for stamp, picture in new)
    assert "stuck" in said[0]
