"""How a scene's task is done by hand: a sequence of strokes of one arm, or of both at once.

A stroke leads the hand straight to a place; the places follow from where blocks and zones are.
Frame and units as in `studio.engine.scene`, told for the left arm; the right one's y is reversed.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.scene import Block, Desk, Scene, Zone
from studio.engine.skeleton import HandState, Side
from studio.engine.sources.arm_goals import HandGoal
from studio.engine.success import Condition, Down, InZone, Lifted

# Baxter's hand without fingers is a box of 6 x 10 x 5 cm, on a wrist of 10 cm across.
HAND = 0.06  # [m] from its middle to what it pushes with
ROOM = 0.06  # [m] between it and a block, before and after
TILT = -45.0  # [deg] of the forearm while it pushes
PUSHING = 0.115  # [m] above the desk of the hand's middle: the guard keeps it off the desk
OVER = 0.20  # [m] above the desk on the way
TOPPLING = 0.75  # of a block's height, where a push makes it fall
AFTER = 0.10  # [m] that a hand goes on behind where the falling block stood
SLOW, QUICK = 0.16, 0.30  # [m/s] on the average: while it pushes, and on the way
SHORTEST, USUAL_TIME = 0.7, 1.2  # [s] a stroke
HEADING = -10.0  # [deg] where a level hand points: a little inward, which it reaches best
BETWEEN_FINGERS = 0.14  # [m] from the hand's link to between the fingers' tips
CAREFUL = 0.003  # [m] by which people miss what they grasp
GRASP = 0.72  # of a block's height, where it is grasped
SET_DOWN = 0.003  # [m] above where it was grasped, so that it is not pressed into the desk


@dataclass(frozen=True)
class Stroke:
    """Both hands go to places, or stay (None), while the person's right hand shows something."""

    seconds: float
    left: HandGoal | None = None
    right: HandGoal | None = None  # as if it were the left one
    grip: HandState = HandState.OPEN


def strokes_of(scene: Scene) -> list[Stroke]:
    """Return how a scene's task is done.

    Raises
    ------
    StudioError
        Where the demonstrator knows no way to fulfill a condition.
    """
    plans: dict[Side, list[Stroke]] = {"left": [], "right": []}
    conditions = list(scene.success.conditions)
    while conditions:
        first = conditions.pop(0)
        side: Side = first.arm or "left"
        told = mirrored(scene) if side == "right" else scene
        following = conditions[0] if conditions else None
        if isinstance(first, Lifted) and isinstance(following, InZone):
            conditions.pop(0)
            block, zone = _block(told, first), _zone(told, following)
            plans[side] += _carry(told.desk, block, zone, first.height)
        else:
            plans[side] += _simple(told, first)
    return _together(plans["left"], plans["right"])


def mirrored(scene: Scene) -> Scene:
    """Return a scene as it is for the other arm."""
    return replace(
        scene,
        desk=scene.desk.mirrored,
        blocks=tuple(block.mirrored for block in scene.blocks),
        zones=tuple(zone.mirrored for zone in scene.zones),
    )


def _simple(scene: Scene, condition: Condition) -> list[Stroke]:
    block = _block(scene, condition)
    match condition:
        case Down():
            return list(_topple(scene.desk, block))
        case InZone():
            return list(_push(scene.desk, block, _zone(scene, condition)))
        case Lifted():
            raise StudioError(
                f"the demonstrator lifts the {block.name} only to set it into a zone: list that "
                "condition right after it"
            )


def _block(scene: Scene, condition: Condition) -> Block:
    return next(block for block in scene.blocks if block.name == condition.block)


def _zone(scene: Scene, condition: InZone) -> Zone:
    return next(zone for zone in scene.zones if zone.name == condition.zone)


def _topple(desk: Desk, block: Block) -> Iterator[Stroke]:
    """Sweep inward through the upper part of a block."""
    x, y, _ = block.position
    height = desk.top + max(TOPPLING * block.size[2], PUSHING)
    beside = block.size[1] / 2 + HAND
    start, end = y + beside + ROOM, y - AFTER
    high = desk.top + max(block.size[2], OVER) + ROOM
    yield _to(x, start, high)
    yield _to(x, start, height)
    yield _to(x, end, height, _lasting(start - end, SLOW))
    yield _to(x, start, high, _lasting(start - end, QUICK))


def _push(desk: Desk, block: Block, zone: Zone) -> Iterator[Stroke]:
    """Push a block along the desk, straight into the middle of a zone."""
    way = np.subtract(zone.center, block.position[:2])
    far = float(np.linalg.norm(way))
    ahead = way / far if far > 0.0 else np.array([0.0, -1.0])
    half = float(np.abs(ahead) @ np.array(block.size[:2])) / 2
    behind = half + HAND
    height = desk.top + max(min(0.5 * block.size[2], 0.12), PUSHING)
    high = desk.top + max(block.size[2], OVER) + ROOM

    def at(way: float, z: float, seconds: float = USUAL_TIME) -> Stroke:
        """Return the stroke to where the hand is ``way`` [m] before the middle of the zone."""
        x, y = (np.array(zone.center) - way * ahead).tolist()
        return _to(x, y, z, seconds)

    begin, away = far + behind + ROOM, behind + 1.5 * ROOM
    yield at(begin, high)
    yield at(begin, height)
    yield at(behind, height, _lasting(far + ROOM, SLOW))
    yield at(away, height)
    yield at(away, high)


def _to(x: float, y: float, z: float, seconds: float = USUAL_TIME) -> Stroke:
    return Stroke(seconds, HandGoal((float(x), float(y), float(z)), TILT))


def _lasting(way: float, speed: float) -> float:
    return max(way / speed, SHORTEST)


def _carry(desk: Desk, block: Block, zone: Zone, height: float) -> Iterator[Stroke]:
    """Grasp a block with a level hand that comes from above, and set it into the middle of a zone.

    The hand rests while its fingers close and open, so that all takes agree on when they do.
    """
    at = desk.top + GRASP * block.size[2]
    high = at + height + ROOM
    (x, y, _), (to_x, to_y) = block.position, zone.center
    above, below = _level(x, y, high), _level(x, y, at)
    beyond, down = _level(to_x, to_y, high), _level(to_x, to_y, at + SET_DOWN)
    closed = HandState.CLOSED
    yield Stroke(2.5, above)
    yield Stroke(2.2, below)
    yield Stroke(0.6, below)
    yield Stroke(2.0, below, grip=closed)
    yield Stroke(1.8, above, grip=closed)
    yield Stroke(_lasting(math.dist((x, y), (to_x, to_y)), SLOW), beyond, grip=closed)
    yield Stroke(2.0, down, grip=closed)
    yield Stroke(0.8, down, grip=closed)
    yield Stroke(2.0, down)
    yield Stroke(1.8, beyond)


def _level(x: float, y: float, z: float) -> HandGoal:
    return HandGoal((float(x), float(y), float(z)), HEADING, True, BETWEEN_FINGERS, CAREFUL)


def _together(left: Sequence[Stroke], right: Sequence[Stroke]) -> list[Stroke]:
    """Return what both arms do as one sequence: stroke by stroke at the same time."""
    found = []
    for i in range(max(len(left), len(right))):
        mine, other = left[i : i + 1], right[i : i + 1]  # none where a plan is over
        seconds = max(stroke.seconds for stroke in (*mine, *other))
        found.append(
            Stroke(
                seconds,
                mine[0].left if mine else None,
                other[0].left if other else None,
                (*mine, *other)[0].grip,
            )
        )
    return found
