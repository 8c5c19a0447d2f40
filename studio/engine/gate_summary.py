"""When a gate was armed over a recording, and why not for the rest of the time."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from studio.engine.gate import Gate, GateMemory, GateStatus
from studio.engine.sources.recording import SkeletonRecording


@dataclass(frozen=True)
class GateSummary:
    """Counts over frames of a file, or over ticks of a studio's recording, from 0."""

    frames: int
    armed: tuple[tuple[int, int], ...]  # first and last frame of each time it was armed
    reasons: tuple[tuple[str, int], ...]  # why it was not, in how many frames; most frequent first

    @property
    def armed_frames(self) -> int:
        """In how many frames it was armed."""
        return sum(last - first + 1 for first, last in self.armed)

    def to_dict(self) -> dict[str, object]:
        """Return the same as JSON knows it."""
        return {
            "frames": self.frames,
            "armed_frames": self.armed_frames,
            "armed": [{"first": first, "last": last} for first, last in self.armed],
            "not_armed": [{"reason": reason, "frames": count} for reason, count in self.reasons],
        }

    def __str__(self) -> str:
        times = ", ".join(f"{first}-{last}" for first, last in self.armed[:5])
        more = ", ..." if len(self.armed) > 5 else ""
        armed = f"armed in {self.armed_frames} of {self.frames} ({times}{more})"
        why = ", ".join(f"{reason} ({count})" for reason, count in self.reasons)
        return "; ".join(part for part in (armed if self.armed else "never armed", why) if part)


def gate_statuses(gate: Gate, recording: SkeletonRecording) -> Iterator[GateStatus]:
    """Yield what a gate thinks after each frame of a file."""
    memory: GateMemory | None = None
    for time, skeleton in recording.by_frame():
        memory, status = gate.step(memory, skeleton, time)
        yield status


def summarize(statuses: Iterable[GateStatus]) -> GateSummary:
    """Return the summary of what a gate thought, frame by frame."""
    armed: list[tuple[int, int]] = []
    reasons: Counter[str] = Counter()
    frames = 0
    for frame, status in enumerate(statuses):
        frames = frame + 1
        if not status.armed:
            reasons[status.reason] += 1
        elif armed and armed[-1][1] == frame - 1:
            armed[-1] = (armed[-1][0], frame)
        else:
            armed.append((frame, frame))
    return GateSummary(frames, tuple(armed), tuple(reasons.most_common()))
