"""The demonstrator: a synthetic person who does a scene's task, for whoever has no Kinect.

The person signs Lasso, Open, Closed with the left hand, does the task with the left arm (or both)
so that Baxter does it, comes back, and signs Lasso to end. The paper's task is one sweep inward;
in other scenes the strokes follow from where blocks and zones are. Every take differs a little in
timing, height and speed, as in the paper's Fig. 9, and a sensor's faults are laid over it
(`studio.engine.sources.sensor_faults`). What comes out are skeletons like any others.
"""

from collections.abc import Sequence

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.scene import Scene
from studio.engine.skeleton import FRAME_RATE, HandState
from studio.engine.sources.demonstrator_body import DemonstratorBody, in_camera
from studio.engine.sources.recording import SkeletonRecording, from_skeletons
from studio.engine.sources.script import poses_at, script_of, varied
from studio.engine.sources.sensor_faults import sense

FULL_SEQUENCE = (HandState.LASSO, HandState.OPEN, HandState.CLOSED)


def demonstrate(
    seed: int,
    take: int = 1,
    signs: Sequence[HandState] = FULL_SEQUENCE,
    scene: Scene | None = None,
) -> SkeletonRecording:
    """Return one performance as a sensor would see it: thirteen seconds of skeletons, or more.

    Parameters
    ----------
    seed : int
        The person and the day; the same seed, take and scene give the same bytes.
    take : int
        Which performance, counted from 1.
    signs : sequence of HandState
        What the left hand signs before the arm moves; anything but Lasso, Open, Closed never arms.
    scene : Scene, optional
        What is to be done: the paper's task unless given.

    Raises
    ------
    StudioError
        Where seed or take is below zero, or the demonstrator does not know how to do the scene's
        task, or its blocks and zones are out of Baxter's reach.
    """
    if seed < 0 or take < 0:
        raise StudioError(f"the demonstrator's seed and take are 0 or more, not {seed} and {take}")
    rng = np.random.default_rng([seed, take])
    scene = Scene() if scene is None else scene
    steps = varied(script_of(scene, signs), rng)
    times = np.arange(0.0, sum(step.seconds for step in steps), 1.0 / FRAME_RATE)
    positions = in_camera(DemonstratorBody.of(rng), *poses_at(steps, times), rng)
    ends = np.cumsum([step.seconds for step in steps])
    shown = [steps[min(int(np.searchsorted(ends, t)), len(steps) - 1)] for t in times]
    grips = [step.grip for step in shown] if scene.gripper else None
    return from_skeletons(
        sense(positions, [step.sign for step in shown], rng, grips),
        path=f"demonstrator:{take}",
        format=f"demonstrator, seed {seed}",
    )
