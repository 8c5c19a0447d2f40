"""The paper's six angles of a person's arm (Fig. 5) as arcs in space, to be drawn at the arm.

Each arc goes from one leg of its angle to the other. Two of them are moved along the body, where
they can be seen: the shoulder's yaw from the hip up to the height of the shoulder, the shoulder's
roll from the shoulder to the middle of the upper arm, about which it turns. An angle stays what it
is wherever it is drawn.
"""

import math
from dataclasses import dataclass

import numpy as np

from studio.engine.human import HumanArmAngles
from studio.engine.skeleton import FloatArray, Joint, Side, Skeleton, other_side

STEPS = 13  # points of an arc: 2 mm off a circle at most
NAMES = tuple(HumanArmAngles.__dataclass_fields__)  # in the order of `arm_arcs`
_RADII = (0.20, 0.13, 0.09, 0.11, 0.09, 0.13)  # [m] apart where two have the same vertex


@dataclass(frozen=True, eq=False)
class Arc:
    """One angle."""

    name: str  # as in `HumanArmAngles`
    points: FloatArray  # (STEPS, 3) [m] in camera space
    angle: float  # [rad] from 0 to π


def arm_arcs(skeleton: Skeleton, side: Side) -> tuple[Arc, ...]:
    """Return the arcs of one arm; one whose bones have no direction is left out.

    See `studio.engine.human.human_arm_angles` for the letters.
    """
    o, e, f, g, n, q = (
        skeleton.positions[Joint.of(part, side)]
        for part in ("hip", "shoulder", "elbow", "wrist", "thumb", "hand_tip")
    )
    d = skeleton.positions[Joint.of("shoulder", other_side(side))]
    normal_le, normal_me = np.cross(f - e, g - f), np.cross(f - e, e - d)
    level = np.array([1.0, 0.0, 1.0])
    legs = (
        (np.array([o[0], e[1], o[2]]), level * (d - o), level * (f - o)),
        (e, o - e, f - e),
        ((e + f) / 2.0, normal_le, normal_me),
        (f, e - f, g - f),
        (g, normal_le, n - g),
        (g, n - g, q - g),
    )
    found = (
        _arc(name, *leg, radius) for name, leg, radius in zip(NAMES, legs, _RADII, strict=True)
    )
    return tuple(arc for arc in found if arc is not None)


def _arc(
    name: str, vertex: FloatArray, start: FloatArray, end: FloatArray, radius: float
) -> Arc | None:
    lengths = np.linalg.norm(start), np.linalg.norm(end)
    if min(lengths) < 1e-12:
        return None
    along, other = start / lengths[0], end / lengths[1]
    across = other - (along @ other) * along
    width = float(np.linalg.norm(across))
    angle = math.atan2(width, float(along @ other))
    # Of a straight angle any plane is as good: then it is drawn as its two legs.
    aside = across / width if width > 1e-9 else np.zeros(3)
    turns = np.linspace(0.0, angle, STEPS)[:, None]
    return Arc(name, vertex + radius * (np.cos(turns) * along + np.sin(turns) * aside), angle)
