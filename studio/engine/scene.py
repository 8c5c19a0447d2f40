"""What stands around the robot: a desk and building blocks, where pushing one down is possible.

Frame: the floor below the robot's base; x forward, y to the robot's left, z up.
"""

import math
from dataclasses import dataclass, field, replace
from functools import cache

from studio.engine.arms import ARMS, Arms
from studio.engine.errors import FileError, StudioError
from studio.engine.resources import resource_root
from studio.engine.urdf import Box, read_urdf

Triple = tuple[float, float, float]

# Both mappings can push the block here, with 2 cm to spare in each direction.
_DESK_POSITION: Triple = (0.75, 0.15, 0.70)
_BLOCK_POSITION: Triple = (0.80, 0.20, 0.87)


@dataclass(frozen=True)
class Block:
    """A box that can be moved, its edges along the axes to begin with.

    Raises
    ------
    StudioError
        Where a number is not finite, or a size or the mass is not positive.
    """

    size: Triple  # along x, y, z [m]
    position: Triple  # of its center [m]
    mass: float  # [kg]
    friction: float

    def __post_init__(self) -> None:
        _check("a block", self.size, self.position, self.friction)
        if not (math.isfinite(self.mass) and self.mass > 0):
            raise StudioError(f"a block's mass must be positive, not {self.mass!r} kg")


@dataclass(frozen=True)
class Desk:
    """A desk's top, which does not move.

    Raises
    ------
    StudioError
        Where a number is not finite, or a size is not positive.
    """

    size: Triple  # along x, y, z [m]
    position: Triple  # of the middle of the top [m]
    friction: float

    def __post_init__(self) -> None:
        _check("a desk", self.size, self.position, self.friction)


@cache
def default_desk() -> Desk:
    """Return the desk of urdf/desk.urdf in its place."""
    size, _, friction = _box("desk")
    return Desk(size, _DESK_POSITION, friction)


@cache
def default_blocks() -> tuple[Block, ...]:
    """Return the block of urdf/block.urdf in its place, and two that lie out of the way."""
    size, mass, friction = _box("block")
    lying = Block((0.12, 0.06, 0.05), (0.60, 0.50, 0.745), 0.2, friction)
    cube = Block((0.06, 0.06, 0.06), (0.95, 0.48, 0.75), 0.12, friction)
    return Block(size, _BLOCK_POSITION, mass, friction), lying, cube


@dataclass(frozen=True)
class Scene:
    """A desk and blocks, told for the left arm; mirrored (`placed_...`) for the right alone.

    Raises
    ------
    StudioError
        Where there is no block.
    """

    desk: Desk = field(default_factory=default_desk)
    blocks: tuple[Block, ...] = field(default_factory=default_blocks)  # the first is the task's
    arms: Arms = "left"  # those that are taught

    def __post_init__(self) -> None:
        if not self.blocks:
            raise StudioError("a scene needs at least one block, the one to push down")
        if self.arms not in ARMS:
            raise StudioError(f"taught are the left arm, the right or both, not {self.arms!r}")

    @property
    def placed_desk(self) -> Desk:
        """The desk where it really stands."""
        return replace(self.desk, position=self._placed(self.desk.position))

    @property
    def placed_blocks(self) -> tuple[Block, ...]:
        """The blocks where they really stand."""
        return tuple(replace(b, position=self._placed(b.position)) for b in self.blocks)

    @property
    def room_for_block(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """From where to where the task's block may really stand: its center's x [m], and its y."""
        desk, size = self.placed_desk, self.blocks[0].size
        reach = [(edge - side) / 2 for edge, side in zip(desk.size, size, strict=True)]
        (x, y, _), (dx, dy, _) = desk.position, reach
        return (x - dx, x + dx), (y - dy, y + dy)

    def with_block_at(self, x: float, y: float) -> "Scene":
        """Return this scene with the task's block at x, y [m] as it is really to stand.

        It comes as near to that as the desk's top is wide.

        Raises
        ------
        StudioError
            Where a number is not finite, or another block stands in the way.
        """
        if not (math.isfinite(x) and math.isfinite(y)):
            raise StudioError(f"the block's place must be finite, not {x}, {y}")
        task = self.blocks[0]
        in_x, in_y = self.room_for_block
        at = (min(max(x, in_x[0]), in_x[1]), min(max(y, in_y[0]), in_y[1]), task.position[2])
        moved = replace(task, position=self._placed(at))
        if any(_overlap(moved, other) for other in self.blocks[1:]):
            raise StudioError("Another block stands there: put this one beside it")
        return replace(self, blocks=(moved, *self.blocks[1:]))

    def _placed(self, position: Triple) -> Triple:
        x, y, z = position
        return (x, -y, z) if self.arms == "right" else position


def _overlap(one: Block, other: Block) -> bool:
    """Tell whether two blocks would stand in each other, seen from above."""
    return all(
        abs(a - b) < (wide + long) / 2
        for a, b, wide, long in zip(
            one.position[:2], other.position[:2], one.size, other.size, strict=False
        )
    )


def _box(name: str) -> tuple[Triple, float, float]:
    """Return size [m], mass [kg] and friction of the box that urdf/<name>.urdf collides as."""
    path = resource_root() / "urdf" / f"{name}.urdf"
    link = read_urdf(path).links[0]
    shape = link.collisions[0].shape
    if not isinstance(shape, Box):
        raise FileError(f"{path}: its collision shape must be a box, not {shape}; reinstall")
    return shape.size, link.mass, link.friction


def _check(what: str, size: Triple, position: Triple, friction: float) -> None:
    if not all(math.isfinite(number) for number in (*size, *position, friction)):
        raise StudioError(f"{what}'s size, position and friction must be finite")
    if min(size) <= 0 or friction < 0:
        raise StudioError(f"{what} has sides above 0 m and a friction of 0 or more")
