"""What happened while a person taught: each tick's skeleton, gate, wanted, sent and measured."""

from dataclasses import dataclass

from studio.engine.gate import GateMode, GateStatus
from studio.engine.pipeline import Outcome, Pipeline
from studio.engine.retarget import Angles, Mapping
from studio.engine.skeleton import FloatArray, Side, Skeleton
from studio.engine.sources.recording import SkeletonRecording, from_skeletons
from studio.engine.world import WorldState


@dataclass(frozen=True, eq=False)
class Sample:
    """One control tick."""

    time: float  # [s] since the recording began
    skeleton: Skeleton | None  # the frame that came in this tick, if any
    gate: GateStatus
    held: str  # why the robot did not follow, or nothing
    wanted: Angles | None  # s0, s1, e0, e1 [rad] before the velocity limit; None: gate closed
    sent: FloatArray  # (4,) [rad]
    limited: bool  # whether a position or velocity limit bit
    world: WorldState  # measured joints and blocks, one control period after the command

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
        )


@dataclass(frozen=True)
class RecordingInfo:
    """What a recording says of itself."""

    side: Side
    mapping: Mapping
    gate: GateMode
    source: str  # where its skeletons came from; of the demonstrator, with its seed

    @classmethod
    def of(cls, pipeline: Pipeline, stream: SkeletonRecording) -> "RecordingInfo":
        """Return what a recording of a stream followed through a pipeline says of itself."""
        source = f"{stream.path} ({stream.format})"
        return cls(pipeline.side, pipeline.mapping, pipeline.gate.mode, source)


@dataclass(frozen=True, eq=False)
class Recording:
    """A whole recording, in memory or read back."""

    info: RecordingInfo
    samples: tuple[Sample, ...]
    warning: str = ""  # what is missing of the file that it was read from

    def skeletons(self, path: str, name: str) -> SkeletonRecording:
        """Return the raw skeletons as a stream; ``path`` and ``name`` say where it is from."""
        seen = [sample.skeleton for sample in self.samples if sample.skeleton is not None]
        return from_skeletons(seen, path, name)
