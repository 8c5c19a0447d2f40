"""Everything that a panel may draw, as a message; what is large is fetched on its own."""

from studio.remote.commands import Choices
from studio.remote.learned import (
    Collection,
    Compare,
    Entry,
    Learning,
    LessonSummary,
    ReproductionSummary,
    Tryout,
)
from studio.remote.message import Message, Part
from studio.remote.person import GateState, Lag, Live, Progress, Skeleton, Source, Who
from studio.remote.place import Driven, LinkedRobot, Scene, World


class News(Part, frozen=True):
    """The newest thing that a person should know; the number tells one from the next."""

    number: int
    text: str
    is_error: bool


class Exports(Part, frozen=True):
    """How an export stands; `FetchFile` reads its files."""

    running: list[str]
    share: float
    number: int  # of the newest one that is done
    files: list[str]
    opening: str


class Snapshot(Message, frozen=True):
    """Everything that a panel may draw."""

    tick: int  # that the session has done since programs are let in
    mode: str
    message: News
    time: float
    duration: float
    choices: Choices
    calibrated_with: str
    calibrating: Progress | None
    source: Source | None
    who: Who
    live: Live | None
    skeleton: Skeleton | None
    gate: GateState | None
    held: str
    guarded: str
    lag: Lag
    alone: bool
    world: World
    entries: list[Entry]
    chosen: int  # index in entries; -1 for none
    collection: Collection
    ghost: list[float] | None
    learning: Learning
    lesson: LessonSummary | None
    reproduction: ReproductionSummary | None
    compare: Compare
    export: Exports
    recorded: int
    saved_as: str
    driven: Driven | None
    stopped: bool
    scene: Scene
    tryout: Tryout
    link: LinkedRobot
    id: int | None = None  # of the request that this answers; null in a stream
    missed: int = 0  # frames of this stream that were not read in time
