"""Files of node-kinect2's frames, and Kinectron's recordings of them.

- **node-kinect2**: one message a line, as `kinect2_message` describes it. No stamps: 30 frames a
  second.
- **Kinectron**: one JSON list of what it sent, bodies or whole frames, each with
  ``record_timestamp``, in ms since the ``record_startime`` [sic], in ms since 1970. A list without
  stamps is taken to have 30 frames a second.

Of a list of bodies, those within 10 ms of each other are one frame, unless a body comes again: the
sensor sends all bodies at once, and they are stamped one by one. Time is counted from the first
start. Joints and hands are as in `kinect2_message`; Kinectron tells no tracking.
"""

from collections.abc import Iterable, Iterator

from studio.engine.errors import StudioError
from studio.engine.skeleton import FRAME_RATE, Skeleton
from studio.engine.sources.family import Family, Frame, ParsedFile, check_time
from studio.engine.sources.kinect2_fields import HAND_KEYS, is_person
from studio.engine.sources.kinect2_message import (
    bodies_from_message,
    bodies_of,
    tells_tracking,
)
from studio.engine.sources.strict_json import as_number, as_object, json_entries, json_lines

_SAME_FRAME = 0.010  # [s]; a third of the sensor's period
_MARKS = ('"bodyIndex"', '"cameraX"', '"trackedBodyFrame"', '"bodyFrame"')
_START, _STAMP = "record_startime", "record_timestamp"


def recognizes(head: str) -> bool:
    """Return whether a text begins as one message a line does."""
    return head.lstrip().startswith("{") and _shows_bodies(head)


def recognizes_list(head: str) -> bool:
    """Return whether a text begins as one list of messages."""
    return head.lstrip().startswith("[") and (_shows_bodies(head) or f'"{_STAMP}"' in head)


def read(lines: Iterable[str]) -> ParsedFile:
    """Return the frames of a file's lines; raise StudioError that names the line."""
    return _read("node-kinect2", json_lines(lines))


def read_list(text: str) -> ParsedFile:
    """Return the frames of a whole list; raise StudioError that names the entry, from 0."""
    return _read("kinectron", json_entries(text))


def _shows_bodies(head: str) -> bool:
    return any(mark in head for mark in _MARKS) and '"frames"' not in head


def _read(name: str, entries: Iterator[tuple[str, object]]) -> ParsedFile:
    frames: list[Frame] = []
    clock = _Clock()
    tells_hands = tells_joints = False
    for place, value in entries:
        try:
            message = as_object(value, "a message")
            time = clock.time_of(message)
            frame = bodies_from_message(message, time)
            people = [body for body in bodies_of(message) if is_person(body)]
        except StudioError as error:
            raise StudioError(f"{place}: {error}") from None
        tells_hands = tells_hands or any(key in body for body in people for key in HAND_KEYS)
        tells_joints = tells_joints or any(map(tells_tracking, people))
        _append(frames, frame, joins="joints" in message and clock.has_stamps)
    return ParsedFile(name, frames, tells_hands, tells_joints, clock.has_stamps)


class _Clock:
    """Tells the messages' times [s], from the first start on; the first one's are those of all."""

    def __init__(self) -> None:
        self.has_stamps = False
        self._start = 0.0  # [ms]
        self._count = 0
        self._previous: float | None = None

    def time_of(self, message: dict[str, object]) -> float:
        """Return a message's time; raise StudioError where it has none or runs backwards."""
        if self._count == 0:
            self.has_stamps = _STAMP in message
            self._start = _milliseconds(message, _START, 0.0)
        time = self._count / FRAME_RATE
        if self.has_stamps:
            since = _milliseconds(message, _START, self._start) - self._start
            time = (since + _milliseconds(message, _STAMP)) / 1000.0
        check_time(time, self._previous)
        self._count += 1
        self._previous = time
        return time


def _milliseconds(message: dict[str, object], key: str, default: float | None = None) -> float:
    return as_number(message.get(key, default), f'"{key}"')


def _append(frames: list[Frame], frame: Frame, joins: bool) -> None:
    """Append a frame, or put its one body into the frame before where they belong together."""
    if joins and frames and frame.bodies:
        (body,), last = frame.bodies, frames[-1]
        others = {other.body_id for other in last.bodies}
        if others and body.body_id not in others and frame.time - last.time <= _SAME_FRAME:
            frames[-1] = Frame(last.time, (*last.bodies, _at(body, last.time)))
            return
    frames.append(frame)


def _at(body: Skeleton, time: float) -> Skeleton:
    return Skeleton(
        time, body.positions, body.tracking, body.left_hand, body.right_hand, body.body_id
    )


FAMILY = Family(
    "node-kinect2's frames (JSON lines)", recognizes, lambda content: read(content.lines())
)
RECORDING_FAMILY = Family(
    "Kinectron's recordings", recognizes_list, lambda content: read_list(content.text())
)
