"""Parts of a snapshot: demonstrations, what was learned from them, and what stands beside what."""

from studio.remote.commands import LearnerSettings
from studio.remote.message import Part
from studio.remote.place import World


class Flag(Part, frozen=True):
    """Something that is wrong with a demonstration."""

    name: str
    value: float
    threshold: float
    unit: str
    words: str
    places: list[tuple[float, float]]  # [s]


class Entry(Part, frozen=True):
    """A demonstration on the list."""

    number: int  # by which commands name it
    name: str
    included: bool  # whether it is learned from
    arms: str
    mapping: str
    duration: float  # [s]
    span: tuple[float, float]  # [s] of what was recorded, that is kept
    is_trimmed: bool
    done: bool  # the scene's task, at its end
    flags: list[Flag] | None  # null until it was looked at
    file: str | None  # the recording's


class FolderFile(Part, frozen=True):
    """A file in the recordings folder."""

    name: str
    size: int  # [bytes]
    modified: float  # [s] since 1970
    seconds: float | None
    problem: str
    can_open: bool


class Collection(Part, frozen=True):
    """What lies in the recordings folder, and what can be brought back."""

    folder: str
    files: list[FolderFile]
    problem: str
    listed: list[str]  # names of files whose demonstrations are listed
    removed: str
    goes_too: str


class Underway(Part, frozen=True):
    """Work that somebody waits for."""

    words: str
    share: float | None  # 0 to 1


class ErrorPoint(Part, frozen=True):
    """How well one number of neurons learns."""

    neurons: int
    mse: float | None  # [rad²]
    floor_ratio: float | None
    held_out: float | None
    held_out_ratio: float | None


class Suggestion(Part, frozen=True):
    """How many neurons are enough, and why."""

    neurons: int
    words: str


class Curve(Part, frozen=True):
    """Errors against numbers of neurons, as far as they are known."""

    learner: str
    points: list[ErrorPoint]
    note: str
    suggestion: Suggestion | None


class BlockPoint(Part, frozen=True):
    """What Baxter does alone with one number of neurons."""

    neurons: int
    block_down: bool
    mse: float | None  # [rad²]
    hand_error: float | None  # [m]


class Tried(Part, frozen=True):
    """Whether the block falls with one network, and what somebody had said."""

    learner: str
    point: BlockPoint
    guess: bool | None


class Learning(Part, frozen=True):
    """What is being learned, and what was found out."""

    chosen: LearnerSettings
    underway: Underway | None
    curve: Curve
    is_drawing: bool
    tried: list[Tried]


class LessonSummary(Part, frozen=True):
    """What was learned; `Fetch` has the rest."""

    settings: LearnerSettings
    joints: list[str]
    duration: float  # [s] of the motion
    mse: list[float]  # [rad²] of each joint
    floor: list[float] | None
    floor_note: str
    remark: str


class Deviation(Part, frozen=True):
    """How far what was measured is from what was meant."""

    joint_rmse: list[float]  # [rad]
    hand_mean: float  # [m]
    hand_max: float  # [m]
    hand_dtw: float  # [m]


class ReproductionSummary(Part, frozen=True):
    """What Baxter made of it alone."""

    block_down: bool
    done: bool  # the scene's task
    deviation: Deviation


class Timeline(Part, frozen=True):
    """What is on the timeline; the snapshot's time is the playhead."""

    title: str
    motion: float  # [s]
    is_playing: bool
    speed: float
    loops: bool


class Measured(Part, frozen=True):
    """A column of the table that compares."""

    name: str
    letter: str
    deviation: Deviation
    acceleration: float  # [m/s²]
    block_down: bool
    guarded: str


class Compare(Part, frozen=True):
    """What stands beside what."""

    timeline: Timeline
    beside: World | None  # the second robot's
    kept: LessonSummary | None
    moved: bool
    table: list[Measured]


class Rate(Part, frozen=True):
    """How often the task was done, with its 95 % confidence interval."""

    successes: int
    trials: int
    low: float
    high: float


class Tryout(Part, frozen=True):
    """The newest test under varied conditions."""

    asked: int  # trials
    rate: Rate | None
    replayed: Rate | None  # of the demonstrations in the same trials
    failures: list[tuple[str, int]]  # why, and how often
    goes_on: bool
