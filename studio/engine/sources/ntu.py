"""NTU RGB+D's ``.skeleton``: the largest public corpus of people before a Kinect V2.

Text: the number of frames; for each frame the number of bodies; for each body a line of ten fields
(``bodyID clippedEdges handLeftConfidence handLeftState handRightConfidence handRightState
isRestricted leanX leanY trackingState``), the line ``25`` and 25 lines of twelve (``x y z depthX
depthY colorX colorY qW qX qY qZ trackingState``). Hand states and tracking are the SDK's numbers.

A hand's confidence is 0 or 1 here and tells that the hand is tracked, not that its state is
certain. There are no stamps: 30 frames a second. Frames without anybody are kept. The same
extension is used for sets of hands as a HoloLens sees them (for each hand its number, the line
``26`` or ``27`` and as many lines of ``x y z``): refused.
"""

from collections.abc import Iterable, Iterator

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.skeleton import FRAME_RATE, JOINT_COUNT, Hand, HandState, Joint, Skeleton
from studio.engine.sources.family import (
    Family,
    Frame,
    ParsedFile,
    any_hand_state,
    check_body_id,
    shown,
)
from studio.engine.sources.kinect2_fields import check_new

_BODY_FIELDS, _JOINT_FIELDS = 10, 12
_HOLOLENS_JOINTS, _HOLOLENS_FIELDS = ("26", "27"), 3
_MOST_DIGITS = 9  # of a count
_Lines = Iterator[tuple[int, list[str]]]  # the line's number, from 1, and its fields


def recognizes(head: str) -> bool:
    """Return whether a text begins with counts alone, then a body's ten fields.

    A file in which nobody is ever seen, and the HoloLens's look-alike, are recognized as well.
    """
    lines = [line.split() for line in head.split("\n", 1000)[:-1] if line.strip()]
    first = next((index for index, line in enumerate(lines) if len(line) > 1), len(lines))
    counts = lines[:first]
    if not counts or not all(_is_count(fields[0]) for fields in counts):
        return False
    if first == len(lines):
        return len(counts) > 1 and all(int(fields[0]) == 0 for fields in counts[1:])
    if len(lines[first]) == _HOLOLENS_FIELDS:
        return counts[-1][0] in _HOLOLENS_JOINTS
    return first > 1 and len(lines[first]) == _BODY_FIELDS


def read(text: Iterable[str]) -> ParsedFile:
    """Return the frames of a file's lines; raise StudioError that names the line."""
    lines: _Lines = (
        (number, line.split()) for number, line in enumerate(text, start=1) if line.strip()
    )
    expected = _count(lines, "the number of frames")
    frames: list[Frame] = []
    while len(frames) < expected:
        frames.append(_frame(lines, len(frames)))
    for number, fields in lines:
        raise StudioError(
            f"line {number}: expected the end after {expected} frames, found {shown(fields)}"
        )
    return ParsedFile(
        format="ntu rgb+d",
        frames=frames,
        has_hand_states=any_hand_state(frames),
        has_tracking=True,
        has_stamps=False,
    )


def _frame(lines: _Lines, index: int) -> Frame:
    time = index / FRAME_RATE
    bodies: dict[str, Skeleton] = {}
    for _ in range(_count(lines, f"the number of bodies in frame {index}")):
        number, fields = _next(lines, f"a body of frame {index}")
        try:
            _check_width(fields, _BODY_FIELDS, "fields of a body")
            check_body_id(fields[0])
            check_new(fields[0], bodies)
            left, right = (_hand(fields[at : at + 2]) for at in (2, 4))
        except StudioError as error:
            raise StudioError(f"line {number}: {error}") from None
        positions, tracking = _joints(lines)
        bodies[fields[0]] = Skeleton(time, positions, tracking, left, right, fields[0])
    return Frame(time, tuple(bodies.values()))


def _joints(lines: _Lines) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (25, 3) [m] and tracking (25,)."""
    number, fields = _next(lines, "the number of joints")
    if fields != [str(JOINT_COUNT)]:
        hint = _hololens_hint(fields[0] in _HOLOLENS_JOINTS)
        raise StudioError(
            f"line {number}: expected {JOINT_COUNT} as the number of joints, "
            f"found {shown(' '.join(fields))}{hint}"
        )
    positions, tracking = np.empty((JOINT_COUNT, 3)), np.empty(JOINT_COUNT, dtype=np.int8)
    for joint in Joint:
        named = f"joint {joint.value} ({joint.name.lower()})"
        number, fields = _next(lines, named)
        try:
            _check_width(fields, _JOINT_FIELDS, "values")
            positions[joint] = [_number(field) for field in fields[:3]]
            tracking[joint] = _choice(fields[-1], 3, "a tracking state")
        except StudioError as error:
            raise StudioError(f"line {number}, {named}: {error}") from None
    return positions, tracking


def _hand(fields: list[str]) -> Hand:
    confidence = _choice(fields[0], 2, "a hand's confidence")
    state = _choice(fields[1], len(HandState), "a hand's state")
    return Hand(HandState.from_number(state), float(confidence))


def _next(lines: _Lines, what: str) -> tuple[int, list[str]]:
    found = next(lines, None)
    if found is None:
        raise StudioError(f"expected {what}, found the end: the file seems to be cut off")
    return found


def _count(lines: _Lines, what: str) -> int:
    number, fields = _next(lines, what)
    if len(fields) != 1 or not _is_count(fields[0]):
        raise StudioError(f"line {number}: expected {what}, found {shown(' '.join(fields))}")
    return int(fields[0])


def _check_width(fields: list[str], expected: int, what: str) -> None:
    if len(fields) != expected:
        hint = _hololens_hint(len(fields) in (1, _HOLOLENS_FIELDS))
        raise StudioError(f"expected {expected} {what}, found {len(fields)}{hint}")


def _hololens_hint(looks_alike: bool) -> str:
    if not looks_alike:
        return ""
    return ": 26 joints of 3 values are a hand as a HoloLens sees it, which is no body"


def _is_count(field: str) -> bool:
    return field.isascii() and field.isdecimal() and len(field) <= _MOST_DIGITS


def _choice(field: str, count: int, what: str) -> int:
    if not (_is_count(field) and int(field) < count):
        raise StudioError(f"expected {what} from 0 to {count - 1}, found {shown(field)}")
    return int(field)


def _number(field: str) -> float:
    try:
        number = float(field) if field.isascii() and "_" not in field else np.nan
    except ValueError:
        number = np.nan
    if not -np.inf < number < np.inf:
        raise StudioError(f"expected a position in meters, found {shown(field)}")
    return number


FAMILY = Family("NTU RGB+D's .skeleton", recognizes, lambda content: read(content.lines()))
