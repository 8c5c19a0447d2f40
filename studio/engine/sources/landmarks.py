"""MediaPipe's landmarks of one person a frame: what a webcam's tracker sends and files hold.

One JSON object a line::

    {"format": "mediapipe-landmarks 1", "time": 12.3, "image": [640, 480],
     "pose_world": [[x, y, z, visibility], ... 33 of them], "pose_image": [[x, y], ... 33],
     "left_hand": [[x, y, z], ... 21], "right_hand": null}

- ``time`` is in seconds from any origin, ``image`` the picture's width and height in pixels.
- ``pose_world`` is in meters from the middle of the hips, in MediaPipe's axes (x right in the
  picture, y down, z away); null where nobody is seen. ``visibility`` runs from 0 to 1.
- ``pose_image`` is where the same landmarks are in the picture: 0 to 1 across its width and height.
- ``left_hand`` and ``right_hand``, the person's own, are in the picture too; z is in units of its
  width, from the wrist on. Null where a hand is not seen: its state is then not_tracked.
- The picture is as the camera sees it, not mirrored.

MediaPipe's own JavaScript results are taken as well: ``poseWorldLandmarks``, ``poseLandmarks``,
``leftHandLandmarks`` and ``rightHandLandmarks``, landmarks as ``{x, y, z, visibility}``, either
alone or as the first of a list of people. What they leave out is assumed: a picture of 640 x 480,
everything visible, 30 frames a second.

Numbers, axes and scales of the landmarks are those that MediaPipe documents for its pose and hand
landmarkers. The joints come from the body (`landmark_body`); hand, hand tip and thumb from the
hand's own landmarks where there are any, which are finer (`landmark_hands`).
"""

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from studio.engine.errors import StudioError
from studio.engine.skeleton import (
    FRAME_RATE,
    SIDES,
    FloatArray,
    Hand,
    HandState,
    Joint,
    Side,
    Skeleton,
    Tracking,
)
from studio.engine.sources import landmark_body, landmark_hands
from studio.engine.sources.family import Family, Frame, ParsedFile, any_hand_state, check_time
from studio.engine.sources.landmark_message import POSE_KEYS, Landmarks, parse_landmarks
from studio.engine.sources.strict_json import as_number, as_object, json_entries, json_lines


def bodies_from_landmarks(message: dict[str, object], time: float | None = None) -> Frame:
    """Return the person that a message shows, if any, in a Kinect's joints and camera space.

    Parameters
    ----------
    message : dict
        One parsed line, as the module describes it.
    time : float, optional
        When it was seen [s]; without it the message's own ``time`` is taken.

    Raises
    ------
    StudioError
        Where the message is not as the module describes it; the text names the place in it.
    """
    if time is None:
        time = as_number(message.get("time"), '"time"')
    check_time(time, None)
    seen = parse_landmarks(message)
    return Frame(time) if seen is None else Frame(time, (_skeleton(seen, time),))


def recognizes(head: str) -> bool:
    """Return whether the first line is a frame of landmarks."""
    return head.lstrip().startswith("{") and _names_a_pose(head.lstrip().partition("\n")[0])


def recognizes_list(head: str) -> bool:
    """Return whether a text begins as a list of such frames."""
    return head.lstrip().startswith("[") and _names_a_pose(head)


def read(lines: Iterable[str]) -> ParsedFile:
    """Return the frames of a whole file; raise StudioError that names the line."""
    return _read(json_lines(lines))


def read_list(text: str) -> ParsedFile:
    """Return the frames of a file that is one list; raise StudioError that names the entry."""
    return _read(json_entries(text))


def _names_a_pose(text: str) -> bool:
    return any(f'"{key}"' in text for key in POSE_KEYS)


def _read(entries: Iterator[tuple[str, object]]) -> ParsedFile:
    frames: list[Frame] = []
    has_stamps = False
    for place, value in entries:
        try:
            message = as_object(value, "a frame")
            has_stamps = has_stamps if frames else "time" in message
            frame = bodies_from_landmarks(message, None if has_stamps else len(frames) / FRAME_RATE)
            check_time(frame.time, frames[-1].time if frames else None)
        except StudioError as error:
            raise StudioError(f"{place}: {error}") from None
        frames.append(frame)
    return ParsedFile(
        format="mediapipe-landmarks 1",
        frames=frames,
        has_hand_states=any_hand_state(frames),
        has_tracking=True,
        has_stamps=has_stamps,
    )


def _skeleton(seen: Landmarks, time: float) -> Skeleton:
    place = landmark_body.place_of(seen.world, seen.visibility, seen.picture, seen.size)
    joints = landmark_body.joints_of(seen.world) + place
    tracking = landmark_body.tracking_of(seen.visibility, seen.picture)
    states: dict[Side, Hand] = {}
    for side in SIDES:
        states[side] = _take_hand(seen, side, joints, tracking)
    return Skeleton(
        time,
        landmark_body.to_camera_space(joints),
        tracking,
        left_hand=states["left"],
        right_hand=states["right"],
    )


def _take_hand(seen: Landmarks, side: Side, joints: FloatArray, tracking: NDArray[np.int8]) -> Hand:
    """Return a hand's state, and put what its own landmarks tell into joints and tracking."""
    if side not in seen.hands:
        return Hand(HandState.UNKNOWN)
    points = seen.hands[side]
    if points is None:
        return Hand(HandState.NOT_TRACKED)
    width, height = seen.size.tolist()
    shape = landmark_hands.in_meters(points * (width, height, width))
    if shape is None:
        return Hand(HandState.NOT_TRACKED)
    wrist = joints[Joint.of("wrist", side)]
    for part, offset in landmark_hands.joints_of(shape).items():
        joints[Joint.of(part, side)] = wrist + offset
        tracking[Joint.of(part, side)] = Tracking.TRACKED
    return landmark_hands.hand_state(shape)


FAMILY = Family(
    "MediaPipe's landmarks (JSON lines)", recognizes, lambda content: read(content.lines())
)
LIST_FAMILY = Family(
    "MediaPipe's landmarks (one JSON list)",
    recognizes_list,
    lambda content: read_list(content.text()),
)
