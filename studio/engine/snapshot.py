"""What a session shows of itself after every tick: immutable, so that any thread may draw it."""

from dataclasses import dataclass
from enum import StrEnum

from studio.engine.choices import Choices
from studio.engine.collection import CollectionStatus
from studio.engine.compare_status import CompareStatus
from studio.engine.entry import Entry
from studio.engine.evaluate.tryout import TryoutStatus
from studio.engine.export_status import ExportStatus
from studio.engine.gate import GateStatus
from studio.engine.learning_status import LearningStatus
from studio.engine.links.status import LinkStatus
from studio.engine.live.status import LiveStatus
from studio.engine.pipeline import Lag
from studio.engine.skeleton import FloatArray, Skeleton
from studio.engine.sources import SkeletonRecording
from studio.engine.teaching import Lesson, Reproduction
from studio.engine.who_status import WhoStatus
from studio.engine.world import Scene, WorldState


class Mode(StrEnum):
    """What the session is doing, for the state pill."""

    IDLE = "idle"
    WATCHING = "watching"  # the robot waits for the gate
    ARMED = "armed"  # the robot follows
    RECORDING = "recording"
    PLAYING = "playing"
    CALIBRATING = "calibrating"
    TRAINING = "training"  # somebody waits for what is being computed; the robot holds still
    DRIVEN = "driven"  # a program says where its joints go


@dataclass(frozen=True)
class SourceStatus:
    """The source of skeletons."""

    name: str  # as people know it; empty where none is chosen
    frames: int
    seconds: float
    has_hand_states: bool
    is_live: bool = False

    @classmethod
    def of(cls, stream: SkeletonRecording) -> "SourceStatus":
        """Return what people should know of a stream."""
        return cls(stream.path, stream.frames, stream.seconds, stream.has_hand_states)


@dataclass(frozen=True)
class Message:
    """The newest thing that a person should know; the number tells one from the next."""

    number: int
    text: str
    is_error: bool = False


@dataclass(frozen=True)
class Progress:
    """How far a calibration has come."""

    share: float  # of the time for which the pose has to be held, 0 to 1
    words: str  # what the person should do


@dataclass(frozen=True)
class DrivenStatus:
    """A robot that a program drives."""

    joints: tuple[str, ...]  # that it may drive
    follows: bool  # it has come to where the program began, and keeps up from there
    arrived: bool  # it is where the last targets are, as far as guard and limits let it
    holds: bool  # the program was silent for too long


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Everything that a panel may draw."""

    mode: Mode
    message: Message
    time: float  # [s] since the present activity began
    duration: float  # [s] that it will take, 0 for none
    choices: Choices
    calibrated_with: str  # the source that the choices' calibration was taken from
    calibrating: Progress | None  # None while nobody calibrates
    source: SourceStatus | None
    who: WhoStatus  # what else there is to tell of who teaches
    live: LiveStatus | None  # the live streams that may be the source; None where none are taken
    skeleton: Skeleton | None  # the newest one; the source's first while nobody is watched
    gate: GateStatus | None  # None while nobody is watched
    held: str  # why the robot does not follow
    guarded: str  # what the collision guard keeps apart at this moment, in words
    lag: Lag  # by which what is sent is behind the person
    alone: bool  # it plays what it learned, not a demonstration
    world: WorldState
    scene: Scene  # what stands around the robot in it, for the arms that are taught
    entries: tuple[Entry, ...]
    chosen: int  # index of the ghost's demonstration; -1 for none
    collection: CollectionStatus  # recordings, and what was deleted
    ghost: FloatArray | None  # (15,) [rad], the chosen demonstration at this moment of playing
    learning: LearningStatus
    lesson: Lesson | None
    reproduction: Reproduction | None
    tryout: TryoutStatus
    compare: CompareStatus
    export: ExportStatus
    recorded: int  # ticks in the recording that is being made
    saved_as: str  # the last recording's file
    link: LinkStatus  # the robot beyond the simulator
    driven: DrivenStatus | None  # None while no program drives the robot
    stopped: bool  # by a Stop: programs' targets do not count until one begins anew
