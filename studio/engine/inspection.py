"""What is in a skeleton file, and what in it would hold the gate or the arm: `studio inspect`."""

import os
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from studio.engine.mcap_file import MCAP_FORMAT, is_mcap, read_recording
from studio.engine.problems import find_problems
from studio.engine.skeleton import HandState, Side, Tracking
from studio.engine.sources.files import read_skeletons
from studio.engine.sources.recording import SkeletonRecording


@dataclass(frozen=True)
class Inspection:
    """What a recording holds. Hands and tracking are the followed body's, duplicates included."""

    path: str
    format: str
    frames: int  # as in the file, also those in which nobody is seen
    seconds: float  # from the first frame to the last
    bodies: Mapping[str, int]  # the ids of all bodies seen, and in how many frames
    left_hand: Mapping[str, int]  # the number of frames for each HandState
    right_hand: Mapping[str, int]
    tracking: Mapping[str, int]  # of all 25 joints of all frames: tracked, inferred, not_tracked
    problems: tuple[str, ...]  # sentences; frames in them are counted from 0

    def to_dict(self) -> dict[str, object]:
        """Return the same as JSON knows it; ``bodies`` is a list of {id, frames}."""
        return {
            "format": self.format,
            "frames": self.frames,
            "seconds": self.seconds,
            "bodies": [{"id": name, "frames": count} for name, count in self.bodies.items()],
            "left_hand": dict(self.left_hand),
            "right_hand": dict(self.right_hand),
            "tracking": dict(self.tracking),
            "problems": list(self.problems),
        }

    def __str__(self) -> str:
        bodies = ", ".join(f"{name} ({count} frames)" for name, count in self.bodies.items())
        return "\n".join(
            [
                f"{self.path}: {self.format}, {self.frames} frames, {self.seconds:.2f} s",
                f"  bodies      {bodies or 'none'}",
                f"  left hand   {_counted(self.left_hand)}",
                f"  right hand  {_counted(self.right_hand)}",
                f"  joints      {_counted(self.tracking)}",
                f"  problems    {'none' if not self.problems else '(frames count from 0)'}",
                *(f"    - {problem}" for problem in self.problems),
            ]
        )


def inspect_file(path: str | os.PathLike[str], body: str | None = None) -> Inspection:
    """Return what is in a skeleton file, following ``body`` or the body that teaching would follow.

    Of an MCAP recording the skeletons that it holds are inspected.

    Raises
    ------
    FileError
        As `studio.engine.sources.read_skeletons` and `studio.engine.mcap_file.read_recording` do.
    """
    if is_mcap(Path(path)):
        return _inspect_mcap(Path(path))
    return inspect_recording(read_skeletons(path, body))


def _inspect_mcap(path: Path) -> Inspection:
    recording = read_recording(path)
    found = inspect_recording(recording.skeletons(str(path), MCAP_FORMAT))
    if not recording.warning:
        return found
    return replace(found, problems=(recording.warning, *found.problems))


def inspect_recording(recording: SkeletonRecording) -> Inspection:
    """Return what is in skeletons that were read already, wherever they are from."""
    states: Counter[int] = Counter()
    for skeleton in recording:
        states.update(skeleton.tracking.tolist())
    return Inspection(
        path=recording.path,
        format=recording.format,
        frames=recording.frames,
        seconds=recording.seconds,
        bodies=recording.bodies,
        left_hand=_hand_counts(recording, "left"),
        right_hand=_hand_counts(recording, "right"),
        tracking={
            state.name.lower(): states[state]
            for state in (Tracking.TRACKED, Tracking.INFERRED, Tracking.NOT_TRACKED)
        },
        problems=find_problems(recording),
    )


def _hand_counts(recording: SkeletonRecording, side: Side) -> dict[str, int]:
    counts = Counter(skeleton.hand(side).state for skeleton in recording)
    return {state.value: counts[state] for state in HandState}


def _counted(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{name.replace('_', ' ')} {count}" for name, count in counts.items())
