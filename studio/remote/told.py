"""What the studio sends."""

from typing import Any

from studio.remote.learned import Deviation, LessonSummary
from studio.remote.message import Message, Part
from studio.remote.person import GateState
from studio.remote.place import Driven
from studio.remote.snapshot import Snapshot

VERSION = 1  # rises whenever an older program would misread something


class Welcome(Message, frozen=True):
    """The first message of a connection: what there is to drive, in which order it is told."""

    version: int
    studio: str  # its version
    name: str  # as others know this program
    joints: list[str]
    lower: list[float]  # [rad]
    upper: list[float]  # [rad]
    velocity: list[float]  # [rad/s] at most
    period: float  # [s] of a tick


class Done(Message, frozen=True):
    """What was asked is done; ``words`` are what the studio says of it, if anything."""

    id: int
    words: str = ""


class Error(Message, frozen=True):
    """What was asked cannot be, and why; ``place`` is where in the message, if it is there."""

    words: str
    id: int | None = None  # null where that could not be read, or nothing was asked
    place: str = ""


class JointStates(Message, frozen=True):
    """Where all joints are, in the order that `Welcome` tells."""

    tick: int
    time: float  # [s] since the world began
    positions: list[float]  # [rad]
    velocities: list[float]  # [rad/s]
    mode: str
    guarded: str  # what the collision guard keeps apart, in words
    driven: Driven | None
    stopped: bool  # by a Stop: no target counts until `BeginDriving`
    id: int | None = None
    missed: int = 0


class Gate(Message, frozen=True):
    """Whether the robot follows a person, or in words why not; null while nobody is watched."""

    tick: int
    gate: GateState | None
    held: str
    id: int | None = None
    missed: int = 0


class Block(Message, frozen=True):
    """The blocks, and whether the task is done."""

    tick: int
    time: float  # [s] since the world began
    poses: list[list[float]]  # x y z [m] qx qy qz qw of each
    touched: bool
    tilt: float  # [rad] of the task's
    down: bool
    done: bool  # the scene's task; of the paper's it is the same
    missing: str  # for that, in words
    id: int | None = None
    missed: int = 0


class Role(Message, frozen=True):
    """Who controls; the answer to `Control`, and sent whenever it changes."""

    controls: bool  # this program does
    holder: str  # who does, as others know it; empty for nobody
    asking: str  # who asks; empty for nobody
    left: float  # [s] until whoever asks gets it
    words: str
    id: int | None = None


class Stepped(Message, frozen=True):
    """The world after a `Step`, and after the clock was taken."""

    id: int
    state: JointStates
    block: Block


class ClockLost(Message, frozen=True):
    """Time goes on by itself again, and why."""

    words: str


class Lesson(Message, frozen=True):
    """What was learned, whole."""

    id: int
    summary: LessonSummary
    model: dict[str, Any] | None  # as the export "model" writes it; null for fields
    curve: list[list[float]]  # (142, D) [rad] the network's output
    mean: list[list[float]]  # (142, D) [rad] of the demonstrations
    taught: list[list[list[float]]]  # (K, 142, D) [rad]


class Demonstration(Message, frozen=True):
    """A listed demonstration, as it is trimmed."""

    id: int
    number: int
    name: str
    joints: list[str]
    times: list[float]  # [s]
    sent: list[list[float]]  # (T, D) [rad]


class Reproduction(Message, frozen=True):
    """What Baxter did alone, tick by tick."""

    id: int
    deviation: Deviation
    block_down: bool
    done: bool  # the scene's task
    duration: float  # [s] of the motion
    times: list[float]  # [s] at which each command was given
    measured: list[list[float]]  # (T, 15) [rad] one tick after it
    block_poses: list[list[list[float]]]
    guarded: str


class Equation(Part, frozen=True):
    """A number with its formula."""

    name: str
    unit: str
    value: float | None  # null where it is no finite number
    formula: str
    filled: str
    source: str


class Equations(Message, frozen=True):
    """All numbers of what was learned, by their keys."""

    id: int
    equations: dict[str, Equation]


class Rollout(Part, frozen=True):
    """Where a start leads, seen on the plane [rad]."""

    start: tuple[float, float]
    stable: list[tuple[float, float]] | None
    plain: list[tuple[float, float]]


class Field(Message, frozen=True):
    """One leg of a learned field, in the plane of the demonstrations [rad]."""

    id: int
    leg: int
    legs: int
    demonstrations: list[list[tuple[float, float]]]
    places: list[tuple[float, float]]  # of arrows
    stable: list[tuple[float, float]] | None  # the arrows
    plain: list[tuple[float, float]]
    rollouts: list[Rollout]


class FilePart(Message, frozen=True):
    """A part of a file, from ``offset`` on; it is the last one where it ends at ``size``."""

    id: int
    name: str
    offset: int  # [bytes]
    size: int  # [bytes] of the whole
    content: bytes  # in base64


class UploadTaken(Message, frozen=True):
    """A part of a file has come."""

    id: int
    upload: str  # what names it
    size: int  # [bytes] so far


Told = (
    Welcome
    | Done
    | Error
    | JointStates
    | Gate
    | Block
    | Snapshot
    | Role
    | Stepped
    | ClockLost
    | Lesson
    | Demonstration
    | Reproduction
    | Equations
    | Field
    | FilePart
    | UploadTaken
)
