"""Motions of Baxter's arm that push the block down, and what is needed to play them."""

import hashlib
from dataclasses import replace

import numpy as np

from studio.engine.scene import Block, Desk, Scene
from studio.engine.skeleton import FloatArray, Side
from studio.engine.world import World, WorldState

DRIVEN = ("s0", "s1", "e0", "e1")
SETTLE = 45  # ticks after a motion

# Ways to push the block down: stamps [s] and s0, s1, e0, e1 [rad] of the left arm. The first bends
# the elbow; the other two turn the shoulder alone, as the exact and the paper's mapping have it.
BEND = (
    (0.0, 1.0, 2.8, 3.2, 5.4, 5.9),
    (
        (0.234, 0.999, -2.212, 1.177),
        (0.270, 0.964, -1.966, 1.036),
        (0.140, 0.787, -1.201, 1.611),
        (0.140, 0.787, -1.201, 1.611),
        (0.234, 0.999, -2.212, 1.177),
        (0.234, 0.999, -2.212, 1.177),
    ),
)


def sweep(start: tuple[float, ...], s0: float) -> tuple[tuple[float, ...], tuple[object, ...]]:
    there = (s0, *start[1:])
    return (0.0, 0.6, 2.8, 3.2, 5.4, 5.8), (start, start, there, there, start, start)


MOTIONS = {
    "bend": BEND,
    "sweep exact": sweep((0.081, -0.521, -0.419, 1.391), -1.054),
    "sweep paper": sweep((0.0, -0.349, 0.0, 1.231), -1.134),
}
# A scene in which nothing is in the way.
EMPTY = Scene(
    desk=Desk((0.1, 0.1, 0.1), (9.0, 9.0, 0.05), 0.5),
    blocks=(Block((0.1, 0.1, 0.1), (7.0, 7.0, 0.05), 0.4, 0.5),),
)


def rows(name: str, side: Side = "left") -> FloatArray:
    """Return a motion (T, 4) [rad] at 30 Hz: minimum-jerk pieces from stamp to stamp."""
    stamps, angles = (np.array(part) for part in MOTIONS[name])
    times = np.arange(round(stamps[-1] * 30) + 1) / 30
    piece = np.clip(np.searchsorted(stamps, times, side="right") - 1, 0, len(stamps) - 2)
    share = ((times - stamps[piece]) / np.diff(stamps)[piece])[:, None]
    smooth = share**3 * (10 - 15 * share + 6 * share**2)
    motion = angles[piece] + (angles[piece + 1] - angles[piece]) * smooth
    return motion if side == "left" else motion * [-1, 1, -1, 1]


def command(row: FloatArray, side: Side = "left") -> dict[str, float]:
    return dict(zip((f"{side}_{joint}" for joint in DRIVEN), row.tolist(), strict=True))


def play(scene: Scene, motion: FloatArray, side: Side = "left") -> list[WorldState]:
    """Return the states after each command, and after a time to settle."""
    with World(scene, command(motion[0], side)) as world:
        states = []
        for row in motion:
            world.apply(command(row, side))
            states.append(world.step())
        return states + [world.step() for _ in range(SETTLE)]


def moved(scene: Scene, x: float, y: float) -> Scene:
    block = scene.blocks[0]
    at = (block.position[0] + x, block.position[1] + y, block.position[2])
    return replace(scene, blocks=(replace(block, position=at), *scene.blocks[1:]))


def fingerprint(states: list[WorldState]) -> str:
    numbers = [
        np.concatenate([s.joint_positions, s.joint_velocities, s.block_poses.ravel()])
        for s in states
    ]
    return hashlib.sha256(np.array(numbers).tobytes()).hexdigest()
