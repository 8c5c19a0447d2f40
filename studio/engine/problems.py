"""What in a recording would hold the gate or the arm, in words, with counts and places.

Frames are counted from 0, as in the file. The gate and the arm are asked themselves, so that the
words here are the ones that a person reads while teaching.
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from studio.engine.calibration import Calibration
from studio.engine.gate import SEQUENCE, UNSEEN, Gate
from studio.engine.gate_summary import gate_statuses, summarize
from studio.engine.human import ArmVectors, Held, arm_vectors
from studio.engine.retarget import solve_arm
from studio.engine.skeleton import FRAME_RATE, SIDES, FloatArray, HandState, Joint, Side, Tracking
from studio.engine.sources.recording import SkeletonRecording

FARTHEST = 20.0  # [m] from the sensor; a Kinect sees bodies up to about 4.5 m
LONG_INTERVAL = 1.5  # times the median, from which an interval counts as a gap
RATE_TOLERANCE = 0.2  # by which the median interval may differ from a Kinect's
LENGTH_TOLERANCE = 1.25  # of a forearm's 95th to its 5th percentile; a bone keeps its length
LOWEST_UPPER_ARM = 1.047  # [rad] Baxter's upper limit of s1: 60° below level

Problems = Iterator[str]
Mask = NDArray[np.bool_]


def find_problems(
    recording: SkeletonRecording, calibration: Calibration | None = None
) -> tuple[str, ...]:
    """Return the problems of a recording as sentences; none where all is well.

    Arms and sides in them are the person's.
    """
    if not len(recording):
        return ("nobody is seen in this file",)
    finders: tuple[Callable[[SkeletonRecording], Problems], ...] = (
        _format_problems,
        _body_problems,
        _timing_problems,
        _gate_problems,
        partial(_arm_problems, calibration=calibration),
    )
    return tuple(problem for find in finders for problem in find(recording))


def duplicate_frames(recording: SkeletonRecording) -> Mask:
    """Return which skeletons (n,) show the same picture as the file's frame before."""
    following = np.diff(recording.frame_indices, prepend=-2) == 1
    same = [
        before.body_id == after.body_id and np.array_equal(before.positions, after.positions)
        for before, after in pairwise(recording)
    ]
    duplicates: Mask = following & np.array([False, *same][: len(recording)], dtype=bool)
    return duplicates


def dropped_frames(recording: SkeletonRecording) -> int:
    """Return how many frames are missing, judged by intervals of twice the median and more."""
    intervals = np.diff(recording.frame_times)
    if not recording.has_stamps or not (intervals > 0).any():
        return 0
    median = float(np.median(intervals[intervals > 0]))
    return int(np.maximum(np.rint(intervals / median) - 1, 0).sum())


def runs_of(mask: Mask) -> list[tuple[int, int]]:
    """Return the first and last index of each unbroken run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]])))
    return [(int(first), int(end) - 1) for first, end in edges.reshape(-1, 2)]


def _format_problems(recording: SkeletonRecording) -> Problems:
    if not recording.has_hand_states:
        yield (
            "no hand states in this file: the gate's sequence can never arm; "
            "open it by hand (`--gate open`)"
        )
    if not recording.has_tracking:
        yield "no joint tracking in this file: every joint is taken for tracked"
    if not recording.has_stamps:
        yield f"no stamps in this file: {FRAME_RATE:g} frames a second are assumed"
    farthest = max(float(np.abs(skeleton.positions).max()) for skeleton in recording)
    if farthest > FARTHEST:
        yield f"positions reach {farthest:.3g} m from the sensor: are they in meters?"


def _body_problems(recording: SkeletonRecording) -> Problems:
    if len(recording.bodies) > 1:
        seen = [f"{name} ({count} frames)" for name, count in recording.bodies.items()]
        yield f"{len(seen)} bodies are seen: {_first_few(seen)}"
    changes = [
        f"{after.body_id} from frame {recording.frame_indices[index]} on"
        for index, (before, after) in enumerate(pairwise(recording), start=1)
        if before.body_id != after.body_id
    ]
    if changes:
        yield f"the body that is followed changes: {_first_few(changes)}"
    absent = ~_by_frame(recording, np.ones(len(recording), dtype=bool))
    if absent.any():
        yield f"nobody to follow in {_places(absent)}"


def _timing_problems(recording: SkeletonRecording) -> Problems:
    duplicates = _by_frame(recording, duplicate_frames(recording))
    if duplicates.any():
        yield f"duplicate frames, which tell nothing new: {_places(duplicates)}"
    intervals = np.diff(recording.frame_times)  # (F - 1,) [s]
    if not (intervals > 0).any():
        return
    if (intervals == 0).any():
        equal = np.concatenate([[False], intervals == 0])
        yield f"frames with the stamp of the frame before: {_places(equal)}"
    median = float(np.median(intervals[intervals > 0]))
    if abs(median * FRAME_RATE - 1.0) > RATE_TOLERANCE:
        yield (
            f"frames come every {1000 * median:.3g} ms in the median; "
            f"a Kinect sends one every {1000 / FRAME_RATE:.3g} ms"
        )
    long = intervals > LONG_INTERVAL * median
    if long.any():
        worst = int(np.argmax(intervals))
        yield (
            f"gaps in the stamps: {long.sum()} of {len(intervals)} intervals exceed {LONG_INTERVAL}"
            f" times the median of {1000 * median:.3g} ms; the longest, "
            f"{1000 * float(intervals[worst]):.3g} ms, ends at frame {worst + 1}"
        )


def _gate_problems(recording: SkeletonRecording) -> Problems:
    if not recording.has_hand_states:
        return
    gate = Gate()
    states = [skeleton.hand(gate.hand).state for skeleton in recording]
    unseen = _by_frame(recording, [state in UNSEEN for state in states])
    yield from _lost_hand_problems(gate, recording.frame_times, runs_of(unseen))
    missing = _missing_sign(states)
    if missing:
        yield f"{gate.hand} hand: {missing}"
    found = summarize(gate_statuses(gate, recording))
    if not found.armed:
        counts = ", ".join(f"{reason} ({count} frames)" for reason, count in found.reasons)
        yield f"the gate never arms: {counts}"


def _lost_hand_problems(
    gate: Gate, frame_times: FloatArray, runs: list[tuple[int, int]]
) -> Problems:
    """Tell of runs of frames without a hand state that the gate does not bridge."""
    last_frame = len(frame_times) - 1
    losses = [
        float(frame_times[min(last + 1, last_frame)] - frame_times[first]) for first, last in runs
    ]
    count = sum(seconds > gate.longest_gap + 1e-9 for seconds in losses)  # n/30 s are rounded
    if count:
        longest = int(np.argmax(losses))
        first, last = runs[longest]
        yield (
            f"{gate.hand} hand unknown or not tracked for longer than the gate bridges "
            f"({gate.longest_gap:g} s); runs: {count}, the longest {losses[longest]:.2f} s "
            f"in frames {first}-{last}"
        )


def _missing_sign(states: list[HandState]) -> str:
    """Return which sign of the gate's sequence never comes in its turn."""
    start = 0
    for number, sign in enumerate(SEQUENCE):
        if sign not in states[start:]:
            earlier = " and ".join(before.value.capitalize() for before in SEQUENCE[:number])
            after = f" after {earlier}" if earlier else ""
            return f"{sign.value.capitalize()} is never seen{after}"
        start = states.index(sign, start) + 1
    return ""


def _arm_problems(recording: SkeletonRecording, calibration: Calibration | None) -> Problems:
    for side in SIDES:
        for part in ("shoulder", "elbow", "wrist"):
            joint = Joint.of(part, side)
            inferred = [skeleton.tracking[joint] == Tracking.INFERRED for skeleton in recording]
            if any(inferred):
                yield f"{side} {part} inferred in {_places(_by_frame(recording, inferred))}"
    for side in SIDES:
        seen = [arm_vectors(skeleton, side) for skeleton in recording]
        reasons = [each.reason if isinstance(each, Held) else "" for each in seen]
        for reason in sorted(set(reasons) - {""}):
            held = _by_frame(recording, [each == reason for each in reasons])
            yield f"{side} arm held, {reason}: {_places(held)}"
        arms = [each for each in seen if isinstance(each, ArmVectors)]
        yield from _reach_problems(arms, side, calibration)
        yield from _forearm_problems(recording, side)


def _reach_problems(
    arms: list[ArmVectors], side: Side, calibration: Calibration | None
) -> Problems:
    below = 0
    for arm in arms:
        bones = [arm.torso.from_camera(bone) for bone in (arm.upper_arm, arm.forearm)]
        upper_arm, forearm = map(calibration.correct, bones) if calibration else bones
        below += solve_arm(upper_arm, forearm, side, "exact")[1] > LOWEST_UPPER_ARM
    if below:
        yield (
            f"{side} upper arm hangs below Baxter's reach (s1 above {LOWEST_UPPER_ARM} rad) "
            f"in {below} of {len(arms)} frames: the robot's stays at that limit"
        )


def _forearm_problems(recording: SkeletonRecording, side: Side) -> Problems:
    elbow, wrist = Joint.of("elbow", side), Joint.of("wrist", side)
    near = [each.positions for each in recording if np.abs(each.positions).max() <= FARTHEST]
    if not near:
        return
    lengths = np.linalg.norm([points[wrist] - points[elbow] for points in near], axis=1)
    low, high = np.percentile(lengths, [5, 95]).tolist()
    if high > LENGTH_TOLERANCE * low:
        yield (
            f"{side} forearm measures {low:.2f} to {high:.2f} m (5th to 95th percentile): "
            "the sensor is unsure of elbow or wrist"
        )


def _by_frame(recording: SkeletonRecording, marks: Mask | list[bool]) -> Mask:
    """Return marks of skeletons (n,) as marks of the file's frames (F,)."""
    frames = np.zeros(recording.frames, dtype=bool)
    frames[recording.frame_indices] = marks
    return frames


def _first_few(words: list[str]) -> str:
    more = f" and {len(words) - 3} more" if len(words) > 3 else ""
    return ", ".join(words[:3]) + more


def _places(mask: Mask) -> str:
    """Return how many frames are marked and where: ``12 of 371 frames (40-51)``."""
    runs = runs_of(mask)
    first, last = max(runs, key=_length)
    if last == first:
        place = f"{first}" if len(runs) == 1 else f"the first is {runs[0][0]}"
    else:
        place = f"{first}-{last}" if len(runs) == 1 else f"{len(runs)} runs, {first}-{last} longest"
    return f"{mask.sum()} of {len(mask)} frames ({place})"


def _length(run: tuple[int, int]) -> int:
    return run[1] - run[0]
