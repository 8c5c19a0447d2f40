"""Looks, tick by tick, whether a scene's task is done, and says in words what is missing yet.

It knows poses and touches only, no physics: ``memory, verdict = judge.step(memory, sights)``.

Two moments matter of each condition. It *shows* from when the block leans, lies in the zone or is
lifted as asked, at rest or not: by then a taught arm has to have touched the block, and the order
of conditions is the order of these moments. It is *fulfilled* once the block rests as well.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

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
class Progress:
    """What is known of one condition; moments are numbers of ticks."""

    shows: bool = False
    touched_by: frozenset[Side] = NOBODY  # the arms that had touched the block when it came to show
    # When it first showed by a taught arm's doing; forgotten where the block rests otherwise. What
    # bounces within one movement so counts from the movement's first moment on.
    since: int | None = None
    fulfilled_since: int | None = None  # the same, of the time when it was first fulfilled

    @property
    def came(self) -> int | None:
        """The moment that counts for the order; None where it has not come yet."""
        return self.since if self.fulfilled_since is None else self.fulfilled_since


@dataclass(frozen=True)
class JudgeMemory:
    """What is known of all blocks that are watched, and of all conditions."""

    blocks: tuple[BlockMemory, ...]
    conditions: tuple[Progress, ...]
    ticks: int = 0


@dataclass(frozen=True, eq=False)
class Judge:
    """What is asked for, and of what: made once for a scene."""

    success: Success
    watched: tuple[int, ...]  # the numbers of the scene's blocks that it looks at, the first first
    sizes: Mapping[str, tuple[float, float, float]]  # [m] of those, by their names
    zones: Mapping[str, Zone]  # where they really are
    top: float  # [m] of the desk
    names: tuple[str, ...]  # of the watched blocks

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
            names=tuple(block.name for _, block in blocks),
        )

    def start(self) -> JudgeMemory:
        """Return the memory of a scene in which nothing has happened."""
        blocks = (BlockMemory(),) * len(self.watched)
        return JudgeMemory(blocks, (Progress(),) * len(self.success.conditions))

    def asks(self, memory: JudgeMemory, block: int) -> bool:
        """Tell whether it still matters who touches the watched block of that number.

        Where nobody asks for more than that a block was touched, once is enough.
        """
        name = self.names[block]
        mine = [each for each in self.success.conditions if each.block == name]
        if any(_looks_at_present(each) or each.arm is not None for each in mine):
            return True
        return not memory.blocks[block].touched_by

    def step(self, memory: JudgeMemory, sights: Sequence[Sight]) -> tuple[JudgeMemory, Verdict]:
        """Take what is seen of the watched blocks after a tick."""
        blocks = tuple(
            self._seen(before, sight, name)
            for before, sight, name in zip(memory.blocks, sights, self.names, strict=True)
        )
        known = dict(zip(self.names, blocks, strict=True))
        found, reasons = [], []
        for before, each in zip(memory.conditions, self.success.conditions, strict=True):
            block = known[each.block]
            progress = self._progressed(before, each, block, memory.ticks)
            why = self._why_not(each, block, progress)
            if not why and progress.fulfilled_since is None:
                progress = replace(progress, fulfilled_since=progress.since)
            found.append(progress)
            is_over = isinstance(each, Lifted) and progress.fulfilled_since is not None
            reasons.append("" if is_over else why)
        missing = self._out_of_order(found) or next(filter(None, reasons), "")
        after = JudgeMemory(blocks, tuple(found), memory.ticks + 1)
        return after, Verdict(blocks[0].watch, not missing, missing)

    def _seen(self, before: BlockMemory, sight: Sight, name: str) -> BlockMemory:
        pose = sight.pose
        return BlockMemory(
            watch=before.watch.step(bool(sight.touching), pose, sight.speed, sight.spin),
            touched_by=before.touched_by | sight.touching,
            touching=sight.touching,
            place=(float(pose[0]), float(pose[1])),
            clear=lowest_of(pose, self.sizes[name]) - self.top,
        )

    def _progressed(
        self, before: Progress, condition: Condition, block: BlockMemory, tick: int
    ) -> Progress:
        shows = not self._why_not_shown(condition, block)
        # A lift takes an arm at any moment; all else can come about by itself.
        anew = isinstance(condition, Lifted) or not before.shows
        touched_by = block.touched_by if shows and anew else before.touched_by
        since = before.since
        if shows and since is None and _is_by(condition, touched_by):
            since = tick
        elif not shows and block.watch.at_rest:
            since = None
        return Progress(shows, touched_by, since, before.fulfilled_since)

    def _out_of_order(self, found: Sequence[Progress]) -> str:
        """Return what came too early, if the order counts."""
        if not self.success.in_order:
            return ""
        for place, later in enumerate(found[1:]):
            first = found[place].came
            if later.came is not None and (first is None or first > later.came):
                asked, early = self.success.conditions[place : place + 2]
                return f"too early: {early.words} only after that: {asked.words}"
        return ""

    def _why_not(self, condition: Condition, block: BlockMemory, progress: Progress) -> str:
        """Return why a condition does not hold at this moment; nothing where it does."""
        name, arm = f"the {condition.block}", condition.arm
        if progress.shows and not _is_by(condition, progress.touched_by):
            event = f"was in the {condition.zone}" if isinstance(condition, InZone) else "fell"
            return f"{name} {event} without having been touched by {_whom(arm)}"
        if not _is_by(condition, block.touched_by):
            return f"{name} has not been touched by {_whom(arm)}"
        why = self._why_not_shown(condition, block)
        if why or isinstance(condition, Lifted):
            return why
        if isinstance(condition, InZone) and condition.released and block.touching:
            return f"{name} is still held"
        return "" if block.watch.at_rest else f"{name} still moves"

    def _why_not_shown(self, condition: Condition, block: BlockMemory) -> str:
        """Return why a condition does not show, whoever touched the block; else nothing."""
        name = f"the {condition.block}"
        match condition:
            case Lifted(height=height):
                if not (block.touching and block.clear >= height):
                    return f"{name} has not been lifted by {100 * height:.0f} cm"
            case Down():
                if block.watch.tilt <= DOWN_TILT:
                    return f"{name} still stands"
            case InZone():
                zone = self.zones[condition.zone]
                outside = zone.outside(*block.place)
                if outside > 0.0:
                    return f"{name} is {max(100 * outside, 0.1):.0f} cm outside the {zone.name}"
                if abs(block.clear) > ON_DESK:
                    return f"{name} is not on the desk"
        return ""


def lowest_of(pose: FloatArray, size: tuple[float, float, float]) -> float:
    """Return the height [m] of the lowest corner of a box of that size, for its pose (7,)."""
    x, y, z, w = (float(part) for part in pose[3:])
    # The third row of its rotation: how much of each of its own axes points up.
    up = (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))
    reach = sum(abs(share) * side / 2 for share, side in zip(up, size, strict=True))
    return float(pose[2]) - reach


def _is_by(condition: Condition, arms: frozenset[Side]) -> bool:
    """Tell whether the arm that a condition asks for is among those."""
    return bool(arms) if condition.arm is None else condition.arm in arms


def _looks_at_present(condition: Condition) -> bool:
    return isinstance(condition, Lifted) or (isinstance(condition, InZone) and condition.released)


def _whom(arm: Side | None) -> str:
    return "a taught arm" if arm is None else f"the {arm} arm"
