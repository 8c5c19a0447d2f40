"""Whether a scene makes sense: what stands where nothing can stand, and what is done already.

Each problem is told by its place in a scene's file and with its cure.
"""

from collections.abc import Iterator, Sequence
from functools import cache
from itertools import chain
from typing import NamedTuple

import numpy as np

from studio.engine.arms import Arms, driven_joints, resting_body
from studio.engine.body import boxes_of, capsules_of
from studio.engine.distance import segment_to_box
from studio.engine.fingers import OPEN
from studio.engine.judge import ON_DESK
from studio.engine.pipeline import ready_pose
from studio.engine.retarget import MAPPINGS
from studio.engine.robot import BASE_HEIGHT, load_robot
from studio.engine.scene import Scene
from studio.engine.scene_parts import Block, Desk, Triple, overlap, overlap_from_above
from studio.engine.skeleton import FloatArray
from studio.engine.success import Condition, InZone, Lifted

ROUNDING = 1e-3  # [m] by which a block may stand in the desk or over it, and a zone reach beyond


class Problem(NamedTuple):
    """What is wrong in a scene."""

    place: str  # in its file: ``block 2.position``
    words: str


def misplaced(scene: Scene) -> Iterator[Problem]:
    """Tell of what is in the desk, beside it, or in another block."""
    desk = scene.desk
    for number, block in enumerate(scene.blocks, 1):
        place = f"block {number}.position"
        if block.bottom < desk.top - ROUNDING:
            at = desk.top + block.size[2] / 2
            yield Problem(
                place,
                f"{block.name!r} stands in the desk; the lowest that its center fits is {at:g}",
            )
        if not desk.is_under(block.position[0], block.position[1]):
            yield Problem(
                place, f"{block.name!r} is beside the desk, which spans {_span(desk)}: put it there"
            )
        for other in scene.blocks[: number - 1]:
            if overlap(block, other):
                yield Problem(place, f"{block.name!r} stands in {other.name!r}: move one of them")
    for number, zone in enumerate(scene.zones, 1):
        corners = [
            (zone.center[0] + i * zone.size[0] / 2, zone.center[1] + j * zone.size[1] / 2)
            for i in (-1, 1)
            for j in (-1, 1)
        ]
        if not all(desk.is_under(x, y, ROUNDING) for x, y in corners):
            yield Problem(
                f"zone {number}.center",
                f"{zone.name!r} reaches beyond the desk, which spans {_span(desk)}: move it, or "
                "make it smaller",
            )


def impossible(scene: Scene) -> Iterator[Problem]:
    """Tell of conditions that ask for the same twice, or that cannot both hold in the end."""
    zones = {zone.name: zone for zone in scene.zones}
    for number, condition in enumerate(scene.success.conditions, 1):
        for earlier, other in enumerate(scene.success.conditions[: number - 1], 1):
            if _alike(condition, other):
                yield Problem(
                    f"success {number}", f"asks for the same as success {earlier}: keep one of them"
                )
            elif isinstance(condition, InZone) and isinstance(other, InZone):
                apart = not zones[condition.zone].overlaps(zones[other.zone])
                if condition.block == other.block and apart:
                    yield Problem(
                        f"success {number}.zone",
                        f"in the end {condition.block!r} cannot be in {condition.zone!r} and, as "
                        f"success {earlier} asks, in {other.zone!r}: keep one of them",
                    )


def unready(scene: Scene) -> Iterator[Problem]:
    """Tell why a task cannot begin: what falls by itself, is in Baxter, or is done already."""
    for number, block in enumerate(scene.blocks, 1):
        if why := _not_supported(block, scene.desk, scene.blocks):
            yield Problem(f"block {number}.position", f"{block.name!r} {why}")
    for place, name, size, position in _boxes(scene):
        if part := _part_of_baxter_in(scene.arms, scene.gripper, size, position):
            yield Problem(place, f"{name} stands in Baxter's {part}: move it away from there")
    for number, condition in enumerate(scene.success.conditions, 1):
        (block,) = (each for each in scene.blocks if each.name == condition.block)
        if isinstance(condition, InZone):
            (zone,) = (each for each in scene.zones if each.name == condition.zone)
            on_desk = block.bottom - scene.desk.top <= ON_DESK
            if on_desk and zone.outside(*block.position[:2]) == 0.0:
                yield Problem(
                    f"success {number}.zone",
                    f"{block.name!r} is in {zone.name!r} from the beginning: move one of them",
                )
        if isinstance(condition, Lifted) and block.bottom - scene.desk.top >= condition.height:
            above = block.bottom - scene.desk.top
            yield Problem(
                f"success {number}.height",
                f"{block.name!r} is {above:g} m above the desk from the beginning: ask for more",
            )


def can_begin(scene: Scene) -> bool:
    """Tell whether a task is to be done as the blocks stand."""
    told = scene.as_told
    return next(chain(misplaced(told), unready(told)), None) is None


def _alike(one: Condition, other: Condition) -> bool:
    """Tell whether two conditions ask for the same, or one for what the other asks for, too."""
    arms = one.arm == other.arm or None in (one.arm, other.arm)
    zones = [each.zone if isinstance(each, InZone) else "" for each in (one, other)]
    same = type(one) is type(other) and one.block == other.block and zones[0] == zones[1]
    return same and arms


def _not_supported(block: Block, desk: Desk, blocks: Sequence[Block]) -> str:
    """Return why a block would fall by itself; nothing where it stands."""
    if abs(block.bottom - desk.top) <= ROUNDING:
        return ""
    below = [
        each
        for each in blocks
        if abs(block.bottom - each.top) <= ROUNDING and overlap_from_above(block, each)
    ]
    if not below:
        at = desk.top + block.size[2] / 2
        return f"hangs in the air; on the desk its center is at {at:g}"
    for axis in (0, 1):
        edges = [
            each.position[axis] + side * each.size[axis] / 2 for each in below for side in (-1, 1)
        ]
        if not min(edges) < block.position[axis] < max(edges):
            return f"would fall off {below[0].name!r}: put its center above that"
    return ""


def _boxes(scene: Scene) -> Iterator[tuple[str, str, Triple, Triple]]:
    yield "desk.position", "the desk", scene.desk.size, scene.desk.position
    for number, block in enumerate(scene.blocks, 1):
        yield f"block {number}.position", repr(block.name), block.size, block.position


def _part_of_baxter_in(arms: Arms, fingers: bool, size: Triple, position: Triple) -> str:
    """Return what of Baxter, as it waits, is in a box along the axes; nothing where nothing is."""
    x, y, z = position
    center, half = np.array([x, y, z - BASE_HEIGHT]), np.array(size) / 2
    for waiting in _waiting(arms, fingers):
        starts = waiting.starts - center
        halves = np.broadcast_to(half, starts.shape)
        reached = segment_to_box(starts, waiting.ways, halves) < waiting.radii
        if reached.any():
            return waiting.rounded[int(np.argmax(reached))]
        for name, middle, reach in waiting.boxes:
            if (np.abs(middle - center) < reach + half).all():
                return name
    return ""


class _Waiting(NamedTuple):
    """Where Baxter is before anything moves: C capsules, and boxes along the axes around the rest.

    Frame: the robot's base.
    """

    rounded: list[str]  # (C,) whose they are
    starts: FloatArray  # (C, 3) [m]
    ways: FloatArray  # (C, 3) [m]
    radii: FloatArray  # (C,) [m]
    boxes: list[tuple[str, FloatArray, FloatArray]]  # whose, its middle (3,), its half sides (3,)


@cache
def _waiting(arms: Arms, fingers: bool) -> list[_Waiting]:
    """Return Baxter as it waits, with either mapping."""
    robot = load_robot(fingers=fingers)
    columns = [robot.joint_index(name) for name in driven_joints(arms)]
    capsules, body, found = capsules_of(robot), resting_body(arms), []
    for mapping in MAPPINGS:
        angles = np.concatenate([body, np.full(len(robot.joint_names) - len(body), OPEN)])
        angles[columns] = ready_pose(arms, mapping)
        lines = robot.kinematics.stacked(angles)[capsules.links] @ capsules.lines
        still = boxes_of(robot, Scene(arms=arms), angles)
        boxes = [
            (str(part), T_base_box[:3, 3], np.abs(T_base_box[:3, :3]) @ half)
            for part, T_base_box, half in zip(
                still.parts, np.linalg.inv(still.T_box_base), still.half, strict=True
            )
            if part.link  # the robot's own
        ]
        names = [str(part) for part in capsules.parts]
        found.append(_Waiting(names, lines[:, :3, 0], lines[:, :3, 1], capsules.radii, boxes))
    return found


def _span(desk: Desk) -> str:
    (x, y, _), (length, width, _) = desk.position, desk.size
    return (
        f"x {x - length / 2:.2f} to {x + length / 2:.2f} m and "
        f"y {y - width / 2:.2f} to {y + width / 2:.2f} m"
    )
