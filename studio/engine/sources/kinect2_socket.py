"""kinect2-socket's JSON: hand states, but neither stamps nor joint tracking.

``{version, frames: [{bodies: [{id, leftHandState, rightHandState, joints: [25 x {x, y, z}]}]}]}``.
Version 0.1 gives hand states as the SDK's numbers, 0.3 as lower-case words; either is taken in
any 0.x. Further keys (face, gestures) are passed over. Frames are taken to come 30 a second.
"""

import re
from collections.abc import Collection

from studio.engine.errors import StudioError
from studio.engine.skeleton import (
    FRAME_RATE,
    JOINT_COUNT,
    FloatArray,
    Hand,
    HandState,
    Joint,
    Skeleton,
    all_tracked,
)
from studio.engine.sources.family import Family, Frame, ParsedFile, check_body_id, shown
from studio.engine.sources.strict_json import as_list, as_object, as_positions, parse_json

_WORDS = {state.value.replace("_", ""): state for state in HandState}  # "nottracked"
_HAND_KEYS = ("leftHandState", "rightHandState")


def recognizes(head: str) -> bool:
    """Return whether a text begins as these files do."""
    return head.lstrip().startswith("{") and '"frames"' in head


def read(text: str) -> ParsedFile:
    """Return the frames of a whole file; raise StudioError that names frame, body and joint."""
    document = as_object(parse_json(text), "the recording")
    version = document.get("version")
    if not isinstance(version, str) or not re.fullmatch(r"0\.[0-9]{1,2}", version):
        raise StudioError(f'expected "version" 0.1 or 0.3, found {shown(version)}')
    entries = as_list(document.get("frames"), '"frames"')
    if not entries:
        raise StudioError('expected at least one frame in "frames", found none')
    frames = [_frame(index, entry) for index, entry in enumerate(entries)]
    tells_hands = any(
        key in body for entry in entries for body in _bodies(entry) for key in _HAND_KEYS
    )
    return ParsedFile(
        format=f"kinect2-socket {version}",
        frames=frames,
        has_hand_states=tells_hands,
        has_tracking=False,
        has_stamps=False,
    )


def _frame(index: int, entry: object) -> Frame:
    time = index / FRAME_RATE
    seen: dict[str, Skeleton] = {}
    try:
        bodies = _bodies(entry)
    except StudioError as error:
        raise StudioError(f"frame {index}: {error}") from None
    for number, body in enumerate(bodies):
        if body.get("tracked", True) in (False, 0):  # an empty seat, not a person
            continue
        try:
            skeleton = _skeleton(body, time)
            _check_new(skeleton.body_id, seen)
        except StudioError as error:
            raise StudioError(f"frame {index}, body {number}: {error}") from None
        seen[skeleton.body_id] = skeleton
    return Frame(time, tuple(seen.values()))


def _check_new(body_id: str, seen: Collection[str]) -> None:
    if body_id in seen:
        raise StudioError(f"expected each id once in a frame, found {body_id} twice")


def _bodies(entry: object) -> list[dict[str, object]]:
    bodies = as_list(as_object(entry, "a frame").get("bodies"), '"bodies"')
    return [as_object(body, "a body") for body in bodies]


def _skeleton(body: dict[str, object], time: float) -> Skeleton:
    left, right = (_hand(body, key) for key in _HAND_KEYS)
    return Skeleton(
        time=time,
        positions=_positions(body.get("joints")),
        tracking=all_tracked(),
        left_hand=left,
        right_hand=right,
        body_id=_body_id(body.get("id")),
    )


def _body_id(value: object) -> str:
    if isinstance(value, bool) or not isinstance(value, int | str):
        raise StudioError(f'expected "id" as a whole number or text, found {shown(value)}')
    body_id = str(value)
    check_body_id(body_id)
    return body_id


def _hand(body: dict[str, object], key: str) -> Hand:
    state = body.get(key, 0)
    if isinstance(state, str) and state in _WORDS:
        return Hand(_WORDS[state])
    if isinstance(state, int):
        try:
            return Hand(HandState.from_number(state))
        except ValueError:
            pass  # the message below names the key as well
    raise StudioError(
        f'expected "{key}" as 0 to {len(HandState) - 1} or one of {", ".join(_WORDS)}, '
        f"found {shown(state)}"
    )


def _positions(value: object) -> FloatArray:
    joints = as_list(value, "joints", JOINT_COUNT)
    points: list[tuple[object, object, object]] = []
    for index, joint in enumerate(joints):
        if not isinstance(joint, dict) or not joint.keys() >= {"x", "y", "z"}:
            raise StudioError(
                f"joint {index} ({Joint(index).name.lower()}): expected an object with x, y and z, "
                f"found {shown(joint)}"
            )
        points.append((joint["x"], joint["y"], joint["z"]))
    return as_positions(points)


FAMILY = Family("kinect2-socket JSON (0.1 and 0.3)", recognizes, read)
