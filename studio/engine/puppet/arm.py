"""A stick arm: four angles from a hand's place and back, by two-bone inverse kinematics.

The angles are two of swing, flexion and swivel. Swing turns the line from shoulder to hand away
from a middle direction by the shortest rotation, as its rotation vector; the elbow goes along.
Parallel transport of this kind has a single pole, the opposite of the middle, which lies behind the
neck, where nobody's hand gets: so the elbow is continuous wherever the hand can be. Flexion sets
the hand's distance, and swivel turns the elbow about that line, to the outside from below.

Allowed angles are a disc of swing and two intervals. That is convex, so that an arm that moves in
these angles never leaves what is allowed, and its bones keep their lengths whatever it does.

Frame: the torso's at the left shoulder, x forward, y left, z up; a right arm is its mirror image.
"""

import math
from dataclasses import dataclass

import numpy as np

from studio.engine.skeleton import FloatArray
from studio.engine.standing import FOREARM, TO_HAND, TO_TIP, UPPER_ARM

TO_HAND_POINT = FOREARM + TO_HAND  # [m] from the elbow to what is dragged, all of it rigid
_THUMB_ACROSS = 0.042  # [m] of the thumb from the forearm's line

LARGEST_SWING = math.radians(130.0)
FLEXION = (math.radians(5.0), math.radians(150.0))  # 0 is straight, where the elbow has no side
SWIVEL = (math.radians(-30.0), math.radians(165.0))
# Of an elbow that nobody drags: out to the side and a little raised, as of somebody who wipes a
# table. Baxter's forearm then clears its desk, and dragging a hand alone pushes the block.
EASY_SWIVEL = math.radians(100.0)

# The middle of all that an arm reaches: 30° to the outside of forward, 20° below level.
_AZIMUTH, _ELEVATION = math.radians(30.0), math.radians(-20.0)
_MIDDLE = np.array(
    [
        math.cos(_ELEVATION) * math.cos(_AZIMUTH),
        math.cos(_ELEVATION) * math.sin(_AZIMUTH),
        math.sin(_ELEVATION),
    ]
)
_OUT = np.array([-math.sin(_AZIMUTH), math.cos(_AZIMUTH), 0.0])  # across the middle
_UP = np.cross(_MIDDLE, _OUT)

# How far a point of the arm moves at most [m/rad]: the hand by swing and flexion, the elbow by
# swivel. Angles times these are meters, and a hand is never faster than they are.
LEVERS = np.array([UPPER_ARM + TO_HAND_POINT, UPPER_ARM + TO_HAND_POINT, UPPER_ARM, UPPER_ARM])

NEAREST, FARTHEST = (
    math.sqrt(UPPER_ARM**2 + TO_HAND_POINT**2 + 2.0 * UPPER_ARM * TO_HAND_POINT * math.cos(bend))
    for bend in reversed(FLEXION)
)  # [m] from the shoulder to the hand


@dataclass(frozen=True, eq=False)
class ArmPoints:
    """Where an arm's joints are (3,) [m], from the shoulder."""

    elbow: FloatArray
    wrist: FloatArray
    hand: FloatArray
    tip: FloatArray
    thumb: FloatArray


def arm_points(angles: FloatArray) -> ArmPoints:
    """Return the joints of an arm with angles (4,) [rad]: swing out, swing up, flexion, swivel."""
    flexion, swivel = float(angles[2]), float(angles[3])
    line, below, aside = _transported(angles[:2])
    bulge = math.cos(swivel) * below + math.sin(swivel) * aside  # where the elbow sticks out to
    distance = _distance(flexion)
    along = (UPPER_ARM + TO_HAND_POINT * math.cos(flexion)) / distance
    across = TO_HAND_POINT * math.sin(flexion) / distance
    elbow = UPPER_ARM * (along * line + across * bulge)
    hand = distance * line
    forearm = (hand - elbow) / TO_HAND_POINT
    lean = UPPER_ARM * math.sin(flexion) / distance  # sine of forearm against line
    inner = -(lean * line + math.sqrt(1.0 - lean**2) * bulge)  # across the forearm, on its inside
    return ArmPoints(
        elbow=elbow,
        wrist=elbow + FOREARM * forearm,
        hand=hand,
        tip=elbow + (FOREARM + TO_TIP) * forearm,
        thumb=hand + _THUMB_ACROSS * inner,
    )


def reaching(hand: FloatArray, swivel: float) -> FloatArray:
    """Return the angles (4,) [rad] of an arm whose hand is at ``hand`` (3,) [m], or next to it.

    A hand that is too near or too far goes onto the sphere of what is reached, along its line from
    the shoulder; one behind the neck to the rim of what swing allows.
    """
    distance = float(np.linalg.norm(hand))
    square = min(max(distance, NEAREST), FARTHEST) ** 2
    bent = (square - UPPER_ARM**2 - TO_HAND_POINT**2) / (2.0 * UPPER_ARM * TO_HAND_POINT)
    across = np.array([_OUT @ hand, _UP @ hand])
    length = float(np.linalg.norm(across))
    turn = math.atan2(length, float(_MIDDLE @ hand))
    # Straight behind the middle every way there is as short: take the one over the outside.
    swing = across * (turn / length) if length > 0.0 else np.array([turn, 0.0])
    return allowed(np.array([swing[0], swing[1], math.acos(bent), swivel]))


def swivel_towards(angles: FloatArray, elbow: FloatArray) -> float:
    """Return the swivel [rad] by which the elbow is nearest to ``elbow`` (3,) [m], the hand fixed.

    On the line from shoulder to hand there is none: then the swivel stays.
    """
    _, below, aside = _transported(angles[:2])
    down, out = float(below @ elbow), float(aside @ elbow)
    if math.hypot(down, out) < 0.01:
        return float(angles[3])
    middle = (SWIVEL[0] + SWIVEL[1]) / 2.0
    off = math.remainder(math.atan2(out, down) - middle, math.tau)
    return min(max(middle + off, SWIVEL[0]), SWIVEL[1])


def allowed(angles: FloatArray) -> FloatArray:
    """Return the nearest allowed angles (4,) [rad]."""
    swing = float(np.hypot(angles[0], angles[1]))
    share = min(1.0, LARGEST_SWING / swing) if swing > 0.0 else 1.0
    lowest = np.array([-math.inf, -math.inf, FLEXION[0], SWIVEL[0]])
    highest = np.array([math.inf, math.inf, FLEXION[1], SWIVEL[1]])
    nearest: FloatArray = np.clip(angles * np.array([share, share, 1.0, 1.0]), lowest, highest)
    return nearest


def _distance(flexion: float) -> float:
    """Return how far the hand is from the shoulder [m], by the law of cosines."""
    return math.sqrt(
        UPPER_ARM**2 + TO_HAND_POINT**2 + 2.0 * UPPER_ARM * TO_HAND_POINT * math.cos(flexion)
    )


def _transported(swing: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the line to the hand, and what is below and aside of it: three unit vectors."""
    turn = float(np.hypot(swing[0], swing[1]))
    if turn == 0.0:
        return _MIDDLE, -_UP, _OUT
    towards = (swing[0] * _OUT + swing[1] * _UP) / turn
    line = math.cos(turn) * _MIDDLE + math.sin(turn) * towards
    tilt = (math.cos(turn) - 1.0) * towards - math.sin(turn) * _MIDDLE
    return line, -_UP - (_UP @ towards) * tilt, _OUT + (_OUT @ towards) * tilt
