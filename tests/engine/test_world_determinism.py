"""Same seed, same trajectory, bit for bit: in one process after another, whatever went before."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
# Each prints the bytes of all that a taught motion led to: what was sent, and the world's states.
ALONE = """
import sys
import numpy as np
from studio.engine.follow import follow
from studio.engine.pipeline import Pipeline
from studio.engine.robot import load_robot
from studio.engine.sources.demonstrator import demonstrate

def taught(seed):
    recording = follow(demonstrate(seed, 1), Pipeline.for_robot(load_robot(), "left"))
    for sample in recording.samples:
        world = sample.world
        yield sample.sent
        yield world.joint_positions
        yield world.joint_velocities
        yield world.block_poses.ravel()
        yield np.array([world.time, world.tilt, world.touched, world.block_down])

def tell(seed):
    sys.stdout.buffer.write(np.concatenate(list(taught(seed))).tobytes())
"""
AMONG_OTHERS = """
from studio.engine.scene import Scene
from studio.engine.world import World

for arms in ("right", "both"):
    with World(Scene(arms=arms), {"left_e1": 1.0}, fingers=arms == "both") as before:
        before.apply({"left_s0": 0.5})
        for _ in range(20):
            before.step()
list(taught(4))
beside = World(Scene())
beside.apply({"left_s0": -0.5})
whole = World.step
def step(world):
    if world is not beside:
        beside.step()
    return whole(world)
World.step = step
"""


def told(script: str, hash_seed: str) -> bytes:
    done = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        check=True,
        cwd=ROOT,
        env={**os.environ, "PYTHONHASHSEED": hash_seed},
    )
    return done.stdout


def test_same_seed_same_bits_in_one_process_after_another() -> None:
    first = told(f"{ALONE}tell(3)", "1")
    second = told(f"{ALONE}{AMONG_OTHERS}tell(3)", "2")
    numbers = np.frombuffer(first)
    assert len(numbers) > 200 * 50
    assert np.isfinite(numbers).all()
    assert numbers[-1] == 1.0  # the block is down
    assert second == first
