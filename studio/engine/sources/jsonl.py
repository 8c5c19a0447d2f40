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
- A frame with nobody in it is ``{"skeleton": 1, "time": 12.3}``.
- Lines of equal time with different bodies are one frame; a body that comes again at the same time
  starts a new frame, a duplicate. Time never runs backwards. Blank lines are passed over.

Numbers are written with as many digits as it takes to read the same float64 again. The frame alone,
without the file, is what live streams and recordings carry: `skeleton_to_dict` and its inverse.
"""

import json
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from studio.engine.errors import FileError, StudioError
from studio.engine.skeleton import JOINT_COUNT, Hand, HandState, Joint, Skeleton, Tracking
from studio.engine.sources.family import (
    Family,
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
    parse_json,
)

LAYOUT_VERSION = 1


def skeleton_to_dict(skeleton: Skeleton) -> dict[str, object]:
    """Return the frame object of a skeleton, made of what JSON knows; the module describes it."""
    return {
        **_frame_with_nobody(skeleton.time),
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

    Of a `SkeletonRecording`, the frames in which nobody is seen are written too. A file appears
    under its name only when it is whole.

    Raises
    ------
    StudioError
        Where time runs backwards, or a body's id could not be read again.
    FileError
        Where the file cannot be written.
    """
    if not isinstance(target, str | os.PathLike):
        target.writelines(_lines(skeletons))
        return
    path = Path(target)
    unfinished = path.with_name(path.name + ".unfinished")
    try:
        try:
            with unfinished.open("w", encoding="utf-8", newline="\n") as stream:
                stream.writelines(_lines(skeletons))
            unfinished.replace(path)
        finally:
            unfinished.unlink(missing_ok=True)
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror or error}") from None


def recognizes(head: str) -> bool:
    """Return whether the first line is one of ours."""
    first = head.lstrip().partition("\n")[0]
    return first.startswith("{") and '"skeleton"' in first and '"frames"' not in first


def read(text: str) -> ParsedFile:
    """Return the frames of a whole file; raise StudioError that names the line."""
    frames = gather(_entries(text))
    return ParsedFile(
        format=f"studio jsonl {LAYOUT_VERSION}",
        frames=frames,
        has_hand_states=any_hand_state(frames),
        has_tracking=True,
        has_stamps=True,
    )


def _entries(text: str) -> Iterator[tuple[float, Skeleton | None]]:
    """Yield each line's time and skeleton."""
    previous: float | None = None
    for number, line in enumerate(text.split("\n"), start=1):
        if not line.strip():
            continue
        try:
            time, skeleton = _parse_frame(_parse_line(line))
            check_time(time, previous)
        except StudioError as error:
            raise StudioError(f"line {number}: {error}") from None
        previous = time
        yield time, skeleton


def _lines(skeletons: Iterable[Skeleton]) -> Iterator[str]:
    """Yield one line a frame, and check that it can be read again."""
    previous: float | None = None
    for time, skeleton in _with_gaps(skeletons):
        check_time(time, previous)
        previous = time
        if skeleton is None:
            yield json.dumps(_frame_with_nobody(time)) + "\n"
        else:
            check_body_id(skeleton.body_id)
            yield frame_to_json(skeleton) + "\n"


def _with_gaps(skeletons: Iterable[Skeleton]) -> Iterable[tuple[float, Skeleton | None]]:
    if isinstance(skeletons, SkeletonRecording):
        return skeletons.by_frame()
    return ((skeleton.time, skeleton) for skeleton in skeletons)


def _frame_with_nobody(time: float) -> dict[str, object]:
    return {"skeleton": LAYOUT_VERSION, "time": float(time)}


def _hand_to_dict(hand: Hand) -> dict[str, object]:
    return {"state": hand.state.value, "confidence": float(hand.confidence)}


def _parse_line(line: str) -> object:
    try:
        return parse_json(line)
    except StudioError as error:  # its "line 1" would mislead here
        raise StudioError(str(error).removeprefix("line 1, ")) from None


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
    for joint, state in zip(Joint, states, strict=True):
        if type(state) is not int or state not in tuple(Tracking):
            raise StudioError(
                f"joint {joint.value} ({joint.name.lower()}): expected tracking 0, 1 or 2, "
                f"found {shown(state)}"
            )
    return np.array(states, dtype=np.int8)


def _hand(value: object, what: str) -> Hand:
    hand = as_object(value, what)
    state = hand.get("state")
    if not isinstance(state, str) or state not in tuple(HandState):
        words = ", ".join(HandState)
        raise StudioError(f"expected {what}'s state as one of {words}, found {shown(state)}")
    confidence = as_number(hand.get("confidence"), f"{what}'s confidence")
    return Hand(HandState(state), confidence)


FAMILY = Family("the studio's own JSONL", recognizes, read)
