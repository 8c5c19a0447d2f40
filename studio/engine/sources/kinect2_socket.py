"""kinect2-socket's JSON: hand states, but neither stamps nor joint tracking.

``{version, frames: [{bodies: [{id, leftHandState, rightHandState, joints: [25 x {x, y, z}]}]}]}``.
Version 0.1 gives hand states as the SDK's numbers, 0.3 as lower-case words; either is taken in
any 0.x. Further keys (face, gestures) are passed over. Frames are taken to come 30 a second.
"""

import re

from studio.engine.errors import StudioError
from studio.engine.skeleton import (
    FRAME_RATE,
    JOINT_COUNT,
    FloatArray,
    Joint,
    Skeleton,
    all_tracked,
)
from studio.engine.sources.family import Family, Frame, ParsedFile, shown
from studio.engine.sources.kinect2_fields import (
    HAND_KEYS,
    body_id_of,
    check_new,
    hand_of,
    is_person,
)
from studio.engine.sources.strict_json import as_list, as_object, as_positions, parse_json


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
        key in body for entry in entries for body in _bodies(entry) for key in HAND_KEYS
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
        if not is_person(body):
            continue
        try:
            skeleton = _skeleton(body, time)
            check_new(skeleton.body_id, seen)
        except StudioError as error:
            raise StudioError(f"frame {index}, body {number}: {error}") from None
        seen[skeleton.body_id] = skeleton
    return Frame(time, tuple(seen.values()))


def _bodies(entry: object) -> list[dict[str, object]]:
    bodies = as_list(as_object(entry, "a frame").get("bodies"), '"bodies"')
    return [as_object(body, "a body") for body in bodies]


def _skeleton(body: dict[str, object], time: float) -> Skeleton:
    left, right = (hand_of(body, key) for key in HAND_KEYS)
    return Skeleton(
        time=time,
        positions=_positions(body.get("joints")),
        tracking=all_tracked(),
        left_hand=left,
        right_hand=right,
        body_id=body_id_of(body.get("id"), "id"),
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


FAMILY = Family(
    "kinect2-socket JSON (0.1 and 0.3)", recognizes, lambda content: read(content.text())
)
