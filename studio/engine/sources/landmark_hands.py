"""A hand's state and shape out of MediaPipe's 21 landmarks of it.

The landmarks are the wrist (0) and four a finger from its root to its tip: thumb 1-4, index 5-8,
middle 9-12, ring 13-16, little finger 17-20.

A finger's flexion is the angle between its first bone and the line from there to its tip: near 0
for a straight finger, near 140 degrees in a fist. It does not depend on the hand's size, distance
or turn. A finger is taken for extended up to `STRAIGHT`, for folded from `FOLDED` on, in between
by degrees; a state is as sure as its least sure finger:

- Open: index, middle, ring and little finger extended
- Lasso: index and middle extended, ring and little finger folded
- Closed: all four folded
- Unknown: anything else

The thumb does not count: in a fist it may lie anywhere.
"""

import math

import numpy as np

from studio.engine.skeleton import FloatArray, Hand, HandState
from studio.engine.vectors import Vector, angle_between, subtract

LANDMARK_COUNT = 21
WRIST, THUMB_TIP, INDEX_KNUCKLE, MIDDLE_KNUCKLE, MIDDLE_TIP, LITTLE_KNUCKLE = 0, 4, 5, 9, 12, 17
STRAIGHT, FOLDED = 40.0, 90.0  # [deg] of flexion
PALM_LENGTH = 0.09  # [m] from the wrist to the middle finger's knuckle, a grown-up's
_FINGERS = (5, 9, 13, 17)  # the roots of index, middle, ring and little finger
_PATTERNS = {
    HandState.OPEN: (True, True, True, True),
    HandState.CLOSED: (False, False, False, False),
    HandState.LASSO: (True, True, False, False),
}


def hand_state(points: FloatArray) -> Hand:
    """Return the state of a hand (21, 3), all axes in one unit, and how sure that is."""
    at: list[Vector] = [(x, y, z) for x, y, z in points.tolist()]
    extended = [_extension(at, root) for root in _FINGERS]
    scores = {state: _agreement(extended, pattern) for state, pattern in _PATTERNS.items()}
    best = max(scores, key=scores.__getitem__)
    if scores[best] > 0.5:
        return Hand(best, scores[best])
    return Hand(HandState.UNKNOWN, 1.0 - scores[best])


def in_meters(points: FloatArray) -> FloatArray | None:
    """Return a hand (21, 3) of any unit in meters, from its wrist on; None where it has no size."""
    offsets = points - points[WRIST]
    palm = float(np.linalg.norm(offsets[MIDDLE_KNUCKLE]))
    if palm <= 1e-6 * float(np.abs(points).max()):
        return None
    scaled: FloatArray = offsets * (PALM_LENGTH / palm)
    return scaled if np.isfinite(scaled).all() else None


def joints_of(shape: FloatArray) -> dict[str, FloatArray]:
    """Return a Kinect's joints of a hand [m] from its wrist on, of a hand in meters (21, 3)."""
    return {
        "hand": (shape[INDEX_KNUCKLE] + shape[LITTLE_KNUCKLE]) / 3.0,  # the wrist is the third
        "hand_tip": shape[MIDDLE_TIP],
        "thumb": shape[THUMB_TIP],
    }


def _extension(at: list[Vector], root: int) -> float:
    """Return how far the finger that begins there is extended, from 0 to 1."""
    knuckle, middle, tip = at[root], at[root + 1], at[root + 3]
    flexion = math.degrees(angle_between(subtract(middle, knuckle), subtract(tip, middle)))
    if math.isnan(flexion):
        return 0.5  # a bone without length tells nothing
    return min(max((FOLDED - flexion) / (FOLDED - STRAIGHT), 0.0), 1.0)


def _agreement(extended: list[float], pattern: tuple[bool, ...]) -> float:
    return min(e if up else 1.0 - e for e, up in zip(extended, pattern, strict=True))
