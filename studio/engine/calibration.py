"""Calibration: arms that hang relaxed are a plumb line, and tell how far the torso seems to lean.

The neutral pose is standing upright with both arms hanging relaxed at the sides, for two seconds:
everybody can do it, and sensors see it well. A Kinect's spine line leans with the person's build,
clothes and the sensor's tilt, and every direction with it. What is fitted is one rotation of the
torso's frame, the smallest that turns the mean of the hanging arms' directions straight down,
where Baxter's arms hang too. It says nothing of a turn about the vertical: there the line of the
shoulders is trusted.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from studio.engine.errors import FileError, StudioError
from studio.engine.human import Held, arm_vectors
from studio.engine.skeleton import SIDES, FloatArray, Skeleton
from studio.engine.sources.recording import SkeletonRecording
from studio.engine.vectors import Vector, angle_between, cross, dot, unit

SECONDS = 2.0  # of the neutral pose
ENOUGH = 1.0  # [s] of them with both arms seen
LONGEST_SIGHT = 0.25  # [s] for which one frame counts; sensors send five a second at least
STILL = math.radians(6)  # from the median, for nine frames in ten: the person kept still
HANGING = math.radians(35)  # from straight down: more is not a hanging arm
LARGEST_LEAN = math.radians(25)  # that is corrected

_ROUNDING = 1e-6  # [s] of times that were added up
_DOWN: Vector = (0.0, 0.0, -1.0)


@dataclass(frozen=True)
class Calibration:
    """Which way is down, in the torso's frame of this person before this sensor."""

    down: Vector  # unit vector

    def __post_init__(self) -> None:
        direction = unit(self.down)
        if direction is None or not angle_between(direction, _DOWN) <= LARGEST_LEAN:
            raise StudioError(
                f"a calibration's down is a direction within {math.degrees(LARGEST_LEAN):.0f}° of "
                f"straight down, not {self.down!r}: take it anew"
            )
        object.__setattr__(self, "down", direction)

    @property
    def lean(self) -> float:
        """By how much the torso seemed to lean [rad]."""
        return angle_between(self.down, _DOWN)

    def correct(self, direction: Vector) -> Vector:
        """Return a direction in the torso's frame as it is once the lean is taken away."""
        rows = self._rotation
        return (dot(rows[0], direction), dot(rows[1], direction), dot(rows[2], direction))

    @cached_property
    def _rotation(self) -> tuple[Vector, Vector, Vector]:
        """Return the rows of the smallest rotation from `down` to straight down (Rodrigues)."""
        x, y, z = cross(self.down, _DOWN)
        share = 1.0 / (1.0 + dot(self.down, _DOWN))
        return (
            (1.0 - share * (y * y + z * z), share * x * y - z, share * x * z + y),
            (share * x * y + z, 1.0 - share * (x * x + z * z), share * y * z - x),
            (share * x * z - y, share * y * z + x, 1.0 - share * (x * x + y * y)),
        )


def in_words(calibration: Calibration) -> str:
    """Return what a calibration found, and what is done about it."""
    return f"torso leans {math.degrees(calibration.lean):.0f}°: corrected"


def calibrate(skeletons: Sequence[Skeleton]) -> Calibration:
    """Return the calibration that two seconds of the neutral pose give.

    Raises
    ------
    StudioError
        Where the arms are seen for too short a time, the person moved, or the arms do not hang;
        the message says what to do.
    """
    poses = [_directions(skeleton) for skeleton in skeletons]
    seen = _seconds_seen(skeletons, poses)
    if seen < ENOUGH - _ROUNDING:
        raise StudioError(
            f"calibration: both arms were seen for {seen:.1f} s, in {sum(map(bool, poses))} of "
            f"{len(skeletons)} frames, and {ENOUGH:g} s are needed: stand in full view of a sensor "
            f"that sends 5 frames a second or more, arms hanging, for {SECONDS:g} seconds"
        )
    measured = np.array([pose for pose in poses if pose])  # (n, 4, 3)
    median = _normalized(np.median(measured, axis=0))
    moved = float(np.percentile(_angles(measured, median).max(axis=1), 90))
    if not moved <= STILL:  # nor is NaN
        raise StudioError(
            f"calibration: you moved, by {math.degrees(moved):.0f}°: keep still for {SECONDS:g} "
            f"seconds, arms hanging (up to {math.degrees(STILL):.0f}° is well)"
        )
    furthest = float(_angles(median[None], np.array(_DOWN)).max())
    if not furthest <= HANGING:
        raise StudioError(
            f"calibration: an arm pointed {math.degrees(furthest):.0f}° away from straight down: "
            "let both arms hang relaxed at your sides"
        )
    x, y, z = _normalized(median.mean(axis=0)).tolist()
    return Calibration((x, y, z))


def calibrate_at(skeletons: Sequence[Skeleton], start: float) -> Calibration:
    """Return the calibration from the two seconds that begin at ``start`` [s] into a recording.

    Raises
    ------
    StudioError
        As `calibrate`, and where ``start`` is not a time of 0 s or more.
    """
    if not 0.0 <= start < math.inf:
        raise StudioError(f"a calibration begins 0 s or more into the file, not at {start!r} s")
    if not skeletons:
        raise StudioError("calibration: nobody is seen")
    first = skeletons[0].time + start
    return calibrate([each for each in skeletons if first <= each.time <= first + SECONDS])


def calibrate_file(stream: SkeletonRecording, start: float) -> Calibration:
    """Return the same from a stream; its errors name the file and the place.

    Raises
    ------
    FileError
        As `calibrate_at`.
    """
    try:
        return calibrate_at(stream, start)
    except StudioError as error:
        raise FileError(f"{stream.path}, {start:g} s into it: {error}") from error


def _seconds_seen(skeletons: Sequence[Skeleton], poses: Sequence[list[Vector]]) -> float:
    """Return for how long [s] both arms were seen: a frame counts until the next one."""
    intervals = np.diff([skeleton.time for skeleton in skeletons])
    counted = np.clip(intervals, 0.0, LONGEST_SIGHT)
    return float(sum(counted[[bool(pose) for pose in poses[: len(counted)]]]))


def _directions(skeleton: Skeleton) -> list[Vector]:
    """Return both upper arms and forearms (4) in the torso's frame, or nothing."""
    arms = [arm_vectors(skeleton, side) for side in SIDES]
    seen = [arm for arm in arms if not isinstance(arm, Held)]
    bones = [(arm.torso, bone) for arm in seen for bone in (arm.upper_arm, arm.forearm)]
    return [torso.from_camera(bone) for torso, bone in bones] if len(seen) == len(arms) else []


def _normalized(vectors: FloatArray) -> FloatArray:
    normalized: FloatArray = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return normalized


def _angles(vectors: FloatArray, others: FloatArray) -> FloatArray:
    """Return the angles [rad] between unit vectors (..., 3), broadcast."""
    angles: FloatArray = np.arccos(np.clip(np.sum(vectors * others, axis=-1), -1.0, 1.0))
    return angles
