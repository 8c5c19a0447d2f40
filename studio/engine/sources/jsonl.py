"""The studio's own skeleton file: one frame a line, as JSON, and the only one that loses nothing.

A line with a body (shown here on several)::

    {"skeleton": 1, "time": 12.3, "body": "0",
     "positions": [[x, y, z], ... 25 of them], "tracking": [2, ... 25 of them],
     "left_hand": {"state": "open", "confidence": 1.0},
     "right_hand": {"state": "not_tracked", "confidence": 1.0}}

- ``skeleton`` is the version of this layout, ``time`` is in seconds from any origin, ``body`` is
  the id of the person as text.
- ``positions`` are in meters in the sensor's camera space (see `studio.engine.skeleton`), in the
  order of `Joint`; ``tracking`` is 0 (not tracked), 1 (inferred) or 2 (tracked) for each joint.
- ``state`` is unknown, not_tracked, open, closed or lasso; ``confidence`` lies between 0 and 1.
- Every key is needed; further keys are passed over. NaN and Infinity are refused.
- The first line may say of the whole file what its source told, all else being made up:
  ``"tells": ["hand_states", "tracking", "stamps"]``, or some of them. Without it, tracking and
  stamps pass for told, and hand states if any is known.
- A frame with nobody in it is ``{"skeleton": 1, "time": 12.3}``.
- Lines of equal time with different bodies are one frame; a body that comes again at the same time
  starts a new frame, a duplicate. Time never runs backwards. Blank lines are passed over.

Numbers are written with as many digits as it takes to read the same float64 again. The frame alone,
without the file, is what live streams and recordings carry: `skeleton_to_dict` and its inverse.
"""

import json
import os
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from studio.engine.errors import StudioError
from studio.engine.skeleton import JOINT_COUNT, Hand, HandState, Joint, Skeleton, Tracking
from studio.engine.sources.family import (
    TELLS,
    Family,
    Frame,
    ParsedFile,
    any_hand_state,
    check_body_id,
    check_time,
    gather,
    shown,
)
from studio.engine.sources.recording import SkeletonRecording
from studio.engine.sources.strict_json import (
    as_list,
    as_number,
    as_object,
    as_positions,
    json_lines,
    parse_json,
)
from studio.engine.sources.whole_file import written_whole

LAYOUT_VERSION = 1
_JOINTS = tuple(Joint)  # to go through an enumeration itself is slow, and recordings are long
_TRACKING, _HAND_STATES = frozenset(map(int, Tracking)), frozenset(map(str, HandState))


def skeleton_to_dict(skeleton: Skeleton) -> dict[str, object]:
    """Return the frame object of a skeleton, made of what JSON knows; the module describes it."""
    return {
        **nobody_to_dict(skeleton.time),
        "body": skeleton.body_id,
        "positions": skeleton.positions.tolist(),
        "tracking": skeleton.tracking.tolist(),
        "left_hand": _hand_to_dict(skeleton.left_hand),
        "right_hand": _hand_to_dict(skeleton.right_hand),
    }


def skeleton_from_dict(frame: object) -> Skeleton | None:
    """Return the skeleton that a frame object holds, or None where nobody is in it.

    Raises
    ------
    StudioError
        Where the object is not as the module describes it; the message names the key.
    """
    return _parse_frame(frame)[1]


def frame_from_message(message: dict[str, object]) -> Frame:
    """Return the frame of one parsed line or message: one body, or nobody.

    Raises
    ------
    StudioError
        Where the object is not as the module describes it; the message names the key.
    """
    time, skeleton = _parse_frame(message)
    return Frame(time, () if skeleton is None else (skeleton,))


def frame_to_json(skeleton: Skeleton) -> str:
    """Return a skeleton's frame object as one line of JSON, without the line's end."""
    return json.dumps(skeleton_to_dict(skeleton), allow_nan=False)


def frame_from_json(line: str) -> Skeleton | None:
    """Return the skeleton that a line holds, or None where nobody is in it.

    Raises
    ------
    StudioError
        Where the line is not JSON or not a frame as the module describes it.
    """
    return skeleton_from_dict(parse_json(line))


def write_skeletons(target: str | os.PathLike[str] | TextIO, skeletons: Iterable[Skeleton]) -> None:
    """Write skeletons to a file or an open text stream, one a line.

    Of a `SkeletonRecording`, the frames in which nobody is seen are written too, and what it does
    not tell. A file appears under its name only when it is whole.

    Raises
    ------
    StudioError
        Where time runs backwards, or a body's id could not be read again.
    FileError
        Where the file cannot be written.
    """
    if isinstance(skeletons, SkeletonRecording):
        lines = file_to_lines(skeletons.as_parsed())
    else:
        lines = _lines((skeleton.time, skeleton) for skeleton in skeletons)
    if not isinstance(target, str | os.PathLike):
        target.writelines(lines)
        return
    with written_whole(Path(target)) as path, path.open("w", encoding="utf-8") as stream:
        stream.writelines(lines)


def frames_to_lines(frames: Iterable[Frame], tells: Sequence[str] | None = None) -> Iterator[str]:
    """Yield all bodies of all frames as the lines of a file, each with its end.

    ``tells`` are names of `TELLS`, for the first line; None leaves them to be guessed.

    Raises
    ------
    StudioError
        Where time runs backwards, or a body's id could not be read again.
    """
    entries = ((frame.time, body) for frame in frames for body in (frame.bodies or (None,)))
    return _lines(entries, tells)


def file_to_lines(parsed: ParsedFile) -> Iterator[str]:
    """Yield a whole file as the lines of ours; what it tells is said unless it would be guessed."""
    is_guessed = parsed.tells == _guessed(parsed.frames)
    return frames_to_lines(parsed.frames, None if is_guessed else parsed.tells)


def recognizes(head: str) -> bool:
    """Return whether the first line is one of ours."""
    first = head.lstrip().partition("\n")[0]
    others = ('"frames"', '"bodies"')  # where a skeleton is something else
    return (
        first.startswith("{")
        and '"skeleton"' in first
        and not any(other in first for other in others)
    )


def read(lines: Iterable[str]) -> ParsedFile:
    """Return the frames of a file's lines; raise StudioError that names the line."""
    values = json_lines(lines)
    first = list(islice(values, 1))
    told = _told(first)
    frames = gather(_entries(chain(first, values)))
    tells = _guessed(frames) if told is None else told
    hands, tracking, stamps = (name in tells for name in TELLS)
    return ParsedFile(f"studio jsonl {LAYOUT_VERSION}", frames, hands, tracking, stamps)


def _guessed(frames: Iterable[Frame]) -> tuple[str, ...]:
    """Return what passes for told in a file that does not say."""
    return TELLS if any_hand_state(frames) else TELLS[1:]


def _told(first: Sequence[tuple[str, object]]) -> list[object] | None:
    """Return what the first line says that its file tells; None where it does not say."""
    for place, value in first:
        if isinstance(value, dict) and "tells" in value:
            tells = value["tells"]
            if not isinstance(tells, list) or any(name not in TELLS for name in tells):
                names = ", ".join(TELLS)
                raise StudioError(
                    f'{place}: expected "tells" as a list out of {names}, found {shown(tells)}'
                )
            return tells
    return None


def _entries(values: Iterable[tuple[str, object]]) -> Iterator[tuple[float, Skeleton | None]]:
    """Yield each line's time and skeleton."""
    previous: float | None = None
    for place, value in values:
        try:
            time, skeleton = _parse_frame(value)
            check_time(time, previous)
        except StudioError as error:
            raise StudioError(f"{place}: {error}") from None
        previous = time
        yield time, skeleton


def _lines(
    entries: Iterable[tuple[float, Skeleton | None]], tells: Sequence[str] | None = None
) -> Iterator[str]:
    """Yield one line an entry, and check that it can be read again."""
    previous: float | None = None
    more: dict[str, object] = {} if tells is None else {"tells": list(tells)}
    for time, skeleton in entries:
        check_time(time, previous)
        previous = time
        if skeleton is not None:
            check_body_id(skeleton.body_id)
        frame = nobody_to_dict(time) if skeleton is None else skeleton_to_dict(skeleton)
        yield json.dumps(frame | more, allow_nan=False) + "\n"
        more = {}


def nobody_to_dict(time: float) -> dict[str, object]:
    """Return the frame object of a frame with nobody in it."""
    return {"skeleton": LAYOUT_VERSION, "time": float(time)}


def _hand_to_dict(hand: Hand) -> dict[str, object]:
    return {"state": hand.state.value, "confidence": float(hand.confidence)}


def _parse_frame(value: object) -> tuple[float, Skeleton | None]:
    frame = as_object(value, "a frame")
    version = frame.get("skeleton")
    if type(version) is not int or version != LAYOUT_VERSION:
        raise StudioError(f'expected "skeleton": {LAYOUT_VERSION}, found {shown(version)}')
    time = as_number(frame.get("time"), '"time"')
    check_time(time, None)
    if not frame.keys() & {"body", "positions", "tracking", "left_hand", "right_hand"}:
        return time, None
    body = frame.get("body")
    if not isinstance(body, str):
        raise StudioError(f'expected "body" as text, found {shown(body)}')
    check_body_id(body)
    points = as_list(frame.get("positions"), '"positions"', JOINT_COUNT)
    return time, Skeleton(
        time=time,
        positions=as_positions([as_list(point, "coordinates", 3) for point in points]),
        tracking=_tracking(frame.get("tracking")),
        left_hand=_hand(frame.get("left_hand"), '"left_hand"'),
        right_hand=_hand(frame.get("right_hand"), '"right_hand"'),
        body_id=body,
    )


def _tracking(value: object) -> NDArray[np.int8]:
    states = as_list(value, '"tracking" states', JOINT_COUNT)
    for joint, state in zip(_JOINTS, states, strict=True):
        if type(state) is not int or state not in _TRACKING:
            raise StudioError(
                f"joint {joint.value} ({joint.name.lower()}): expected tracking 0, 1 or 2, "
                f"found {shown(state)}"
            )
    return np.array(states, dtype=np.int8)


def _hand(value: object, what: str) -> Hand:
    hand = as_object(value, what)
    state = hand.get("state")
    if not isinstance(state, str) or state not in _HAND_STATES:
        words = ", ".join(HandState)
        raise StudioError(f"expected {what}'s state as one of {words}, found {shown(state)}")
    confidence = as_number(hand.get("confidence"), f"{what}'s confidence")
    return Hand(HandState(state), confidence)


FAMILY = Family("the studio's own JSONL", recognizes, lambda content: read(content.lines()))
