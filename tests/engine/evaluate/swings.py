"""A motion of half a second: the left arm swings, and hits a block in its way or misses it."""

from dataclasses import replace
from functools import cache

import numpy as np

from studio.engine.evaluate.motion import Motion, motion_of
from studio.engine.evaluate.runs import Conditions
from studio.engine.evaluate.variation import Variations
from studio.engine.performance import rows_as_trajectory
from studio.engine.pipeline import ready_pose
from studio.engine.scene import Scene

SECONDS = 0.5
WIDTHS = Variations(block=0.06)  # [m]: so wide that the swing hits half of the blocks


@cache
def scene() -> Scene:
    """Return the usual scene, its block in the way of the swing."""
    usual = Scene()
    return replace(usual, blocks=(replace(usual.blocks[0], position=(0.72, 0.30, 0.87)),))


@cache
def swing(name: str = "swing", reach: float = -0.6) -> Motion:
    """Return a swing of the shoulder by ``reach`` [rad]."""
    ready = ready_pose("left", "exact")
    rows = np.array([ready, ready + np.array([reach, 0.0, 0.0, 0.0])])
    trajectory = rows_as_trajectory(rows, SECONDS)
    return motion_of(name, trajectory, SECONDS, "left", "exact", None, scene())


def conditions(seed: int = 0) -> Conditions:
    return Conditions(scene(), WIDTHS, seed)
