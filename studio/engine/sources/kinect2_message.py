"""One frame of node-kinect2, as the program hands it over and as Kinectron sends it on.

``{bodies: [{bodyIndex, tracked, trackingId, leftHandState, rightHandState, joints: [25 x
{cameraX, cameraY, cameraZ, trackingState, ...}]}], ...}``. Kinectron wraps it, or the one body that
it follows, as ``{event: "bodyFrame", data}`` or ``{event: "trackedBodyFrame", data}``; either is
taken, wrapped or bare. Further keys (depth, color and orientation of the joints, the floor) are
passed over, bodies that are not tracked skipped.

Camera space is the SDK's, hence ours. Where ``trackingState`` is absent, as in Kinectron, every
joint passes for tracked. A message tells no time; who receives it does.
"""

import numpy as np
from numpy.typing import NDArray

from studio.engine.errors import StudioError
from studio.engine.skeleton import JOINT_COUNT, FloatArray, Joint, Skeleton, Tracking
from studio.engine.sources.family import Frame, check_time, shown
from studio.engine.sources.kinect2_fields import (
    HAND_KEYS,
    body_id_of,
    check_new,
    hand_of,
    is_person,
)
from studio.engine.sources.strict_json import as_list, as_object, as_positions

_AXES = ("cameraX", "cameraY", "cameraZ")


def bodies_from_message(message: dict[str, object], time: float) -> Frame:
    """Return the people that a parsed message shows.

    Parameters
    ----------
    message : dict
        A body frame or a body, bare or in Kinectron's envelope.
    time : float
        When it was seen [s].

    Raises
    ------
    StudioError
        Where the message is not as the module describes it; the text names body and joint.
    """
    check_time(time, None)
    seen: dict[str, Skeleton] = {}
    for number, body in enumerate(bodies_of(message)):
        if not is_person(body):
            continue
        try:
            skeleton = skeleton_of(body, time, str(number))
            check_new(skeleton.body_id, seen)
        except StudioError as error:
            raise StudioError(f"body {number}: {error}") from None
        seen[skeleton.body_id] = skeleton
    return Frame(time, tuple(seen.values()))


def bodies_of(message: dict[str, object]) -> list[dict[str, object]]:
    """Return a message's bodies as they stand in it; raise StudioError where there is no place."""
    if "event" in message and "data" in message:
        message = as_object(message["data"], 'Kinectron\'s "data"')
    if "bodies" in message:
        return [as_object(body, "a body") for body in as_list(message["bodies"], '"bodies"')]
    if "joints" in message or "skeleton" in message:
        return [message]
    raise StudioError(
        f'expected "bodies" (node-kinect2\'s frame) or "joints" (one body), found {shown(message)}'
    )


def skeleton_of(body: dict[str, object], time: float, unnamed: str) -> Skeleton:
    """Return one tracked body; its id is its trackingId, else its bodyIndex, else ``unnamed``.

    Raises
    ------
    StudioError
        Where it is not as the module describes it; the message names key or joint.
    """
    if "joints" not in body and "skeleton" in body:
        raise StudioError(
            'expected 25 "joints" of a Kinect V2, found a "skeleton", as an Azure Kinect has it'
        )
    entries = as_list(body.get("joints"), "joints", JOINT_COUNT)
    joints = [_joint(index, entry) for index, entry in enumerate(entries)]
    left, right = (hand_of(body, key) for key in HAND_KEYS)
    return Skeleton(
        time=time,
        positions=_positions(joints),
        tracking=_tracking(joints),
        left_hand=left,
        right_hand=right,
        body_id=_body_id(body, unnamed),
    )


def tells_tracking(body: dict[str, object]) -> bool:
    """Return whether a body that was read without complaint tells its joints' tracking."""
    joints = body["joints"]
    return isinstance(joints, list) and any("trackingState" in joint for joint in joints)


def _body_id(body: dict[str, object], unnamed: str) -> str:
    for key in ("trackingId", "bodyIndex"):
        if key in body:
            return body_id_of(body[key], key)
    return unnamed


def _joint(index: int, entry: object) -> dict[str, object]:
    named = f"joint {index} ({Joint(index).name.lower()})"
    if not isinstance(entry, dict) or not entry.keys() >= set(_AXES):
        raise StudioError(f"{named}: expected {', '.join(_AXES)}, found {shown(entry)}")
    if entry.get("jointType", index) != index:
        raise StudioError(
            f'{named}: expected "jointType" {index}, since joints come in the SDK\'s order, '
            f"found {shown(entry['jointType'])}"
        )
    return entry


def _positions(joints: list[dict[str, object]]) -> FloatArray:
    return as_positions([[joint[axis] for axis in _AXES] for joint in joints])


def _tracking(joints: list[dict[str, object]]) -> NDArray[np.int8]:
    states = [joint.get("trackingState", Tracking.TRACKED.value) for joint in joints]
    for joint, state in zip(Joint, states, strict=True):
        if type(state) is not int or state not in tuple(Tracking):
            raise StudioError(
                f'joint {joint.value} ({joint.name.lower()}): expected "trackingState" 0, 1 or 2, '
                f"found {shown(state)}"
            )
    return np.array(states, dtype=np.int8)
