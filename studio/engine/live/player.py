"""A recording as a live sensor: when each of its frames is due, and what its message is."""

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import count
from typing import Literal

from studio.engine.errors import StudioError
from studio.engine.skeleton import FRAME_RATE, HandState, Joint, Skeleton
from studio.engine.sources.family import Frame
from studio.engine.sources.jsonl import frame_to_json

MessageFormat = Literal["jsonl", "node-kinect2", "kinectron"]
_HAND_NUMBERS = {state: number for number, state in enumerate(HandState)}


def schedule(frames: Sequence[Frame], speed: float = 1.0, loop: bool = False) -> Iterator[Frame]:
    """Return a recording's frames as a sensor would stamp them that begins at zero.

    Each frame is due when its own stamp says. At another ``speed`` the person moves faster, and the
    stamps say so. In a loop they go on to rise: one usual interval lies between end and beginning.

    Raises
    ------
    StudioError
        Where there is no frame to play, or the speed is none.
    """
    if not 0.0 < speed < float("inf"):
        raise StudioError(f"--speed: a number above 0, not {speed!r}")
    if not frames:
        raise StudioError("there is no frame to play")
    return _laps(frames, speed, count() if loop else range(1))


def _laps(frames: Sequence[Frame], speed: float, laps: Iterable[int]) -> Iterator[Frame]:
    first = frames[0].time
    once = frames[-1].time - first + 1.0 / FRAME_RATE
    for lap in laps:
        for frame in frames:
            yield _stamped(frame, (lap * once + frame.time - first) / speed)


def encoder(name: MessageFormat) -> Callable[[Frame], str]:
    """Return what makes a frame's message in one of the protocols that the studio understands."""
    return _ENCODERS[name]


def _stamped(frame: Frame, time: float) -> Frame:
    return Frame(time, tuple(replace(body, time=time) for body in frame.bodies))


def _jsonl(frame: Frame) -> str:
    if not frame.bodies:
        return json.dumps({"skeleton": 1, "time": frame.time})
    return "\n".join(frame_to_json(body) for body in frame.bodies)


def _node_kinect2(frame: Frame) -> str:
    bodies = [_kinect_body(index, body) for index, body in enumerate(frame.bodies)]
    return json.dumps({"bodies": bodies}, allow_nan=False)


def _kinectron(frame: Frame) -> str:
    bodies = [_kinect_body(index, body) for index, body in enumerate(frame.bodies)]
    return json.dumps({"event": "bodyFrame", "data": {"bodies": bodies}}, allow_nan=False)


def _kinect_body(index: int, body: Skeleton) -> dict[str, object]:
    """Return a body as the Kinect's programs tell of it, without depth, color and orientation."""
    return {
        "bodyIndex": index,
        "tracked": True,
        "trackingId": body.body_id,
        "leftHandState": _HAND_NUMBERS[body.left_hand.state],
        "rightHandState": _HAND_NUMBERS[body.right_hand.state],
        "joints": [
            {
                "cameraX": x,
                "cameraY": y,
                "cameraZ": z,
                "jointType": joint.value,
                "trackingState": tracking,
            }
            for joint, (x, y, z), tracking in zip(
                Joint, body.positions.tolist(), body.tracking.tolist(), strict=True
            )
        ],
    }


_ENCODERS: dict[MessageFormat, Callable[[Frame], str]] = {
    "jsonl": _jsonl,
    "node-kinect2": _node_kinect2,
    "kinectron": _kinectron,
}
