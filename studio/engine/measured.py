"""What each motion that is compared comes to, against the mean demonstration as it was sent."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from studio.engine.arms import sides_of
from studio.engine.demonstration import SAMPLES, DemonstrationSet
from studio.engine.export.material import Take
from studio.engine.measures import (
    Deviation,
    acceleration_alone,
    body_as_meant,
    deviation,
    deviation_between,
    hand_acceleration,
    hand_path,
)
from studio.engine.moment import recording_at
from studio.engine.performance import Performance, in_guards_words
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.skeleton import FloatArray, Side
from studio.engine.task_words import BLOCK, TaskWords, task_words


@dataclass(frozen=True, eq=False)
class Measured:
    """One column of the table that compares."""

    name: str
    letter: str  # the robot's, A or B; empty for a demonstration
    deviation: Deviation  # of what was measured from what was taught on the average
    acceleration: float  # [m/s²] root mean square of the hand's
    block_down: bool
    guarded: str = ""  # what kept a robot from doing what was asked, in words
    done: bool = False  # the scene's task; of the paper's: block_down
    missing: str = ""  # for that, in words
    task: TaskWords = BLOCK  # how one says that


def measure_performance(
    name: str, letter: str, alone: Performance, taught: DemonstrationSet
) -> Measured:
    """Return what a whole performance of a robot comes to."""
    return Measured(
        name,
        letter,
        deviation(alone, taught.mean, taught.joints, taught.hands),
        acceleration_alone(alone),
        alone.block_down,
        in_guards_words(alone),
        alone.done,
        alone.missing,
        task_words(taught.scene),
    )


def measure_demonstration(take: Take, taught: DemonstrationSet) -> Measured:
    """Return what the robot made of a demonstration while it followed the person."""
    shown = take.demonstration
    joints = followed(take, round(shown.duration * CONTROL_RATE) + 1)
    rows = followed(take, SAMPLES)
    meant = body_as_meant(taught.mean, taught.joints, taught.arms, taught.duration, taught.hands)
    last = take.recording.samples[-1].world
    return Measured(
        shown.name,
        "",
        deviation_between(rows, meant, taught.joints, shown.arms),
        hand_acceleration(joints, shown.arms),
        last.block_down,
        done=last.done,
        missing=last.missing,
        task=task_words(shown.scene),
    )


def followed(take: Take, count: int, until: float | None = None) -> FloatArray:
    """Return all joints (count, 15) [rad] as measured, evenly over a demonstration.

    Or over what was recorded from its beginning ``until`` [s].
    """
    shown, begun = take.demonstration, take.demonstration.first_sample * CONTROL_PERIOD
    times = begun + np.linspace(0.0, shown.duration if until is None else until, count)
    return np.stack([recording_at(take.recording, time).joints for time in times.tolist()])


def hand_paths(taught: DemonstrationSet, side: Side) -> FloatArray:
    """Return a hand's path (K, 142, 3) [m] in each demonstration as sent, in the base's frame.

    Joints that were not learned are where they are in a reproduction: at zero, or if they are
    wrists where the demonstration's own hands had them.
    """
    bodies = [
        body_as_meant(rows, taught.joints, taught.arms, shown.duration, shown.hands)
        for rows, shown in zip(taught.rows, taught.demonstrations, strict=True)
    ]
    return np.stack([hand_path(body, side) for body in bodies])


def envelope(paths: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the middle (T, 3) of paths (K, T, 3), and how far from it (T,) the farthest passes.

    However late it passes: how far apart they are in time is for the plots to show.
    """
    middle: FloatArray = paths.mean(axis=0)
    passing = [cdist(middle, path).min(axis=1) for path in paths]
    return middle, np.max(passing, axis=0)


def hands_followed(take: Take, until: float, count: int) -> dict[Side, FloatArray]:
    """Return each taught hand's path (count, 3) [m] while the robot followed, as measured."""
    joints = followed(take, count, until)
    return {side: hand_path(joints, side) for side in sides_of(take.demonstration.arms)}


def hands_alone(alone: Performance, until: float, count: int) -> dict[Side, FloatArray]:
    """Return each taught hand's path (count, 3) [m] as measured, from 0 to ``until`` [s]."""
    joints = alone.measured_at(np.linspace(0.0, until, count))
    return {side: hand_path(joints, side) for side in sides_of(alone.arms)}
