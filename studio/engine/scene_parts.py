"""What a scene is made of: desk, blocks and the zones that are marked on the desk.

Frame: the floor below the robot's base; x forward, y to the robot's left, z up.
"""

import math
from dataclasses import dataclass, replace
from typing import Self

from studio.engine.errors import StudioError

Pair = tuple[float, float]
Triple = tuple[float, float, float]
TOUCHING = 1e-6  # [m] by which two blocks that stand on each other may overlap, for rounding


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
    name: str = "block"  # as one says it

    def __post_init__(self) -> None:
        _check("a block", self.size, self.position, self.friction)
        if not (math.isfinite(self.mass) and self.mass > 0):
            raise StudioError(f"a block's mass must be positive, not {self.mass!r} kg")

    @property
    def bottom(self) -> float:
        """The height [m] at which it stands."""
        return self.position[2] - self.size[2] / 2

    @property
    def top(self) -> float:
        """The height [m] on which others stand."""
        return self.position[2] + self.size[2] / 2

    @property
    def mirrored(self) -> Self:
        """The same on the robot's other side."""
        x, y, z = self.position
        return replace(self, position=(x, -y, z))


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

    @property
    def top(self) -> float:
        """The height [m] on which blocks stand."""
        return self.position[2] + self.size[2] / 2

    def is_under(self, x: float, y: float, beyond: float = 0.0) -> bool:
        """Tell whether a point is above the desk, or no more than ``beyond`` [m] beside it."""
        return all(
            abs(at - middle) <= side / 2 + beyond
            for at, middle, side in zip((x, y), self.position, self.size, strict=False)
        )

    @property
    def mirrored(self) -> Self:
        """The same on the robot's other side."""
        x, y, z = self.position
        return replace(self, position=(x, -y, z))


@dataclass(frozen=True)
class Zone:
    """A rectangle on the desk, its edges along the axes, in which a block is to end.

    Raises
    ------
    StudioError
        Where a number is not finite, or a size is not positive.
    """

    name: str  # as one says it
    center: Pair  # x, y [m]
    size: Pair  # along x, y [m]

    def __post_init__(self) -> None:
        _check("a zone", (*self.size, 1.0), (*self.center, 0.0), 0.0)

    @property
    def mirrored(self) -> Self:
        """The same on the robot's other side."""
        x, y = self.center
        return replace(self, center=(x, -y))

    def overlaps(self, other: "Zone") -> bool:
        """Tell whether a point can be in both."""
        return all(
            abs(a - b) < (wide + long) / 2
            for a, b, wide, long in zip(
                self.center, other.center, self.size, other.size, strict=True
            )
        )

    def outside(self, x: float, y: float) -> float:
        """Return how far [m] a point is outside; 0 within."""
        return math.hypot(
            max(abs(x - self.center[0]) - self.size[0] / 2, 0.0),
            max(abs(y - self.center[1]) - self.size[1] / 2, 0.0),
        )


def overlap_from_above(one: Block, other: Block) -> bool:
    """Tell whether two blocks would stand in each other, seen from above."""
    return all(gap < 0.0 for gap in _gaps(one, other)[:2])


def overlap(one: Block, other: Block) -> bool:
    """Tell whether two blocks stand in each other; one may stand on the other."""
    return all(gap < -TOUCHING for gap in _gaps(one, other))


def _gaps(one: Block, other: Block) -> list[float]:
    """Return how far [m] two blocks are apart along x, y and z; below 0 where they overlap."""
    return [
        abs(a - b) - (wide + long) / 2
        for a, b, wide, long in zip(one.position, other.position, one.size, other.size, strict=True)
    ]


def _check(what: str, size: Triple, position: Triple, friction: float) -> None:
    if not all(math.isfinite(number) for number in (*size, *position, friction)):
        raise StudioError(f"{what}'s size, position and friction must be finite")
    if min(size) <= 0 or friction < 0:
        raise StudioError(f"{what} has sides above 0 m and a friction of 0 or more")
