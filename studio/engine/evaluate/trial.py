"""One trial: a motion done once, in a fresh world that differs a little from the usual one."""

import math
import re
from dataclasses import dataclass, replace

import numpy as np

from studio.engine.arms import driven_joints
from studio.engine.evaluate.motion import Motion, planner_of
from studio.engine.evaluate.variation import Variation
from studio.engine.hands import STILL, HandCommand
from studio.engine.performance import send, start_world
from studio.engine.planning import Planner, UnreachableError
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.engine.world import WorldState

REFUSED = "the guard did not let Baxter come to where the motion begins"


@dataclass(frozen=True)
class Outcome:
    """What became of a trial."""

    done: bool  # the scene's task, in the end
    why: str  # not, in words that are the same for the same kind of failure; else nothing


def run_trial(motion: Motion, scene: Scene, variation: Variation) -> Outcome:
    """Do a motion in the trial's own world.

    It ends with the settling, or as soon as the motion is over and the task is done: the arm rests
    from then on, and so do the blocks that the task is about.
    """
    planner, driven = planner_of(motion, scene), len(driven_joints(motion.arms))
    limits = planner.pipeline.limits
    start = planner.ready
    start[:driven] += variation.start
    start = np.clip(start, limits.lower, limits.upper)
    try:
        way, sent = _planned(motion, planner, start)
    except UnreachableError:
        return Outcome(False, REFUSED)
    arrived = variation.arrived(len(sent))
    targets = sent[:, :driven][np.maximum(arrived, 0)] + variation.offsets(len(sent))
    targets = np.clip(targets, limits.lower[:driven], limits.upper[:driven])
    over = way + _ticks_of(motion) + variation.latency
    placed, pose = variation.scene(scene), start[:driven]
    with start_world(motion.arms, motion.mapping, motion.options, placed, pose) as world:
        state = world.state
        for tick, newest in enumerate(arrived.tolist()):
            if newest >= 0:
                hands = _hands(motion, newest - way, sent[newest, driven:])
                send(world, motion.arms, targets[tick], motion.options, hands)
            state = world.step()
            if tick >= over and state.done:
                break
    return Outcome(state.done, "" if state.done else why_not(state))


def why_not(state: WorldState) -> str:
    """Return why a task is not done in the end, without the numbers that differ each time."""
    return re.sub(r"\b\d+(\.\d+)? cm outside", "outside", state.missing)


def _ticks_of(motion: Motion) -> int:
    """Return how many ticks a motion takes, without the settling."""
    return math.ceil(motion.duration * CONTROL_RATE)


def _planned(motion: Motion, planner: Planner, start: FloatArray) -> tuple[int, FloatArray]:
    """Return how many ticks the way takes, and what is sent (T, D + W) [rad] on it and after it.

    Where the way ends exactly at the motion's begin, that has been planned already.
    """
    begin = planner.begin(motion.trajectory, start)
    way = [planner.all_sent(step) for step in planner.way(start, begin)]
    arrived = way[-1] if way else start
    if np.array_equal(arrived, begin):
        sent = motion.sent
    else:
        steps = planner.motion(motion.trajectory, motion.duration, arrived)
        sent = np.stack([planner.all_sent(step) for step in steps])
    return len(way), np.vstack([*way, sent])


def _hands(motion: Motion, tick: int, wrist: FloatArray) -> HandCommand:
    """Return what the hands are told in a tick of the motion, or before it."""
    if motion.hands is None:
        return STILL
    told = motion.hands.at(max(tick, 0) * CONTROL_PERIOD)
    return replace(told, wrist=tuple(wrist.tolist()))
