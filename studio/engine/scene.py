"""What stands around the robot, and what is to be done with it: by default the paper's task.

Frame: the floor below the robot's base; x forward, y to the robot's left, z up.
"""

import math
from dataclasses import dataclass, replace

from studio.engine.arms import ARMS, Arms
from studio.engine.errors import StudioError
from studio.engine.scene_parts import Block, Desk, Pair, Triple, Zone, overlap_from_above
from studio.engine.success import PUSH_DOWN, InZone, Success
from studio.engine.wrist import WristMode

__all__ = ["DEFAULT_SCENE", "USUAL", "Block", "Desk", "Scene", "Triple", "Zone"]

DEFAULT_SCENE = "push-down"
# The paper's task: both mappings can push the block here, with 2 cm to spare in each direction.
# urdf/scenes/push-down.toml says the same in words; a test holds the two together.
_WORDS = "The paper's task: push the tall block down."
_DESK = Desk((0.60, 0.90, 0.04), (0.75, 0.15, 0.70), 0.8)
_BLOCKS = (
    Block((0.10, 0.06, 0.30), (0.80, 0.20, 0.87), 0.4, 0.6),
    Block((0.12, 0.06, 0.05), (0.60, 0.50, 0.745), 0.2, 0.6, "lying block"),
    Block((0.06, 0.06, 0.06), (0.95, 0.48, 0.75), 0.12, 0.6, "cube"),
)


@dataclass(frozen=True)
class Scene:
    """A desk and blocks, told for the left arm; mirrored (`placed_...`) for the right alone.

    Raises
    ------
    StudioError
        Where there is no block, two have one name, the success is about what is not there, or the
        task takes both arms and only one is taught.
    """

    desk: Desk = _DESK
    blocks: tuple[Block, ...] = _BLOCKS
    arms: Arms = "left"  # those that are taught
    name: str = DEFAULT_SCENE
    zones: tuple[Zone, ...] = ()
    success: Success = PUSH_DOWN
    both_arms: bool = False  # whether the task takes two
    gripper: bool = False  # whether it takes fingers
    words: str = _WORDS  # what to do, for people
    wrist: WristMode = "zero"  # how the hands are held

    def __post_init__(self) -> None:
        if not self.blocks:
            raise StudioError("a scene needs at least one block, the one to push down")
        if self.arms not in ARMS:
            raise StudioError(f"taught are the left arm, the right or both, not {self.arms!r}")
        if self.both_arms and self.arms != "both":
            raise StudioError(f"the scene {self.name} takes both arms, not the {self.arms} alone")
        for things in (self.blocks, self.zones):
            names = [thing.name for thing in things]
            if len(set(names)) < len(names):
                raise StudioError(f"the scene {self.name} has two things of one name: {names}")
        self._check_success()

    def taught_by(self, arms: Arms) -> "Scene":
        """Return this scene for other arms; raise StudioError where it takes both of them."""
        return self if arms == self.arms else replace(self, arms=arms)

    @property
    def as_told(self) -> "Scene":
        """The scene for the arms that its file tells it for, so that two can be compared."""
        return self.taught_by("both" if self.both_arms else "left")

    def is_same_as(self, other: "Scene") -> bool:
        """Tell whether both are one scene, for whichever arms: by all that is in them."""
        if self.both_arms != other.both_arms:
            return False
        return self == other.taught_by(self.arms)

    def name_beside(self, other: "Scene") -> str:
        """Return its name, told apart from that of another scene of the same name."""
        is_another = self.name == other.name and not self.is_same_as(other)
        return f"{self.name} (another one)" if is_another else self.name

    @property
    def task_blocks(self) -> tuple[int, ...]:
        """The numbers of the blocks that the task is about, in the order in which it names them."""
        names = [block.name for block in self.blocks]
        return tuple(names.index(name) for name in self.success.blocks)

    @property
    def placed_desk(self) -> Desk:
        """The desk where it really stands."""
        return self.desk.mirrored if self.arms == "right" else self.desk

    @property
    def placed_blocks(self) -> tuple[Block, ...]:
        """The blocks where they really stand."""
        return tuple(b.mirrored for b in self.blocks) if self.arms == "right" else self.blocks

    @property
    def placed_zones(self) -> tuple[Zone, ...]:
        """The zones where they really are."""
        return tuple(z.mirrored for z in self.zones) if self.arms == "right" else self.zones

    @property
    def room_for_block(self) -> tuple[Pair, Pair]:
        """From where to where the first block may really stand: its center's x [m], and its y."""
        return self.room_for(0)

    def room_for(self, block: int) -> tuple[Pair, Pair]:
        """From where to where the block of that number may really stand: its center's x, its y."""
        desk, size = self.placed_desk, self.blocks[block].size
        reach = [(edge - side) / 2 for edge, side in zip(desk.size, size, strict=True)]
        (x, y, _), (dx, dy, _) = desk.position, reach
        return (x - dx, x + dx), (y - dy, y + dy)

    def with_block_at(self, x: float, y: float, block: int = 0) -> "Scene":
        """Return this scene with a block at x, y [m] as it is really to stand.

        It comes as near to that as the desk's top is wide. ``block`` is its number.

        Raises
        ------
        StudioError
            Where a number is not finite, or another block stands in the way.
        """
        if not (math.isfinite(x) and math.isfinite(y)):
            raise StudioError(f"the block's place must be finite, not {x}, {y}")
        if not 0 <= block < len(self.blocks):
            raise StudioError(f"there is no block {block}: they count from 0")
        mine = self.blocks[block]
        in_x, in_y = self.room_for(block)
        at = (min(max(x, in_x[0]), in_x[1]), min(max(y, in_y[0]), in_y[1]), mine.position[2])
        moved = replace(mine, position=at)
        moved = moved.mirrored if self.arms == "right" else moved
        others = [other for number, other in enumerate(self.blocks) if number != block]
        if any(overlap_from_above(moved, other) for other in others):
            raise StudioError("Another block stands there: put this one beside it")
        blocks = tuple(moved if i == block else other for i, other in enumerate(self.blocks))
        return replace(self, blocks=blocks)

    def _check_success(self) -> None:
        blocks = {block.name for block in self.blocks}
        zones = {zone.name for zone in self.zones}
        for condition in self.success.conditions:
            if condition.block not in blocks:
                raise StudioError(f"the scene {self.name} has no block {condition.block!r}")
            if isinstance(condition, InZone) and condition.zone not in zones:
                raise StudioError(f"the scene {self.name} has no zone {condition.zone!r}")


USUAL = Scene()
