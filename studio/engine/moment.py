"""What there was at any time of something that is over: to be shown at a playhead, not simulated.

Joints and fingers are interpolated linearly between ticks, and so are blocks, which turn on the
great circle's chord: within a tick no block turns far enough to tell that from the arc.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from studio.engine.arms import resting_body
from studio.engine.demonstration import Demonstration
from studio.engine.performance import Performance, joint_columns
from studio.engine.recording import Recording, Sample
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.skeleton import FloatArray, Skeleton
from studio.engine.world import WorldState


@dataclass(frozen=True, eq=False)
class Moment:
    """The robot and its blocks at one time, and the tick that began last."""

    joints: FloatArray  # (15,) [rad], in the order of robot.JOINT_NAMES
    index: int  # of that tick: in a performance's ticks, in a recording's samples
    block_poses: FloatArray | None = None  # (B, 7) x y z [m], qx qy qz qw; None: not known
    fingers: FloatArray | None = None  # [m] as in WorldState


def performance_at(performance: Performance, time: float) -> Moment:
    """Return a performance at ``time`` [s] since its motion began; before and after it stands.

    Tick k's command is given at k control periods and what comes of it measured one period later.
    In the first period the blocks stand where its end finds them: nothing has touched them yet.
    """
    ticks = performance.ticks
    place, share = _place(time, len(ticks))
    after = ticks[min(place, len(ticks) - 1)].world
    if place == 0:
        joints = _between(performance.start, after.joint_positions, share)
        return Moment(joints, 0, after.block_poses, after.fingers)
    return _blended(ticks[place - 1].world, after, share, min(place, len(ticks) - 1))


def recording_at(recording: Recording, time: float) -> Moment:
    """Return a recording at ``time`` [s] since its first tick; before and after it stands.

    Raises IndexError where it has no sample.
    """
    samples = recording.samples
    place, share = _place(time - CONTROL_PERIOD, len(samples) - 1)
    before, after = samples[place].world, samples[min(place + 1, len(samples) - 1)].world
    return _blended(before, after, share, _index(time, len(samples)))


def demonstration_at(demonstration: Demonstration, time: float) -> Moment:
    """Return what a demonstration sent at ``time`` [s] since it began, as a whole body.

    Wrists are where they were sent; other joints that it does not drive are at zero, and arms that
    were not taught hang. The index is that
    of the sample in the demonstration's recording, whose skeleton and blocks `skeleton_at` and
    `recording_at` know.
    """
    body = resting_body(demonstration.arms)
    body[joint_columns(demonstration.joints)] = demonstration.at(np.array([time]))[0]
    if demonstration.hands is not None:
        wrists = demonstration.hands.options.wrist_joints(demonstration.arms)
        body[joint_columns(wrists)] = demonstration.hands.at(time).wrist
    begun = bisect_right(demonstration.times.tolist(), time + CONTROL_PERIOD / 1e6) - 1
    return Moment(body, demonstration.first_sample + max(begun, 0))


def skeleton_at(samples: Sequence[Sample], index: int) -> Skeleton | None:
    """Return the newest skeleton that sample ``index`` or one before it saw; None before any."""
    for sample in reversed(samples[: index + 1]):
        if sample.skeleton is not None:
            return sample.skeleton
    return None


def _place(time: float, last: int) -> tuple[int, float]:
    """Return the last whole tick at ``time`` [s], from 0 to ``last``, and the share of the next."""
    ticks = min(max(time * CONTROL_RATE, 0.0), float(last))
    whole = int(ticks)
    return whole, ticks - whole


def _index(time: float, count: int) -> int:
    return min(_place(time + CONTROL_PERIOD / 1e6, count)[0], count - 1)


def _blended(before: WorldState, after: WorldState, share: float, index: int) -> Moment:
    return Moment(
        _between(before.joint_positions, after.joint_positions, share),
        index,
        _poses_between(before.block_poses, after.block_poses, share),
        _between(before.fingers, after.fingers, share),
    )


def _between(before: FloatArray, after: FloatArray, share: float) -> FloatArray:
    return before + share * (after - before)


def _poses_between(before: FloatArray, after: FloatArray, share: float) -> FloatArray:
    """Return poses (B, 7) between two; of each quaternion and its negative the nearer is taken."""
    turned = np.sum(before[:, 3:] * after[:, 3:], axis=1, keepdims=True) < 0.0
    poses = _between(
        before, np.hstack([after[:, :3], np.where(turned, -1.0, 1.0) * after[:, 3:]]), share
    )
    poses[:, 3:] /= np.linalg.norm(poses[:, 3:], axis=1, keepdims=True)
    return poses
