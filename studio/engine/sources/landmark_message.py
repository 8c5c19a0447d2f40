"""One message of MediaPipe's landmarks, parsed and checked; `landmarks` describes the layout."""

from dataclasses import dataclass

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.skeleton import FloatArray, Side
from studio.engine.sources import landmark_body, landmark_hands
from studio.engine.sources.family import shown
from studio.engine.sources.strict_json import as_list, as_number

# Our names, and MediaPipe's own in its JavaScript results.
POSE_KEYS = ("pose_world", "poseWorldLandmarks")
_PICTURE_KEYS = ("pose_image", "poseLandmarks")
_HAND_KEYS: dict[Side, tuple[str, str]] = {
    "left": ("left_hand", "leftHandLandmarks"),
    "right": ("right_hand", "rightHandLandmarks"),
}
_FORMAT = "mediapipe-landmarks 1"
_FARTHEST = 100.0  # [m] or pictures; a larger number is no place of a landmark
_LARGEST_PICTURE = 100_000  # pixels across
_USUAL_PICTURE = (640.0, 480.0)  # what cameras give to those who ask for nothing else


@dataclass(frozen=True, eq=False)
class Landmarks:
    """What was seen of one person, in MediaPipe's own axes and units."""

    world: FloatArray  # (33, 3) [m]
    visibility: FloatArray  # (33,)
    picture: FloatArray | None  # (33, 2), 0 to 1
    size: FloatArray  # (2,) the picture's width and height in pixels
    hands: dict[Side, FloatArray | None]  # (21, 3) in the picture; sides that the message names


def parse_landmarks(message: dict[str, object]) -> Landmarks | None:
    """Return the landmarks that a message holds, or None where nobody is seen.

    Raises
    ------
    StudioError
        Where the message is not as `landmarks` describes it; the text names the place in it.
    """
    if message.get("format", _FORMAT) != _FORMAT:
        found = shown(message["format"])
        raise StudioError(f'expected "format": "{_FORMAT}", found {found}')
    if not message.keys() & set(POSE_KEYS):
        raise StudioError(f'expected "{POSE_KEYS[0]}" (or null in it), found {shown(message)}')
    pose = _points(message, POSE_KEYS, landmark_body.LANDMARK_COUNT, 3)
    hands = {
        side: _points(message, keys, landmark_hands.LANDMARK_COUNT, 3)
        for side, keys in _HAND_KEYS.items()
        if message.keys() & set(keys)
    }
    picture = _points(message, _PICTURE_KEYS, landmark_body.LANDMARK_COUNT, 2)
    size = _size(message.get("image"))
    if pose is None:
        return None
    return Landmarks(
        world=pose[:, :3],
        visibility=pose[:, 3],
        picture=None if picture is None else picture[:, :2],
        size=size,
        hands={side: None if hand is None else hand[:, :3] for side, hand in hands.items()},
    )


def _points(
    message: dict[str, object], keys: tuple[str, str], count: int, axes: int
) -> FloatArray | None:
    """Return landmarks as rows of ``axes`` coordinates and the visibility; None for none."""
    key = next((key for key in keys if key in message), keys[0])
    value = message.get(key)
    if value is None or value == []:
        return None
    entries = as_list(value, f'"{key}"')
    if len(entries) == 1 and isinstance(entries[0], list):  # one list a person, of one person
        entries = entries[0]
    if len(entries) != count:
        raise StudioError(f'expected {count} landmarks in "{key}", found {len(entries)}')
    return np.array([_point(entry, f'"{key}", {n}', axes) for n, entry in enumerate(entries)])


def _point(entry: object, place: str, axes: int) -> list[float]:
    if isinstance(entry, dict):
        visibility = entry.get("visibility", 1.0)
        entry = [entry.get(axis) for axis in "xyz"[:axes]] + [visibility]
    values = as_list(entry, f"{place}: coordinates")
    if len(values) < axes:
        raise StudioError(f"{place}: expected {axes} coordinates or more, found {len(values)}")
    point = [as_number(value, f"{place}: a coordinate") for value in values[:axes]]
    if max(map(abs, point)) > _FARTHEST:
        raise StudioError(f"{place}: expected coordinates up to {_FARTHEST:g}, found {point}")
    visibility = as_number(values[3], f"{place}: visibility") if len(values) > 3 else 1.0
    return [*point, min(max(visibility, 0.0), 1.0)]


def _size(value: object) -> FloatArray:
    if value is None:
        return np.array(_USUAL_PICTURE)
    pixels = [as_number(each, '"image"') for each in as_list(value, '"image"')]
    if len(pixels) != 2 or not all(1.0 <= each <= _LARGEST_PICTURE for each in pixels):
        raise StudioError(f'expected "image" as a width and a height in pixels, found {pixels}')
    return np.array(pixels)
