"""What is in a skeleton file, and what in it would hold the gate or the arm: `studio inspect`."""

import math
import os
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from studio.engine.angle_report import AngleRanges, angle_ranges
from studio.engine.arms import Arms, in_words, sides_of
from studio.engine.calibration import Calibration, calibrate_file
from studio.engine.errors import FileError, StudioError
from studio.engine.gate import Gate
from studio.engine.gate_summary import GateSummary, gate_statuses, summarize
from studio.engine.mcap_file import MCAP_FORMAT, is_recording, read_recording
from studio.engine.motion_measures import ArmMeasures
from studio.engine.motion_report import (
    LONGEST_MEASURED,
    beginning,
    measure,
    motion_dict,
    motion_lines,
)
from studio.engine.problems import dropped_frames, duplicate_frames, find_problems
from studio.engine.recorded import Recorded, how_in_words
from studio.engine.retarget import Mapping as RobotMapping
from studio.engine.skeleton import HandState, Side, Tracking, other_side
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
    duplicates: int  # frames that show the same picture as the one before
    dropped: int  # frames that the stamps say are missing
    gate: GateSummary | None  # None where the file tells no hand states
    motion: tuple[ArmMeasures, ...]  # of each asked arm of the robot, the gate open all the time
    angles: tuple[AngleRanges, ...]  # the paper's, of the person's arms that these follow
    problems: tuple[str, ...]  # sentences; frames in them are counted from 0
    mirrored: bool = False  # with what motion and problems were found
    calibration: Calibration | None = None
    recorded: Recorded | None = None  # of a studio's recording: what happened

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
            "duplicate_frames": self.duplicates,
            "dropped_frames": self.dropped,
            "gate": None if self.gate is None else self.gate.to_dict(),
            "mirrored": self.mirrored,
            "lean_deg": None if self.calibration is None else math.degrees(self.calibration.lean),
            "motion": [motion_dict(each) for each in self.motion],
            "person": [each.to_dict() for each in self.angles],
            "problems": list(self.problems),
            "recorded": None if self.recorded is None else self.recorded.to_dict(),
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
                f"  stream      {self.duplicates} duplicate frames, {self.dropped} dropped",
                f"  gate        {self.gate or 'no hand states: it can only be opened by hand'}",
                *self._motion_lines(),
                *self._recorded_lines(),
                f"  problems    {'none' if not self.problems else '(frames count from 0)'}",
                *(f"    - {problem}" for problem in self.problems),
            ]
        )

    def _motion_lines(self) -> Iterator[str]:
        for each, angles in zip(self.motion, self.angles, strict=True):
            whole = self.seconds <= LONGEST_MEASURED
            place = "" if whole else f", the first {LONGEST_MEASURED / 60:.0f} minutes"
            how = how_in_words(each.mapping, self.mirrored, self.calibration)
            yield f"  {each.side} arm, {how}, as if the gate were open{place}:"
            yield from (f"    {line}" for line in motion_lines(each))
            yield f"    person      {angles.side} arm, 5th to 95th percentile: {angles}"

    def _recorded_lines(self) -> Iterator[str]:
        if self.recorded is not None:
            info = self.recorded.info
            how = how_in_words(info.mapping, info.mirrored, info.calibration)
            yield f"  as recorded, {in_words(info.arms)}, {how}:"
            yield from (f"    {line}" for line in self.recorded.lines())


def inspect_file(
    path: str | os.PathLike[str],
    body: str | None = None,
    arms: Arms | None = None,
    mapping: RobotMapping | None = None,
    mirrored: bool = False,
    calibrate_at: float | None = None,
) -> Inspection:
    """Return what is in a skeleton file, following ``body`` or the body that teaching would follow.

    Of an MCAP recording the skeletons that it holds are inspected, and what was recorded is told.
    Arm, mapping, mirroring and calibration are the recording's unless others are asked for; of
    files, the left arm, "exact", and neither. ``calibrate_at`` [s] is where the neutral pose
    begins.

    Raises
    ------
    FileError
        As `studio.engine.sources.read_skeletons`, `studio.engine.mcap_file.read_recording` and
        `studio.engine.calibration.calibrate_file` do.
    """
    if not is_recording(Path(path)):
        stream = read_skeletons(path, body)
        calibration = None if calibrate_at is None else calibrate_file(stream, calibrate_at)
        return inspect_recording(stream, arms or "left", mapping or "exact", mirrored, calibration)
    recording = read_recording(Path(path))
    info = recording.info
    try:
        stream = recording.skeletons(str(path), MCAP_FORMAT, body)
    except StudioError as error:
        raise FileError(f"{path}: {error}") from None
    calibration = info.calibration
    if calibrate_at is not None:
        calibration = calibrate_file(stream, calibrate_at)
    found = inspect_recording(
        stream,
        arms or info.arms,
        mapping or info.mapping,
        mirrored or info.mirrored,
        calibration,
    )
    warnings = (recording.warning,) if recording.warning else ()
    return replace(found, problems=(*warnings, *found.problems), recorded=Recorded.of(recording))


def inspect_recording(
    recording: SkeletonRecording,
    arms: Arms = "left",
    mapping: RobotMapping = "exact",
    mirrored: bool = False,
    calibration: Calibration | None = None,
) -> Inspection:
    """Return what is in skeletons that were read already, wherever they are from."""
    states: Counter[int] = Counter()
    for skeleton in recording:
        states.update(skeleton.tracking.tolist())
    has_hands = recording.has_hand_states
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
        duplicates=int(duplicate_frames(recording).sum()),
        dropped=dropped_frames(recording),
        gate=summarize(gate_statuses(Gate(), recording)) if has_hands else None,
        motion=measure(recording, arms, mapping, mirrored, calibration),
        angles=_angles(recording, arms, mirrored),
        problems=find_problems(recording, calibration),
        mirrored=mirrored,
        calibration=calibration,
    )


def _angles(recording: SkeletonRecording, arms: Arms, mirrored: bool) -> tuple[AngleRanges, ...]:
    """Return the ranges of the person's arms that the robot's follow; none where nobody is seen."""
    if not len(recording):
        return ()
    sides = [other_side(side) if mirrored else side for side in sides_of(arms)]
    return tuple(angle_ranges(beginning(recording), side) for side in sides)


def _hand_counts(recording: SkeletonRecording, side: Side) -> dict[str, int]:
    counts = Counter(skeleton.hand(side).state for skeleton in recording)
    return {state.value: counts[state] for state in HandState}


def _counted(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{name.replace('_', ' ')} {count}" for name, count in counts.items())
