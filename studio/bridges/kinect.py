"""A Kinect V2 on a Windows computer as the studio's sensor, through PyKinect2.

Runs beside the Kinect for Windows SDK 2.0 and imports nothing of the studio: copy this one file to
that computer. It needs the packages pykinect2 (with numpy and comtypes) and websockets, on Python
3.6 or later; docs/kinect.md of the studio says which versions go together.

    python kinect.py --to "ws://192.168.1.20:8765/?token=..."

One message a frame goes to the studio: a line of JSON for each person, as its docs/files.md
describes them. The SDK's camera space, order of joints and numbers are the studio's too.

It has been tested against a stand-in of PyKinect2 only: it has not met a Kinect.
"""

import argparse
import asyncio
import contextlib
import json
import math
import os
import sys
import time
from typing import Any, Dict, List, Optional
from urllib.parse import quote, urlsplit

try:
    import websockets
    import websockets.exceptions
except ImportError:
    sys.exit("kinect: the package websockets is missing: pip install websockets")

STUDIO = "ws://127.0.0.1:8765"
JOINT_COUNT = 25
HAND_STATES = ("unknown", "not_tracked", "open", "closed", "lasso")  # as the SDK numbers them
TICKS = 1e7  # of the SDK's relative time in a second
FRAME_PERIOD = 1 / 30  # s
POLL_EVERY = 0.004  # s; PyKinect2 has nothing to wait for
SILENT_AFTER = 2.0  # s without a frame
STATUS_EVERY = 5.0  # s
RETRY_EVERY = 1.0  # s, while the studio does not listen

Frame = List[Dict[str, Any]]  # one object a person, or a single one with time only


class BridgeError(Exception):
    """What a person can cure; printed without traceback."""


class Voice:
    """Says what goes on, but nothing twice in a row."""

    def __init__(self) -> None:
        self._said = ""

    def say(self, text: str) -> None:
        """Tell a person."""
        if text != self._said:
            print("kinect: " + text, file=sys.stderr, flush=True)
        self._said = text


def open_sensor() -> Any:
    """Return PyKinect2's runtime, which delivers body frames in the background."""
    try:
        from pykinect2 import PyKinectRuntime, PyKinectV2

        return PyKinectRuntime.PyKinectRuntime(PyKinectV2.FrameSourceTypes_Body)
    except Exception as error:  # COM's errors have no base of their own
        raise BridgeError(why_no_sensor(error)) from error


def why_no_sensor(error: Exception) -> str:
    """Return what to say where PyKinect2 does not start."""
    said = f"{type(error).__name__}: {error}"
    if isinstance(error, ImportError) and getattr(error, "name", None) == "pykinect2":
        return "PyKinect2 is not installed: pip install pykinect2 (on Windows)"
    if isinstance(error, (ImportError, AssertionError, AttributeError)):
        return (
            f"PyKinect2 does not run with this Python ({said}). On 64-bit Python, or from 3.8 on, "
            "put PyKinectV2.py and PyKinectRuntime.py of its repository Kinect/PyKinect2 in place "
            "of the installed ones; it also wants numpy below 1.24 and comtypes 1.1.4"
        )
    return (
        f"the Kinect does not open ({said}). Is the Kinect for Windows SDK 2.0 installed, and the "
        "sensor plugged in?"
    )


class BodyFrames:
    """Turns PyKinect2's body frames into the studio's, each of them once."""

    def __init__(self, runtime: Any) -> None:
        self._runtime = runtime
        self._seats = None  # type: Any
        self._time = -math.inf
        self._shift = 0.0

    def newest(self, arrival: float) -> Optional[Frame]:
        """Return the newest frame, or None where there is none since; arrival in s by any clock."""
        if not self._runtime.has_new_body_frame():
            return None
        found = self._runtime.get_last_body_frame()
        if found is None or found.bodies is None:
            return None
        seats = list(found.bodies)
        # The packaged PyKinect2 0.1.0 calls every frame new; a frame's seats are objects of its
        # own, in every version.
        if self._seats and seats and seats[0] is self._seats[0]:
            return None
        self._seats = seats
        stamp = self._rising(found, arrival)
        people = [self._person(body, stamp) for body in seats if body.is_tracked]
        return people or [{"skeleton": 1, "time": stamp}]

    def _rising(self, found: Any, arrival: float) -> float:
        """Return the sensor's time [s]; 0.1.0 has none, and it begins anew after an unplugging."""
        ticks = getattr(found, "relative_time", None)
        stamp = arrival if ticks is None else ticks / TICKS
        if stamp + self._shift <= self._time:
            self._shift = self._time + FRAME_PERIOD - stamp
        self._time = round(stamp + self._shift, 6)
        return self._time

    def _person(self, body: Any, stamp: float) -> Dict[str, Any]:
        joints = [joint_of(body.joints[index]) for index in range(JOINT_COUNT)]
        return {
            "skeleton": 1,
            "time": stamp,
            "body": str(body.tracking_id),
            "positions": [position for position, _ in joints],
            "tracking": [tracking for _, tracking in joints],
            "left_hand": hand(body.hand_left_state, body.hand_left_confidence),
            "right_hand": hand(body.hand_right_state, body.hand_right_confidence),
        }


def joint_of(joint: Any) -> Any:
    """Return a joint's position [m] in camera space and its tracking state."""
    place = joint.Position
    position = [round(float(value), 6) for value in (place.x, place.y, place.z)]
    if not all(math.isfinite(value) for value in position):
        return [0.0, 0.0, 0.0], 0
    return position, int(joint.TrackingState)


def hand(state: int, confidence: int) -> Dict[str, Any]:
    """Return a hand as the studio knows it; the SDK's confidence is 0 (low) or 1 (high)."""
    known = 0 <= state < len(HAND_STATES)
    return {
        "state": HAND_STATES[state] if known else "unknown",
        "confidence": float(min(max(confidence, 0), 1)),
    }


def with_token(url: str, token: str) -> str:
    """Return an address that presents a token, if there is one and it has none of its own."""
    try:
        query, _ = urlsplit(url).query, urlsplit(url).port
    except ValueError:  # the port is no number
        raise BridgeError(no_address(url)) from None
    return url if query or not token else url + "/?token=" + quote(token, safe="")


def no_address(url: str) -> str:
    """Return what to say of an address that is none; the token is nobody else's business."""
    return "--to " + url.partition("?")[0] + ": expected ws://HOST:PORT"


class Publisher:
    """Sends every new frame to the studio, and comes back when the studio restarts."""

    def __init__(self, url: str, frames: BodyFrames, voice: Voice, token: str = "") -> None:
        self._url = with_token(url, token)
        self._frames, self._voice = frames, voice
        self._shown = url.partition("?")[0]
        self._frame_at = self._status_at = time.perf_counter()
        self._count = self._people = 0
        self._silent = False

    async def run(self) -> None:
        """Publish until cancelled."""
        while True:
            try:
                async with websockets.connect(self._url, compression=None) as connection:
                    self._voice.say("connected to " + self._shown)
                    hearing = asyncio.ensure_future(self._hear(connection))
                    try:
                        await self._send_all(connection)
                    finally:
                        hearing.cancel()
            except websockets.exceptions.InvalidURI:
                raise BridgeError(no_address(self._url)) from None
            except websockets.exceptions.ConnectionClosed as closed:
                self._voice.say(f"the studio has closed the connection: {closed}")
            except (OSError, asyncio.TimeoutError, websockets.exceptions.WebSocketException) as no:
                self._voice.say(
                    f"no studio takes frames at {self._shown} ({no}). Start one with `studio`; "
                    "this program waits for it."
                )
            await asyncio.sleep(RETRY_EVERY)

    async def _hear(self, connection: Any) -> None:
        with contextlib.suppress(websockets.exceptions.ConnectionClosed):  # the sender tells of it
            async for answer in connection:
                self._voice.say("studio: " + str(answer)[:500])

    async def _send_all(self, connection: Any) -> None:
        while True:
            now = time.perf_counter()
            frame = self._frames.newest(now)
            self._watch(frame, now)
            if frame is not None:
                await connection.send("\n".join(json.dumps(person) for person in frame))
            await asyncio.sleep(POLL_EVERY)

    def _watch(self, frame: Optional[Frame], now: float) -> None:
        """Say how many frames come, and when they do not."""
        if frame is not None:
            self._frame_at, self._silent = now, False
            self._count += 1
            self._people = sum("body" in person for person in frame)
        elif now - self._frame_at > SILENT_AFTER and not self._silent:
            self._silent = True
            self._voice.say(
                "the Kinect sends no frames: is it plugged in, into USB 3 and the mains? This "
                "program goes on as soon as it does."
            )
        if now - self._status_at > STATUS_EVERY and not self._silent:
            rate = self._count / (now - self._status_at)
            self._voice.say(f"{rate:.1f} frames a second, {self._people} in sight")
            self._status_at, self._count = now, 0


def publish(publisher: Publisher) -> None:
    """Run a publisher until it fails or is interrupted (asyncio.run begins with Python 3.7)."""
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    task = loop.create_task(publisher.run())
    try:
        loop.run_until_complete(task)
    finally:
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError, BridgeError):
            loop.run_until_complete(task)
        loop.close()


def main(arguments: Optional[List[str]] = None) -> int:
    """Run the bridge; return its exit status."""
    parser = argparse.ArgumentParser("kinect.py", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--to", default=STUDIO, help="the studio's socket, by default " + STUDIO)
    options = parser.parse_args(arguments)
    os.environ["no_proxy"] = "*"  # frames go to the studio, and nowhere else
    voice, runtime = Voice(), None
    try:
        runtime = open_sensor()
        token = os.environ.get("STUDIO_TOKEN", "")  # unlike an option, others can't read it
        publish(Publisher(options.to, BodyFrames(runtime), voice, token))
    except BridgeError as error:
        voice.say(str(error))
        return 1
    except KeyboardInterrupt:
        return 130
    finally:
        if runtime is not None:
            runtime.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
