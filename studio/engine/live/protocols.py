"""What publishers may send, told by the first message that can be read, once a connection.

- studio jsonl: a frame, as one line of our JSONL for each body, all of one time; stamped.
- node-kinect2: ``{"bodies": [...]}``; the time of arrival counts.
- Kinectron: ``{"event": ..., "data": ...}`` with node-kinect2's frame or one body in it, or one
  body alone; the time of arrival counts.
- MediaPipe landmarks: our message of pose and hands; stamped, else the time of arrival counts.

A new protocol is a new entry in ``PROTOCOLS``.
"""

from collections.abc import Callable
from dataclasses import dataclass

from studio.engine.errors import StudioError
from studio.engine.sources.family import Frame, gather, shown
from studio.engine.sources.jsonl import frame_from_message
from studio.engine.sources.kinect2_message import bodies_from_message
from studio.engine.sources.landmarks import bodies_from_landmarks
from studio.engine.sources.strict_json import as_object, parse_json

Message = dict[str, object]
_LANDMARK_KEYS = frozenset({"pose_world", "poseWorldLandmarks"})
Objects = list[Message]  # a message's JSON objects, one a line; most have but one


@dataclass(frozen=True)
class Protocol:
    """One way to tell of people; ``read`` raises StudioError that names the place."""

    name: str
    recognizes: Callable[[Message], bool]
    read: Callable[[Objects, float], Frame]  # given the time of arrival [s]
    is_stamped: Callable[[Message], bool]  # by the sensor


def read_objects(message: str | bytes) -> Objects:
    """Return the JSON objects of a message; raise StudioError where it is anything else."""
    try:
        text = message if isinstance(message, str) else message.decode()
    except UnicodeDecodeError as error:
        raise StudioError(f"byte {error.start}: expected text in UTF-8") from None
    lines = [text]
    if "\n" in text.strip() and text.lstrip().startswith('{"skeleton"'):
        lines = [line for line in text.split("\n") if line.strip()]
    return [as_object(parse_json(line), "a message") for line in lines]


def detect(message: Message) -> Protocol:
    """Return the protocol of a publisher's message; raise StudioError where it is none of ours."""
    for protocol in PROTOCOLS:
        if protocol.recognizes(message):
            return protocol
    names = ", ".join(protocol.name for protocol in PROTOCOLS)
    raise StudioError(f"expected a frame ({names}), found {shown(message)}")


def _read_lines(objects: Objects, arrival: float) -> Frame:  # noqa: ARG001 - they have stamps
    frames = [frame_from_message(each) for each in objects]
    bodies = ((frame.time, skeleton) for frame in frames for skeleton in (frame.bodies or (None,)))
    gathered = gather(bodies)
    if len(gathered) != 1:
        raise StudioError(
            f"expected one frame a message, found {len(gathered)}: several lines are several "
            "bodies at one time"
        )
    return gathered[0]


def _read_kinect(objects: Objects, arrival: float) -> Frame:
    return bodies_from_message(_only(objects), arrival)


def _read_landmarks(objects: Objects, arrival: float) -> Frame:
    message = _only(objects)
    return bodies_from_landmarks(message, None if _has_stamp(message) else arrival)


def _only(objects: Objects) -> Message:
    if len(objects) != 1:
        raise StudioError(f"expected one JSON object a message, found {len(objects)}")
    return objects[0]


def _has_stamp(message: Message) -> bool:
    return message.get("time") is not None


PROTOCOLS = (
    Protocol(
        "studio jsonl",
        lambda message: "skeleton" in message and not isinstance(message["skeleton"], dict | list),
        _read_lines,
        lambda _: True,
    ),
    Protocol(
        "node-kinect2",
        lambda message: "bodies" in message,
        _read_kinect,
        lambda _: False,
    ),
    Protocol(
        "Kinectron",
        lambda message: message.keys() >= {"event", "data"} or "joints" in message,
        _read_kinect,
        lambda _: False,
    ),
    Protocol(
        "MediaPipe landmarks",
        lambda message: bool(message.keys() & _LANDMARK_KEYS),
        _read_landmarks,
        _has_stamp,
    ),
)
