"""What the guard keeps apart: the robot's links as capsules; torso, pedestal and desk as boxes.

Each simple shape that a link collides as (urdf/baxter.urdf) is covered by a capsule: a segment with
a radius that holds all of it. Boxes that no arm carries stay boxes, and so does the desk. So a
distance between two of these is the true one or less, never more.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from studio.engine.robot import BASE_HEIGHT, Robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.engine.urdf import Box, Cylinder, PlacedShape, Shape, Sphere, transform


class Margin(NamedTuple):
    """How near two parts may come to each other, and why."""

    one: str  # a part's name without its side; empty for any
    other: str
    stop: float  # [m] at which an approach ends
    slow: float  # [m] at which it begins to be slowed
    why: str
    rests: bool = False  # the two lie beside each other in a pose that is nothing unusual


_TOUCH = math.nan  # in place of a distance: exempt, these may touch

# The one table of what may come how near. The first row that fits two parts counts.
MARGINS = (
    Margin("", "block", _TOUCH, _TOUCH, "pushing blocks is what the robot is for"),
    Margin("finger", "desk", 0.01, 0.16, "fingers pick up what lies there"),
    Margin("upper arm", "torso", 0.01, 0.05, "an arm that hangs lies beside the torso", True),
    Margin("elbow", "torso", 0.01, 0.05, "an arm that hangs lies beside the torso", True),
    Margin("", "", 0.02, 0.16, "all else"),
)
# Exempt, too: links of one arm, the torso included, with fewer joints between them than this. The
# limits of those joints keep them as far apart as they need be, on the real robot as here.
NEIGHBORS = 3

# As one says the links of an arm, and their places on the chain of joints from the base.
_PARTS = {
    "upper_shoulder": ("shoulder", 1),
    "lower_shoulder": ("shoulder", 2),
    "upper_elbow": ("upper arm", 3),
    "lower_elbow": ("elbow", 4),
    "upper_forearm": ("forearm", 5),
    "lower_forearm": ("wrist", 6),
    "wrist": ("wrist", 7),
    "hand": ("hand", 7),
    "finger_1": ("finger", 8),
    "finger_2": ("finger", 8),
}
_ROUNDED = 0.4  # of the radius, by which a covering segment ends before what it covers


@dataclass(frozen=True)
class Part:
    """Whose shape it is."""

    link: str  # of the robot; empty for what stands around it
    side: str  # left or right; empty for what is not of an arm
    name: str  # as one says it: forearm, torso, desk
    place: int  # on the chain of joints from the base; 0 for what is not of an arm

    def __str__(self) -> str:
        return f"{self.side} {self.name}".lstrip()

    def is_neighbor_of(self, other: "Part") -> bool:
        """Tell whether two links of one arm, or one and the torso, are exempt as `NEIGHBORS`."""
        same_arm = self.side == other.side or "base" in (self.link, other.link)
        return same_arm and abs(self.place - other.place) < NEIGHBORS


@dataclass(frozen=True, eq=False)
class Capsules:
    """C capsules, each on a link."""

    parts: tuple[Part, ...]  # (C,)
    links: NDArray[np.intp]  # (C,) as in Kinematics.stacked
    lines: FloatArray  # (C, 4, 2) start and way [m] in the link's frame, homogeneous
    radii: FloatArray  # (C,) [m]


@dataclass(frozen=True, eq=False)
class Boxes:
    """B boxes that stand still."""

    parts: tuple[Part, ...]  # (B,)
    T_box_base: FloatArray  # (B, 4, 4)
    half: FloatArray  # (B, 3) [m]


def capsules_of(robot: Robot) -> Capsules:
    """Return all that is round: the arms' shapes, and the cylinders of torso, head and pedestal."""
    order = (robot.kinematics.root, *robot.kinematics.children)
    found = [
        (part, placed)
        for part, placed in _robots_shapes(robot)
        if part.place or not isinstance(placed.shape, Box)
    ]
    lines, radii = zip(*(_capsule(placed) for _, placed in found), strict=True)
    return Capsules(
        parts=tuple(part for part, _ in found),
        links=np.array([order.index(part.link) for part, _ in found]),
        lines=np.stack(lines),
        radii=np.array(radii),
    )


def boxes_of(robot: Robot, scene: Scene, rest: FloatArray) -> Boxes:
    """Return the boxes that stand still while the head stays as ``rest`` (15,) [rad] has it."""
    poses = robot.link_poses(rest)
    found = [
        (part, poses[part.link] @ placed.T_link_shape, placed.shape.size)
        for part, placed in _robots_shapes(robot)
        if not part.place and isinstance(placed.shape, Box)
    ]
    desk = scene.placed_desk
    around = [("desk", desk.position, desk.size)]
    around += [("block", block.position, block.size) for block in scene.placed_blocks]
    for name, (x, y, z), size in around:
        T_base_box = transform(np.array([x, y, z - BASE_HEIGHT]), np.zeros(3))
        found.append((Part("", "", name, 0), T_base_box, size))
    return Boxes(
        parts=tuple(part for part, _, _ in found),
        T_box_base=np.stack([np.linalg.inv(T) for _, T, _ in found]),
        half=np.array([size for _, _, size in found]) / 2,
    )


def margin_of(one: Part, other: Part) -> Margin | None:
    """Return how near two parts may come to each other, or None where they may touch."""
    if one.link == other.link or one.is_neighbor_of(other):
        return None
    fits = ({one.name, other.name}, {one.name, ""}, {other.name, ""}, {""})
    margin = next(row for row in MARGINS if {row.one, row.other} in fits)
    return None if math.isnan(margin.stop) else margin


def may_rest(one: str, other: str) -> bool:
    """Tell whether two parts, as one says them, lie beside each other where an arm just hangs."""
    return any(row.rests and one.endswith(row.one) and other.endswith(row.other) for row in MARGINS)


def _robots_shapes(robot: Robot) -> Iterator[tuple[Part, PlacedShape]]:
    for link in robot.links:
        side, _, part = link.name.partition("_")
        for placed in link.collisions:
            if part in _PARTS:
                name, place = _PARTS[part]
                yield Part(link.name, side, name, place), placed
            else:
                below = placed.T_link_shape[2, 3] < 0.0
                torso = "pedestal" if below else "torso"
                yield Part(link.name, "", torso if link.name == "base" else link.name, 0), placed


def _capsule(placed: PlacedShape) -> tuple[FloatArray, float]:
    """Return a line (4, 2) and a radius [m] that cover a shape."""
    along, half, radius = _extent(placed.shape)
    kept = max(half - _ROUNDED * radius, 0.0)
    way = np.zeros(3)
    way[along] = 2.0 * kept
    line = np.array([[*(-way / 2), 1.0], [*way, 0.0]]).T
    return placed.T_link_shape @ line, math.hypot(radius, half - kept)


def _extent(shape: Shape) -> tuple[int, float, float]:
    """Return a shape's longest axis, its half length along it, and its radius across it [m]."""
    match shape:
        case Box(size):
            along = int(np.argmax(size))
            return along, size[along] / 2, math.hypot(*np.delete(size, along)) / 2
        case Cylinder(radius, length):
            return 2, length / 2, radius
        case Sphere(radius):
            return 2, 0.0, radius
    raise ValueError(f"nothing collides as {shape}")
