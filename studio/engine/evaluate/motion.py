"""What is done in trials: a motion, sampled at the control ticks, and what is sent for it.

Limits and guard look at what is sent and not at the world, so what they make of a motion is the
same in every trial. It is planned once, here; that is also why it does not matter which machine
does a trial: no learner is asked there.
"""

from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np

from studio.engine.arms import Arms
from studio.engine.demonstration import Demonstration
from studio.engine.hands import PLAIN, HandOptions, HandTrack
from studio.engine.performance import rows_as_trajectory
from studio.engine.pipeline import Pipeline
from studio.engine.planning import SETTLE, Planner, Trajectory
from studio.engine.retarget import Mapping
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray


@dataclass(frozen=True, eq=False)
class Motion:
    """A motion, by its name; plain data, so that any process can do it."""

    name: str
    arms: Arms
    mapping: Mapping
    duration: float  # [s] of the motion itself
    wanted: FloatArray  # (T, L) [rad] of the learned joints at each tick, the settling included
    hands: HandTrack | None = None
    sent: FloatArray = field(default_factory=lambda: np.empty((0, 0)))  # (T, D + W) [rad] of
    # driven joints and wrists, for a robot that begins where the motion does
    guarded: int = 0  # ticks of those that the collision guard changed

    @property
    def options(self) -> HandOptions:
        """What the hands are to do."""
        return PLAIN if self.hands is None else self.hands.options

    def trajectory(self, time: float) -> FloatArray:
        """Return what is wanted (L,) [rad] at ``time`` [s], which is a tick's, or the end."""
        tick = -1 if time >= self.duration else round(time * CONTROL_RATE)
        row: FloatArray = self.wanted[tick]
        return row


def motion_of(
    name: str,
    trajectory: Trajectory,
    duration: float,
    arms: Arms,
    mapping: Mapping,
    hands: HandTrack | None,
    scene: Scene,
) -> Motion:
    """Return a trajectory as what is done in trials of a scene."""
    ticks = round((duration + SETTLE) * CONTROL_RATE)
    wanted = np.stack([trajectory(min(k * CONTROL_PERIOD, duration)) for k in range(ticks)])
    motion = Motion(name, arms, mapping, duration, wanted, hands)
    planner = planner_of(motion, scene)
    begin = planner.begin(motion.trajectory, planner.ready)
    steps = list(planner.motion(motion.trajectory, duration, begin))
    sent = np.stack([planner.all_sent(step) for step in steps])
    return replace(motion, sent=sent, guarded=sum(1 for step in steps if step.command.guarded))


def replay_of(name: str, demonstration: Demonstration, rows: FloatArray, scene: Scene) -> Motion:
    """Return a demonstration's own replay, by its resampled ``rows`` (142, L) [rad]."""
    return motion_of(
        name,
        rows_as_trajectory(rows, demonstration.duration),
        demonstration.duration,
        demonstration.arms,
        demonstration.mapping,
        demonstration.hands,
        scene,
    )


def planner_of(motion: Motion, scene: Scene) -> Planner:
    """Return who plans a motion; limits and guard are made once in each process."""
    pipeline = _pipeline(motion.arms, motion.mapping, motion.options, scene)
    return Planner(motion.arms, motion.mapping, motion.hands, pipeline)


@cache
def _pipeline(arms: Arms, mapping: Mapping, options: HandOptions, scene: Scene) -> Pipeline:
    return Pipeline.for_robot(load_robot(), arms, mapping, hands=options, scene=scene)
