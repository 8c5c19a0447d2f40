"""A person as a Kinect V2 sees one: 25 joints, how surely each is tracked, and two hand states."""

import math
from dataclasses import dataclass
from enum import IntEnum, StrEnum
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from studio.engine.errors import StudioError

FloatArray = NDArray[np.float64]
Side = Literal["left", "right"]
SIDES: tuple[Side, Side] = ("left", "right")
FRAME_RATE = 30.0  # Hz, a Kinect V2's; what a file without stamps is taken to have


class Joint(IntEnum):
    """The 25 joints in the Kinect SDK's order; "left" is the person's own left."""

    SPINE_BASE = 0
    SPINE_MID = 1
    NECK = 2
    HEAD = 3
    SHOULDER_LEFT = 4
    ELBOW_LEFT = 5
    WRIST_LEFT = 6
    HAND_LEFT = 7
    SHOULDER_RIGHT = 8
    ELBOW_RIGHT = 9
    WRIST_RIGHT = 10
    HAND_RIGHT = 11
    HIP_LEFT = 12
    KNEE_LEFT = 13
    ANKLE_LEFT = 14
    FOOT_LEFT = 15
    HIP_RIGHT = 16
    KNEE_RIGHT = 17
    ANKLE_RIGHT = 18
    FOOT_RIGHT = 19
    SPINE_SHOULDER = 20
    HAND_TIP_LEFT = 21
    THUMB_LEFT = 22
    HAND_TIP_RIGHT = 23
    THUMB_RIGHT = 24

    @classmethod
    def of(cls, part: str, side: Side) -> "Joint":
        """Return the joint of one side: ``Joint.of("elbow", "left")``."""
        return cls[f"{part}_{side}".upper()]


JOINT_COUNT = len(Joint)

BONES: tuple[tuple[Joint, Joint], ...] = (
    (Joint.SPINE_BASE, Joint.SPINE_MID),
    (Joint.SPINE_MID, Joint.SPINE_SHOULDER),
    (Joint.SPINE_SHOULDER, Joint.NECK),
    (Joint.NECK, Joint.HEAD),
    (Joint.SPINE_SHOULDER, Joint.SHOULDER_LEFT),
    (Joint.SHOULDER_LEFT, Joint.ELBOW_LEFT),
    (Joint.ELBOW_LEFT, Joint.WRIST_LEFT),
    (Joint.WRIST_LEFT, Joint.HAND_LEFT),
    (Joint.HAND_LEFT, Joint.HAND_TIP_LEFT),
    (Joint.WRIST_LEFT, Joint.THUMB_LEFT),
    (Joint.SPINE_SHOULDER, Joint.SHOULDER_RIGHT),
    (Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT),
    (Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT),
    (Joint.WRIST_RIGHT, Joint.HAND_RIGHT),
    (Joint.HAND_RIGHT, Joint.HAND_TIP_RIGHT),
    (Joint.WRIST_RIGHT, Joint.THUMB_RIGHT),
    (Joint.SPINE_BASE, Joint.HIP_LEFT),
    (Joint.HIP_LEFT, Joint.KNEE_LEFT),
    (Joint.KNEE_LEFT, Joint.ANKLE_LEFT),
    (Joint.ANKLE_LEFT, Joint.FOOT_LEFT),
    (Joint.SPINE_BASE, Joint.HIP_RIGHT),
    (Joint.HIP_RIGHT, Joint.KNEE_RIGHT),
    (Joint.KNEE_RIGHT, Joint.ANKLE_RIGHT),
    (Joint.ANKLE_RIGHT, Joint.FOOT_RIGHT),
)


class Tracking(IntEnum):
    """How surely the sensor sees a joint, as the SDK numbers it."""

    NOT_TRACKED = 0
    INFERRED = 1
    TRACKED = 2


class HandState(StrEnum):
    """What the sensor takes a hand to be doing."""

    UNKNOWN = "unknown"
    NOT_TRACKED = "not_tracked"
    OPEN = "open"
    CLOSED = "closed"
    LASSO = "lasso"

    @classmethod
    def from_number(cls, number: int) -> "HandState":
        """Return the state that the SDK gives this number (0 to 4); raise ValueError for others."""
        return tuple(cls)[_checked_index(number, len(cls))]


def _checked_index(number: int, count: int) -> int:
    if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < count:
        raise ValueError(f"expected a whole number from 0 to {count - 1}, found {number!r}")
    return number


@dataclass(frozen=True)
class Hand:
    """A hand's state and how sure the sensor is of it (0 to 1; 1 where a source does not say)."""

    state: HandState = HandState.UNKNOWN
    confidence: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.confidence <= 1.0:
            raise StudioError(f"a hand's confidence lies between 0 and 1, not {self.confidence!r}")


@dataclass(frozen=True, eq=False)
class Skeleton:
    """One body in one frame.

    Positions are in the sensor's camera space: meters, right-handed, y up, z away from the
    sensor, x to the right of a person who faces the sensor.

    Raises
    ------
    StudioError
        Where the time or a position is not finite, or a shape is wrong.
    """

    time: float  # [s], from any origin that the whole stream shares
    positions: FloatArray  # (25, 3) [m]
    tracking: NDArray[np.int8]  # (25,), values of Tracking
    left_hand: Hand = Hand()
    right_hand: Hand = Hand()
    body_id: str = "0"

    def __post_init__(self) -> None:
        if not math.isfinite(self.time):
            raise StudioError(f"a skeleton's time must be finite, not {self.time!r}")
        positions = _owned(self.positions, np.float64)
        tracking = _owned(self.tracking, np.int8)
        if positions.shape != (JOINT_COUNT, 3) or tracking.shape != (JOINT_COUNT,):
            raise StudioError(
                f"a skeleton has positions (25, 3) and tracking (25,), "
                f"not {positions.shape} and {tracking.shape}"
            )
        if not np.isfinite(positions).all():
            joint = Joint(int(np.argwhere(~np.isfinite(positions))[0, 0]))
            raise StudioError(f"the position of {joint.name.lower()} is not finite")
        if tracking.min() < Tracking.NOT_TRACKED or tracking.max() > Tracking.TRACKED:
            raise StudioError("a joint's tracking state is 0, 1 or 2")
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "tracking", tracking)

    def hand(self, side: Side) -> Hand:
        """Return the hand of that side."""
        return self.left_hand if side == "left" else self.right_hand


def other_side(side: Side) -> Side:
    """Return the other side."""
    return "right" if side == "left" else "left"


def all_tracked() -> NDArray[np.int8]:
    """Return the tracking states (25,) of a source that does not tell them: every joint tracked."""
    return np.full(JOINT_COUNT, Tracking.TRACKED, dtype=np.int8)


def _owned(values: ArrayLike, dtype: type[np.generic]) -> NDArray[np.generic]:
    """Return a read-only copy, so that nobody can change a skeleton after it was checked."""
    copy = np.array(values, dtype=dtype)
    copy.setflags(write=False)
    return copy
