"""When a scene's task is done: conditions as data. `studio.engine.judge` looks whether they hold.

Each is about one block, which a taught arm has to have touched by the time that it falls or comes
into its zone: what falls or slides by itself is nothing that was taught.
"""

from dataclasses import dataclass

from studio.engine.errors import StudioError
from studio.engine.skeleton import Side


@dataclass(frozen=True)
class Down:
    """The block leans more than 60° and is at rest."""

    block: str
    arm: Side | None = None  # that has to have touched it; None: any that is taught

    @property
    def words(self) -> str:
        """What to do."""
        return f"push the {self.block} down{_by(self.arm)}"


@dataclass(frozen=True)
class InZone:
    """The block's center is above the zone, and it is at rest on the desk."""

    block: str
    zone: str
    arm: Side | None = None
    released: bool = False  # whether no arm may touch it any more

    @property
    def words(self) -> str:
        """What to do."""
        what = "set" if self.released else "bring"
        return f"{what} the {self.block} into the {self.zone}{_by(self.arm)}"


@dataclass(frozen=True)
class Lifted:
    """The block has been that high above the desk while an arm touched it; once is enough."""

    block: str
    height: float  # [m] of its lowest corner above the desk
    arm: Side | None = None

    @property
    def words(self) -> str:
        """What to do."""
        return f"lift the {self.block} by {100 * self.height:.0f} cm{_by(self.arm)}"


Condition = Down | InZone | Lifted


@dataclass(frozen=True)
class Success:
    """All of the conditions, in any order or as they are listed.

    In order means: what each asks for came about, at rest or not, no earlier than for the one
    before it: two blocks fall in order, whichever rolls on for longer. At the end all hold.

    Raises
    ------
    StudioError
        Where there is no condition.
    """

    conditions: tuple[Condition, ...]
    in_order: bool = False

    def __post_init__(self) -> None:
        if not self.conditions:
            raise StudioError("a scene needs at least one condition that says when it is done")

    @property
    def words(self) -> str:
        """What to do, as a sentence's end: ``push the block down``."""
        return (", then " if self.in_order else " and ").join(c.words for c in self.conditions)

    @property
    def blocks(self) -> tuple[str, ...]:
        """The names of the blocks that it is about, each once, in their order."""
        return tuple(dict.fromkeys(condition.block for condition in self.conditions))


PUSH_DOWN = Success((Down("block"),))


def _by(arm: Side | None) -> str:
    return "" if arm is None else f" with the {arm} arm"
