"""What one arm's stages make of a recording, tick by tick, beside what was seen: for measuring.

Nothing here drives a robot: the gate is open, and the limiter runs alone over what is wanted.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy  # its signal is loaded when first used: half of what a command waits for otherwise
from numpy.typing import NDArray

from studio.engine.arm import ArmStages
from studio.engine.calibration import Calibration
from studio.engine.follow import newest_frames
from studio.engine.human import Held
from studio.engine.limits import Limits
from studio.engine.pipeline import Pipeline
from studio.engine.problems import runs_of
from studio.engine.retarget import Angles, Mapping, solve_arm
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE, load_robot
from studio.engine.skeleton import FloatArray, Side, Skeleton
from studio.engine.sources.recording import SkeletonRecording
from studio.engine.vectors import Vector

Mask = NDArray[np.bool_]
Solve = Callable[[Vector, Vector], Angles]

LONGEST_STEP = 0.1  # [s] between two frames that are still joined; beyond it nothing is known
ZERO_PHASE_CUTOFF = 3.0  # [Hz] of the reference, which has no lag
_ORDER = 2
_SHORTEST_RUN = 30  # ticks that the reference needs to settle from both ends


@dataclass(frozen=True, eq=False)
class Directions:
    """Upper arm and forearm at T ticks, as the robot's should point: unit vectors, or NaN."""

    upper_arm: FloatArray  # (T, 3)
    forearm: FloatArray  # (T, 3)

    @property
    def known(self) -> Mask:
        """At which ticks (T,) both are known."""
        return finite_rows(self.upper_arm)


@dataclass(frozen=True, eq=False)
class ArmTrace:
    """One arm over T ticks. Angles are s0, s1, e0, e1 [rad], NaN where they are unknown."""

    side: Side  # the robot's
    mapping: Mapping
    limits: Limits
    raw: Directions  # as seen, interpolated between frames
    smooth: Directions  # the same under a zero-phase filter: what a filter without lag would give
    free: FloatArray  # (T, 4) of raw, before any limit
    clamped: FloatArray  # (T, 4) the same inside the position limits, and nothing else done
    wanted: FloatArray  # (T, 4) the stages' target, before the velocity limit
    sent: FloatArray  # (T, 4) what the velocity limit makes of it
    sent_unfiltered: FloatArray  # (T, 4) what it makes of `clamped`


def trace_arm(
    recording: SkeletonRecording,
    side: Side,
    mapping: Mapping = "exact",
    mirrored: bool = False,
    calibration: Calibration | None = None,
) -> ArmTrace:
    """Let the stages of one of the robot's arms see a whole recording.

    Raises
    ------
    FileError
        Where its stamps span too long a time to be followed.
    """
    pipeline = Pipeline.for_robot(load_robot(), side, mapping, "open", mirrored, calibration)
    frames = list(newest_frames(recording))
    raw = _raw(frames, recording, pipeline.stages[0])
    free = solved(raw, lambda u, f: solve_arm(u, f, side, mapping))
    clamped = np.clip(free, pipeline.limits.lower, pipeline.limits.upper)
    wanted = _wanted(frames, pipeline)
    return ArmTrace(
        side=side,
        mapping=mapping,
        limits=pipeline.limits,
        raw=raw,
        smooth=Directions(_zero_phase(raw.upper_arm), _zero_phase(raw.forearm)),
        free=free,
        clamped=clamped,
        wanted=wanted,
        sent=_limited(pipeline.limits, wanted),
        sent_unfiltered=_limited(pipeline.limits, clamped),
    )


def finite_rows(values: FloatArray) -> Mask:
    """Return which rows (T,) of values (T, n) hold neither NaN nor infinity."""
    return np.asarray(np.isfinite(values).all(axis=1), dtype=bool)


def solved(directions: Directions, solve: Solve) -> FloatArray:
    """Return the angles (T, 4) [rad] that ``solve`` finds for each tick's directions."""
    angles = np.full((len(directions.upper_arm), 4), np.nan)
    for i in np.flatnonzero(directions.known):
        angles[i] = solve(_vector(directions.upper_arm[i]), _vector(directions.forearm[i]))
    return angles


def _wanted(frames: list[Skeleton | None], pipeline: Pipeline) -> FloatArray:
    """Return what the only arm of a pipeline wants (T, 4); nothing is sent, which costs most."""
    wanted, memory = np.full((len(frames), 4), np.nan), pipeline.start()
    for tick, skeleton in enumerate(frames):
        memory, gate = pipeline.observe(memory, skeleton, tick * CONTROL_PERIOD)
        (arm,) = memory.arms
        if gate.armed and arm.wanted is not None:
            wanted[tick] = arm.wanted
    return wanted


def _raw(
    frames: list[Skeleton | None], recording: SkeletonRecording, stages: ArmStages
) -> Directions:
    """Return the directions at every tick, interpolated between frames that show something new."""
    stamps: list[float] = []
    upper_arms, forearms = [], []
    for skeleton in _new_pictures(frames):
        bones = stages.bones(skeleton)
        if not isinstance(bones, Held):
            stamps.append(skeleton.time - float(recording.frame_times[0]))
            upper_arms.append(bones[0])
            forearms.append(bones[1])
    ticks = np.array([CONTROL_PERIOD * tick for tick in range(len(frames))])
    at = np.array(stamps)
    return Directions(_interpolated(ticks, at, upper_arms), _interpolated(ticks, at, forearms))


def _new_pictures(frames: list[Skeleton | None]) -> Iterator[Skeleton]:
    before: Skeleton | None = None
    for skeleton in frames:
        if skeleton is None or (before and np.array_equal(before.positions, skeleton.positions)):
            continue
        before = skeleton
        yield skeleton


def _interpolated(ticks: FloatArray, stamps: FloatArray, directions: list[Vector]) -> FloatArray:
    """Return unit vectors (T, 3) between the stamped ones (n), NaN across gaps."""
    if len(stamps) < 2:
        return np.full((len(ticks), 3), np.nan)
    columns = np.array(directions).T
    between = np.column_stack([np.interp(ticks, stamps, column) for column in columns])
    after = np.clip(np.searchsorted(stamps, ticks), 1, len(stamps) - 1)
    joined = stamps[after] - stamps[after - 1] <= LONGEST_STEP
    inside = (ticks >= stamps[0]) & (ticks <= stamps[-1])
    return np.where((joined & inside)[:, None], _normalized(between), np.nan)


def _zero_phase(directions: FloatArray) -> FloatArray:
    """Return unit vectors (T, 3) filtered forward and backward, NaN in runs that are too short."""
    b, a = scipy.signal.butter(_ORDER, ZERO_PHASE_CUTOFF, fs=CONTROL_RATE)
    smooth = np.full(directions.shape, np.nan)
    for first, last in runs_of(finite_rows(directions)):
        if last - first + 1 >= _SHORTEST_RUN:
            filtered = scipy.signal.filtfilt(b, a, directions[first : last + 1].T).T
            smooth[first : last + 1] = _normalized(filtered)
    return smooth


def _limited(limits: Limits, wanted: FloatArray) -> FloatArray:
    """Return what the limiter makes of a target alone, starting on it; it waits where it is NaN."""
    sent, now = np.full(wanted.shape, np.nan), None
    for tick, target in enumerate(wanted):
        if np.isfinite(target).all():
            now = target if now is None else limits.step(now, target, CONTROL_PERIOD).sent
        if now is not None:
            sent[tick] = now
    return sent


def _normalized(vectors: FloatArray) -> FloatArray:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: FloatArray = np.divide(vectors, lengths, out=np.full(vectors.shape, np.nan),
                                 where=lengths > 1e-12)  # fmt: skip
    return unit


def _vector(values: FloatArray) -> Vector:
    x, y, z = values.tolist()
    return (x, y, z)
