"""A webcam or a video as the studio's sensor: MediaPipe finds body and hands, the studio is told.

``studio webcam`` runs it in an environment of its own (``webcam-requirements.txt``). It imports
nothing of the studio, so it also runs on another computer that has the camera. A message a picture
(``landmarks.py`` describes it) goes to the studio's socket, or as a line into a file; no picture is
stored. Left and right are the person's own where pictures are not mirrored (else ``--mirror``).
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import json
import math
import os
import sys
import time
import types
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

STUDIO = "ws://127.0.0.1:8765"
STATUS_EVERY = 2.0  # s
RETRY_EVERY = 1.0  # s, while the studio does not listen
HELD_UP = 1.0  # s; a video later than this was held up, and goes on from where it is
CAMERAS_TRIED = 6  # indices to look at where the wanted one does not open


class BridgeError(Exception):
    """What a person can cure; printed without traceback."""


def say(text: str) -> None:
    """Tell a person what goes on."""
    print(f"webcam: {text}", file=sys.stderr, flush=True)


say_once = functools.lru_cache(maxsize=1)(say)  # not again what it said last


def camera_pictures(index: int) -> Iterator[tuple[float, Any]]:
    """Yield what a camera sees, as (time [s], picture (height, width, 3) in BGR)."""
    import cv2

    capture = cv2.VideoCapture(index)
    if not capture.isOpened():
        others = [n for n in range(CAMERAS_TRIED) if n != index and cv2.VideoCapture(n).isOpened()]
        raise BridgeError(without_camera(index, others))
    capture.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter_fourcc(*"MJPG"))  # raw: 10 Hz at this size
    capture.set(cv2.CAP_PROP_FRAME_WIDTH, 1280)  # hands at 2 m are too small in 640 x 480
    capture.set(cv2.CAP_PROP_FRAME_HEIGHT, 720)
    capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)  # a queue would only make every picture old
    while (read := capture.read())[0]:
        yield time.monotonic(), read[1]
    raise BridgeError(f"camera {index} gives no more pictures: unplugged, or taken by a program?")


def without_camera(index: int, others: list[int]) -> str:
    """Return what to say where a camera does not open and these others do."""
    if others:
        return f"camera {index} does not open, but {others} would: try --camera {others[0]}"
    return (
        f"camera {index} does not open, nor any up to {CAMERAS_TRIED - 1}. Plugged in? In use by a "
        "video call or the browser? Linux: `sudo usermod -aG video $USER`, log in again. macOS: "
        "allow it in the privacy settings. Without a camera: --video FILE"
    )


def video_pictures(path: Path, speed: float, loop: bool) -> Iterator[tuple[float, Any]]:
    """Yield a video's pictures as `camera_pictures` does, on the video's own time.

    With a ``speed`` they come when they are due, and late ones are left out, as a camera's are; at
    speed 0 all of them come, as fast as they are taken.
    """
    began, start = time.monotonic(), 0.0  # `start` is the time at which this pass begins
    while True:
        stamp = period = 0.0
        for stamp, period, capture in _video_pass(path):
            due = (start + stamp) / (speed or 1.0)
            late = time.monotonic() - began - due if speed else 0.0
            if late > HELD_UP:
                began += late
            elif speed and late > period / speed:
                continue
            time.sleep(max(0.0, -late))
            if (read := capture.retrieve())[0]:
                yield due, read[1]
        if not loop:
            return
        start += stamp + period


def _video_pass(path: Path) -> Iterator[tuple[float, float, Any]]:
    """Go through a video once: time and period [s], and the capture that holds the picture."""
    import cv2

    if not path.is_file():
        raise BridgeError(f"{path}: there is no such file")
    capture = cv2.VideoCapture(str(path))
    rate = capture.get(cv2.CAP_PROP_FPS)
    period = 1.0 / rate if math.isfinite(rate) and rate > 0 else 1.0 / 30.0
    stamp = -period
    while capture.grab():
        told = capture.get(cv2.CAP_PROP_POS_MSEC) / 1e3  # 0 in every picture, in some backends
        stamp = told if told > max(stamp, 0.0) else stamp + period
        yield stamp, period, capture
    if stamp < 0.0:
        raise BridgeError(f"{path}: holds no picture that OpenCV can read; is it a whole video?")


def new_pictures(pictures: Iterator[tuple[float, Any]]) -> Iterator[tuple[float, Any]]:
    """Leave out what repeats the picture before: to a stuck camera, nobody stands still."""
    import numpy as np

    last: Any = None
    for stamp, picture in pictures:
        if last is None or not np.array_equal(picture, last):
            yield stamp, picture
        else:
            say_once("pictures repeat, and are left out: is the camera stuck, or covered?")
        last = picture


def make_tracker(mirror: bool) -> Callable[[float, Any], dict[str, Any]]:
    """Return what makes the message of a time [s] and a picture (height, width, 3) in BGR."""
    # MediaPipe's drawing module imports matplotlib: 100 MB that nothing here draws with.
    for name in ("matplotlib", "matplotlib.pyplot"):
        sys.modules.setdefault(name, types.ModuleType(name))
    import cv2
    from mediapipe.python.solutions.holistic import Holistic

    model = Holistic(model_complexity=1, smooth_landmarks=True)

    def find(stamp: float, picture: Any) -> dict[str, Any]:
        seen = cv2.cvtColor(cv2.flip(picture, 1) if mirror else picture, cv2.COLOR_BGR2RGB)
        return message(stamp, picture.shape[1], picture.shape[0], model.process(seen))

    return find


def message(stamp: float, width: int, height: int, found: Any) -> dict[str, Any]:
    """Return what is sent for MediaPipe's results."""
    return {
        "format": "mediapipe-landmarks 1",
        "time": round(stamp, 6),
        "image": [width, height],
        "pose_world": _points(found.pose_world_landmarks, "x", "y", "z", "visibility"),
        "pose_image": _points(found.pose_landmarks, "x", "y"),
        "left_hand": _points(found.left_hand_landmarks, "x", "y", "z"),
        "right_hand": _points(found.right_hand_landmarks, "x", "y", "z"),
    }


def _points(landmarks: Any, *fields: str) -> list[list[float]] | None:
    if landmarks is None:
        return None
    return [[round(getattr(mark, name), 5) for name in fields] for mark in landmarks.landmark]


@contextlib.contextmanager
def file_sink(path: Path) -> Iterator[Callable[[str], object]]:
    """Take messages into a file, one a line; it has its name when it is finished."""
    unfinished = path.with_name(path.name + ".unfinished")
    for there in filter(Path.exists, (path, unfinished)):
        raise BridgeError(f"--out: {there} is there already: move it, or name another file")
    try:
        with unfinished.open("w", encoding="utf-8", newline="\n") as stream:
            yield lambda text: stream.write(text + "\n")
    finally:
        if unfinished.stat().st_size:  # what was written before an interruption is kept too
            say(f"wrote {unfinished.replace(path)}")
        unfinished.unlink(missing_ok=True)


class StudioSink:
    """Sends messages to the studio, tells what it answers, and comes back when it restarts."""

    def __init__(self, url: str, token: str = "") -> None:
        self._shown = url.partition("?")[0]
        self._url = url if "?" in url or not token else f"{url}/?token={quote(token, safe='')}"
        self._connection: Any = None

    def __enter__(self) -> Callable[[str], object]:
        return self._send

    def __exit__(self, *_: object) -> None:
        if self._connection is not None:
            self._connection.close()

    def _send(self, text: str) -> None:
        """Send a message, as soon as the studio listens, and tell what it has said since."""
        from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidURI
        from websockets.sync.client import connect

        while True:
            try:
                if self._connection is None:  # no proxy: frames go to the studio, nowhere else
                    self._connection = connect(self._url, proxy=None, compression=None)
                    say_once(f"connected to {self._shown}")
                self._connection.send(text)
                with contextlib.suppress(TimeoutError):
                    while True:
                        say_once(f"studio: {str(self._connection.recv(timeout=0))[:500]}")
            except (InvalidURI, ValueError):  # ValueError: a port that is no number
                raise BridgeError(f"--to {self._shown}: expected ws://HOST:PORT") from None
            except ConnectionClosed as closed:
                reason = closed.rcvd.reason if closed.rcvd else ""
                say_once(f"the studio has closed the connection. {reason}".rstrip())
            except (OSError, InvalidHandshake) as error:  # a TimeoutError is an OSError
                body = getattr(getattr(error, "response", None), "body", b"") or b""
                why = f"{error} {body.decode(errors='replace')[:500]}".strip()
                say_once(f"no studio takes frames at {self._shown} ({why}): waiting for `studio`")
            else:
                return
            self._connection = None
            time.sleep(RETRY_EVERY)


class Status:
    """Counts what is seen, and says so every two seconds."""

    def __init__(self) -> None:
        self._since, self._seen = time.monotonic(), Counter[str]()

    def count(self, seconds: float, found: dict[str, Any]) -> None:
        """Count a picture that took so long."""
        self._seen.update(key for key, value in found.items() if value is not None)
        self._seen["ms"] += round(seconds * 1e3)
        if time.monotonic() - self._since >= STATUS_EVERY:
            self.tell()

    def tell(self) -> None:
        """Say how it went since the last time."""
        if not (count := self._seen["format"]):
            return
        now, seen = time.monotonic(), self._seen
        say(
            f"{count / max(now - self._since, 1e-3):.1f} pictures a second, "
            f"{seen['ms'] / count:.0f} ms each; body in {seen['pose_world'] / count:.0%}, left "
            f"hand in {seen['left_hand'] / count:.0%}, right in {seen['right_hand'] / count:.0%}"
        )
        self._since, self._seen = now, Counter()


def parse(arguments: list[str] | None) -> argparse.Namespace:
    """Return the command line's options."""
    parser = argparse.ArgumentParser("webcam.py", description=__doc__.partition("\n")[0])
    parser.add_argument("--camera", type=int, default=0, help="the camera's number")
    parser.add_argument("--video", type=Path, help="a video file instead of a camera")
    parser.add_argument("--to", default=STUDIO, help=f"the studio's socket, by default {STUDIO}")
    parser.add_argument("--out", type=Path, help="write the messages to this file instead")
    parser.add_argument("--mirror", action="store_true", help="the pictures come mirrored")
    parser.add_argument("--speed", type=float, default=1.0, help="of a video; 0: without waiting")
    parser.add_argument("--loop", action="store_true", help="begin the video again at its end")
    options = parser.parse_args(arguments)
    if not 0.0 <= options.speed <= 100.0:
        parser.error(f"--speed: expected a number from 0 to 100, not {options.speed}")
    return options


def run(options: argparse.Namespace) -> None:
    """Track until the pictures end."""
    find, status = make_tracker(options.mirror), Status()
    pictures = camera_pictures(options.camera)
    if options.video is not None:
        speed = options.speed if options.out is None else 0.0
        pictures = video_pictures(options.video, speed, options.loop)
    sink = StudioSink(options.to, os.environ.get("STUDIO_TOKEN", ""))
    with sink if options.out is None else file_sink(options.out) as send:
        for stamp, picture in new_pictures(pictures):
            began = time.perf_counter()
            found = find(stamp, picture)
            status.count(time.perf_counter() - began, found)
            send(json.dumps(found))
        status.tell()


def main(arguments: list[str] | None = None) -> int:
    """Run the bridge; return its exit status."""
    options = parse(arguments)
    # Compiled libraries write notes to descriptor 2: keep it to ourselves.
    sys.stderr = os.fdopen(os.dup(2), "w", encoding="utf-8", errors="replace")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    try:
        run(options)
    except (BridgeError, OSError, ImportError) as error:
        cure = "; install webcam-requirements.txt" if isinstance(error, ImportError) else ""
        say(f"{error}{cure}")
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
