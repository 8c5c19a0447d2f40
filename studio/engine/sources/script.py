"""What the demonstrator does, step by step: sign, do the scene's task, come back, sign again.

And how it does so this time: some percent, degrees and centimeters off, as in the paper's Fig. 9.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from studio.engine.scene import USUAL, Scene
from studio.engine.skeleton import FloatArray, HandState
from studio.engine.sources.arm_goals import ArmPose, HandGoal, Reacher
from studio.engine.sources.strokes import strokes_of

REST = ArmPose(-50.0, 60.0, -60.0, 30.0)
READY = ArmPose(20.0, 45.0, -48.0, 15.0)
SWEPT = ArmPose(20.0, -20.0, -48.0, -50.0)
POSE_SPREAD = np.array([1.5, 2.5, 1.5, 3.0])  # [deg] of a pose's four angles, from take to take
PLACES = 12  # of a straight stroke, between which the arm's angles are interpolated
Goal = ArmPose | HandGoal


@dataclass(frozen=True)
class Step:
    """A stretch of the performance: where the arms are at its end, and what the hands show."""

    left: Goal
    seconds: float
    sign: HandState  # of the left hand, for the gate
    right: Goal | None = None  # None while that arm just hangs
    grip: HandState = HandState.OPEN  # of the right hand, for the gripper


def script_of(scene: Scene, signs: Sequence[HandState]) -> list[Step]:
    """Return how a scene's task is done.

    Raises
    ------
    StudioError
        Where the demonstrator does not know how.
    """
    last = signs[-1] if signs else HandState.OPEN
    right = scene.both_arms
    rest, ready = (REST if right else None), (READY if right else None)
    return [
        Step(REST, 0.5, HandState.OPEN, rest),
        Step(READY, 1.2, HandState.OPEN, ready),
        *(Step(READY, 1.2, sign, ready) for sign in signs),
        *_task(scene, last),
        Step(READY, 2.2, last, ready),
        Step(READY, 0.4, last, ready),
        Step(READY, 1.6, HandState.LASSO, ready),
        Step(REST, 1.2, HandState.OPEN, rest),
    ]


def _task(scene: Scene, sign: HandState) -> list[Step]:
    """Return the steps from the ready pose to where the task is done."""
    if scene.is_same_as(USUAL):
        return [Step(SWEPT, 2.2, sign), Step(SWEPT, 0.4, sign)]
    steps: list[Step] = []
    left: Goal = READY
    right: Goal | None = READY if scene.both_arms else None
    for stroke in strokes_of(scene):
        left = stroke.left or left
        right = stroke.right or right
        steps.append(Step(left, stroke.seconds, sign, right, stroke.grip))
    return steps


def varied(steps: Sequence[Step], rng: np.random.Generator) -> list[Step]:
    """Return the script as a person would do it this time."""
    pace = rng.normal(1.0, 0.04)
    left = {goal: _off(goal, rng) for goal in dict.fromkeys(step.left for step in steps)}
    right = {
        goal: _off(goal, rng)
        for goal in dict.fromkeys(step.right for step in steps)
        if goal is not None
    }
    return [
        replace(
            step,
            left=left[step.left],
            right=None if step.right is None else right[step.right],
            seconds=step.seconds * float(np.clip(rng.normal(pace, 0.04), 0.85, 1.15)),
        )
        for step in steps
    ]


def _off(goal: Goal, rng: np.random.Generator) -> Goal:
    if isinstance(goal, HandGoal):
        return goal.moved(goal.care * np.clip(rng.normal(size=3), -2.0, 2.0))
    return ArmPose(*(goal.angles + POSE_SPREAD * np.clip(rng.normal(size=4), -2.0, 2.0)).tolist())


def poses_at(steps: Sequence[Step], times: FloatArray) -> tuple[FloatArray, FloatArray | None]:
    """Return the left arm's four angles [rad] at each time (T, 4), and the right one's if it moves.

    By minimum jerk from step to step; from one place of the hand to the next along a line.

    Raises
    ------
    StudioError
        Where Baxter's hand does not reach a place.
    """
    ends = np.cumsum([step.seconds for step in steps])
    starts = np.concatenate([[0.0], ends[:-1]])
    index = np.minimum(np.searchsorted(ends, times, side="right"), len(steps) - 1)
    s = np.clip((times - starts[index]) / (ends - starts)[index], 0.0, 1.0)
    blend = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    left = _along(_paths([step.left for step in steps]), index, blend)
    right = [step.right for step in steps if step.right is not None]
    return left, _along(_paths(right), index, blend) if len(right) == len(steps) else None


def _along(paths: Sequence[FloatArray], index: FloatArray, blend: FloatArray) -> FloatArray:
    """Return the angles [rad] after a share ``blend`` (T,) of the path of number ``index`` (T,)."""
    found = []
    for number, share in zip(index.tolist(), blend.tolist(), strict=True):
        path = paths[number]
        at = share * (len(path) - 1)
        before = min(int(at), len(path) - 2)
        part = at - before
        found.append(path[before] * (1.0 - part) + path[before + 1] * part)
    return np.array(found)


def _paths(goals: Sequence[Goal]) -> list[FloatArray]:
    """Return for each goal the poses (P, 4) [rad] on the way to it from the one before."""
    reacher, paths = Reacher.usual(), []
    before: Goal | None = None
    pose = READY
    joints = reacher.joints(pose)
    for goal in goals:
        path = [pose]
        if isinstance(goal, ArmPose):
            path = [goal if before is None else pose, goal]
            joints = reacher.joints(goal)
        elif goal == before:
            path = [pose, pose]
        else:
            for place in _line(reacher.reached(joints, goal), goal):
                joints = reacher.seek(place, joints)
                path.append(reacher.pose(joints))
        paths.append(np.radians([each.angles for each in path]))
        before, pose = goal, path[-1]
    return paths


def _line(start: FloatArray, goal: HandGoal) -> list[HandGoal]:
    """Return places on the line from where the hand is, x, y, z [m] and turn [rad], to a goal."""
    way = np.array([*goal.point, math.radians(goal.turn)]) - start
    found = []
    for share in np.linspace(0.0, 1.0, PLACES + 1)[1:]:
        x, y, z, turn = (start + share * way).tolist()
        found.append(replace(goal, point=(x, y, z), turn=math.degrees(turn)))
    return found
