"""Looks, tick by tick, whether a scene's task is done, and says in words what is missing yet.

It knows poses and touches only, no physics: ``memory, verdict = judge.step(memory, sights)``.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from studio.engine.scene import Scene
from studio.engine.scene_parts import Block, Zone
from studio.engine.skeleton import FloatArray, Side
from studio.engine.success import Condition, Down, InZone, Lifted, Success
from studio.engine.world_state import DOWN_TILT, BlockWatch, Verdict

ON_DESK = 0.01  # [m] above the desk, at most, of the lowest corner of a block that lies on it
NOBODY: frozenset[Side] = frozenset()
_UNTOUCHED = BlockWatch()


@dataclass(frozen=True, eq=False)
class Sight:
    """A block after a tick."""

    pose: FloatArray  # (7,) x y z [m] qx qy qz qw
    speed: float  # [m/s]
    spin: float  # [rad/s]
    touching: frozenset[Side] = NOBODY  # the taught arms that touched it in the tick


@dataclass(frozen=True)
class BlockMemory:
    """What is known of one block."""

    watch: BlockWatch = _UNTOUCHED
    touched_by: frozenset[Side] = NOBODY
    touching: frozenset[Side] = NOBODY
    place: tuple[float, float] = (0.0, 0.0)  # [m] x, y of its center
    clear: float = 0.0  # [m] of its lowest corner above the desk


@dataclass(frozen=True)
class JudgeMemory:
    """What is known of all blocks that are watched, and what was fulfilled in which order."""

    blocks: tuple[BlockMemory, ...]
    met: tuple[int, ...] = ()  # the conditions' numbers, as they were first fulfilled


@dataclass(frozen=True, eq=False)
class Judge:
    """What is asked for, and of what: made once for a scene."""

    success: Success
    watched: tuple[int, ...]  # the numbers of the scene's blocks that it looks at, the first first
    sizes: Mapping[str, tuple[float, float, float]]  # [m] of those, by their names
    zones: Mapping[str, Zone]  # where they really are
    top: float  # [m] of the desk
    order: tuple[str, ...]  # the watched blocks' names

    @classmethod
    def of(cls, scene: Scene) -> "Judge":
        """Return the judge of a scene as it really stands."""
        asked = scene.success.blocks
        blocks: list[tuple[int, Block]] = [
            (number, block)
            for number, block in enumerate(scene.blocks)
            if number == 0 or block.name in asked
        ]
        return cls(
            success=scene.success,
            watched=tuple(number for number, _ in blocks),
            sizes={block.name: block.size for _, block in blocks},
            zones={zone.name: zone for zone in scene.placed_zones},
            top=scene.placed_desk.top,
            order=tuple(block.name for _, block in blocks),
        )

    def start(self) -> JudgeMemory:
        """Return the memory of a scene in which nothing has happened."""
        return JudgeMemory((BlockMemory(),) * len(self.watched))

    def asks(self, memory: JudgeMemory, block: int) -> bool:
        """Tell whether it still matters who touches the watched block of that number.

        Where nobody asks for more than that a block was touched, once is enough.
        """
        name = self.order[block]
        mine = [each for each in self.success.conditions if each.block == name]
        if any(_looks_at_present(each) or each.arm is not None for each in mine):
            return True
        return not memory.blocks[block].touched_by

    def step(self, memory: JudgeMemory, sights: Sequence[Sight]) -> tuple[JudgeMemory, Verdict]:
        """Take what is seen of the watched blocks after a tick."""
        blocks = tuple(
            self._seen(before, sight, name)
            for before, sight, name in zip(memory.blocks, sights, self.order, strict=True)
        )
        known = dict(zip(self.order, blocks, strict=True))
        conditions, met = self.success.conditions, memory.met
        reasons = [self._why_not(each, known[each.block]) for each in conditions]
        met += tuple(i for i, why in enumerate(reasons) if not why and i not in met)
        missing = self._out_of_order(met) or next(
            (
                why
                for i, (why, each) in enumerate(zip(reasons, conditions, strict=True))
                if why and not (isinstance(each, Lifted) and i in met)
            ),
            "",
        )
        return JudgeMemory(blocks, met), Verdict(blocks[0].watch, not missing, missing)

    def _seen(self, before: BlockMemory, sight: Sight, name: str) -> BlockMemory:
        pose = sight.pose
        return BlockMemory(
            watch=before.watch.step(bool(sight.touching), pose, sight.speed, sight.spin),
            touched_by=before.touched_by | sight.touching,
            touching=sight.touching,
            place=(float(pose[0]), float(pose[1])),
            clear=lowest_of(pose, self.sizes[name]) - self.top,
        )

    def _out_of_order(self, met: tuple[int, ...]) -> str:
        """Return what came too early, if the order counts."""
        if not self.success.in_order:
            return ""
        for place, number in enumerate(met):
            if number != place:
                first, early = (self.success.conditions[i] for i in (place, number))
                return f"too early: {early.words} only after that: {first.words}"
        return ""

    def _why_not(self, condition: Condition, block: BlockMemory) -> str:
        """Return why a condition does not hold at this moment; nothing where it does."""
        name, arm = f"the {condition.block}", condition.arm
        touched = bool(block.touched_by) if arm is None else arm in block.touched_by
        if not touched:
            return f"{name} has not been touched by {_whom(arm)}"
        match condition:
            case Lifted(height=height):
                if block.touching and block.clear >= height:
                    return ""
                return f"{name} has not been lifted by {100 * height:.0f} cm"
            case Down():
                if block.watch.tilt <= DOWN_TILT:
                    return f"{name} still stands"
            case InZone():
                why = self._why_not_in(condition, block)
                if why:
                    return why
        return "" if block.watch.at_rest else f"{name} still moves"

    def _why_not_in(self, condition: InZone, block: BlockMemory) -> str:
        name, zone = f"the {condition.block}", self.zones[condition.zone]
        outside = zone.outside(*block.place)
        if outside > 0.0:
            return f"{name} is {max(100 * outside, 0.1):.0f} cm outside the {zone.name}"
        if abs(block.clear) > ON_DESK:
            return f"{name} is not on the desk"
        if condition.released and block.touching:
            return f"{name} is still held"
        return ""


def lowest_of(pose: FloatArray, size: tuple[float, float, float]) -> float:
    """Return the height [m] of the lowest corner of a box of that size, for its pose (7,)."""
    x, y, z, w = (float(part) for part in pose[3:])
    # The third row of its rotation: how much of each of its own axes points up.
    up = (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))
    reach = sum(abs(share) * side / 2 for share, side in zip(up, size, strict=True))
    return float(pose[2]) - reach


def _looks_at_present(condition: Condition) -> bool:
    return isinstance(condition, Lifted) or (isinstance(condition, InZone) and condition.released)


def _whom(arm: Side | None) -> str:
    return "a taught arm" if arm is None else f"the {arm} arm"
