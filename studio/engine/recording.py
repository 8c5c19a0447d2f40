"""What happened while a person taught: each tick's skeleton, gate, wanted, sent and measured."""

from dataclasses import dataclass
from typing import Protocol

from studio.engine.arms import Arms
from studio.engine.calibration import Calibration
from studio.engine.gate import GateMode, GateStatus
from studio.engine.hands import PLAIN, STILL, HandCommand, HandOptions
from studio.engine.live.latency import LatencyChain
from studio.engine.pipeline import NO_LAG, Lag, Outcome, Pipeline
from studio.engine.retarget import Mapping
from studio.engine.scene import USUAL, Scene
from studio.engine.skeleton import FloatArray, Skeleton
from studio.engine.sources.recording import SkeletonRecording, from_skeletons
from studio.engine.world import WorldState


class Origin(Protocol):
    """Where skeletons come from, as far as a recording tells of it."""

    @property
    def path(self) -> str:
        """As people know it."""
        ...

    @property
    def format(self) -> str:
        """Short, such as "table 101"."""
        ...


@dataclass(frozen=True, eq=False)
class Sample:
    """One control tick."""

    time: float  # [s] since the recording began
    skeleton: Skeleton | None  # the frame that came in this tick, if any
    gate: GateStatus
    held: str  # why the robot did not follow, or nothing
    wanted: tuple[float, ...] | None  # (D,) [rad] before engagement and limits; None: gate closed
    sent: FloatArray  # (D,) [rad] of the driven joints: s0, s1, e0, e1 of each taught arm
    limited: bool  # whether a position or velocity limit bit
    world: WorldState  # measured joints and blocks, one control period after the command
    guarded: str = ""  # what the collision guard kept apart, in words
    hands: HandCommand = STILL  # what wrists and grippers were told
    lag: Lag = NO_LAG  # by which sent was behind wanted
    latency: LatencyChain | None = None  # of a live stream, once a second

    @classmethod
    def of(
        cls, time: float, skeleton: Skeleton | None, outcome: Outcome, world: WorldState
    ) -> "Sample":
        """Return what one tick of the pipeline and the world amounts to."""
        return cls(
            time,
            skeleton,
            outcome.gate,
            outcome.held,
            outcome.wanted,
            outcome.command.sent,
            outcome.command.limited,
            world,
            outcome.command.guarded,
            outcome.hands,
            outcome.lag,
        )


@dataclass(frozen=True)
class RecordingInfo:
    """What a recording says of itself."""

    arms: Arms
    mapping: Mapping
    gate: GateMode
    source: str  # where its skeletons came from; of the demonstrator, with its seed
    mirrored: bool = False
    calibration: Calibration | None = None
    hands: HandOptions = PLAIN
    scene: Scene = USUAL  # in which it was taught, before anybody moved a block

    @classmethod
    def of(cls, pipeline: Pipeline, origin: Origin, scene: Scene = USUAL) -> "RecordingInfo":
        """Return what a recording of skeletons followed through a pipeline says of itself."""
        source = f"{origin.path} ({origin.format})"
        return cls(
            pipeline.arms,
            pipeline.mapping,
            pipeline.gate.mode,
            source,
            pipeline.mirrored,
            pipeline.calibration,
            pipeline.hands.options,
            scene,
        )


@dataclass(frozen=True, eq=False)
class Recording:
    """A whole recording, in memory or read back."""

    info: RecordingInfo
    samples: tuple[Sample, ...]
    warning: str = ""  # what is missing of the file that it was read from

    def skeletons(self, path: str, name: str, body: str | None = None) -> SkeletonRecording:
        """Return the raw skeletons as a stream; ``path`` and ``name`` say where it is from.

        Raises StudioError where ``body`` is asked for and not seen.
        """
        seen = [sample.skeleton for sample in self.samples if sample.skeleton is not None]
        return from_skeletons(seen, path, name, body)
