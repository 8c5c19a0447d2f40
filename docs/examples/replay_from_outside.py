"""Replays a trained network from outside, as the paper's MATLAB step did, target by target.

    studio serve --no-page --remote 127.0.0.1:8766     # in another terminal
    python docs/examples/replay_from_outside.py model.json --teach

Without ``--teach`` it takes a model.json that the studio has exported. ``--synchronous`` takes the
studio's clock: the world stands still between two steps, so that it does not matter how long this
program thinks. It prints whether the block is down, and that is its exit status.
"""

import argparse
import json
import sys
import time
from contextlib import ExitStack
from itertools import takewhile
from pathlib import Path

import numpy as np

from studio.rbf import SavedModel, load_model
from studio.remote import Block, Clock, Studio, commands, connect

SAMPLES = 142  # in a motion: what the network knows as time
RATE = 30  # joint targets a second
SETTLE = 1.5  # [s] after the motion, in which the block falls or stays


def main() -> int:
    """Do what the command line says."""
    options = parsed()
    with connect(options.url, options.token) as studio, ExitStack() as stack:
        studio.take_control()
        clock = stack.enter_context(studio.clock()) if options.synchronous else None
        if options.teach:
            teach(studio, clock or studio, options.model)
        motion = rows_of(load_model(options.model), options.arm)
        studio.do(commands.PutBlockBack())  # a fresh world, the robot waits beside the block
        if clock is not None:
            down = replay_in_steps(studio, clock, motion)
        else:
            down = replay_in_real_time(studio, motion)
        for words in studio.complaints:  # such as that somebody has stopped Baxter
            print(words, file=sys.stderr)
    print(f"the block is {'down' if down else 'still standing'}")
    return 0 if down else 1


def parsed() -> argparse.Namespace:
    """Return the options."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=Path, help="a network as the studio exports it (JSON)")
    parser.add_argument("--url", default="ws://127.0.0.1:8766", help="where the studio is")
    parser.add_argument("--token", help="what the studio wants to be shown, if anything")
    parser.add_argument("--arm", default="left", choices=("left", "right"))
    parser.add_argument("--synchronous", action="store_true", help="the world waits for each step")
    parser.add_argument("--teach", action="store_true", help="teach first, and write the model")
    return parser.parse_args()


def teach(studio: Studio, time_passes: Studio | Clock, path: Path) -> None:
    """Let the built-in demonstrator teach once, let the studio learn, and write what it learned."""
    before = len(studio.snapshot().entries)
    studio.do(commands.UseDemonstrator())
    studio.do(commands.Record())
    time_passes.wait_for(lambda now: len(now.entries) > before)
    studio.do(commands.Train(commands.LearnerSettings("rbf", 50)))
    time_passes.wait_for(lambda now: now.lesson is not None and now.learning.underway is None)
    path.write_text(json.dumps(studio.lesson().model))


def rows_of(saved: SavedModel, arm: str) -> list[dict[str, float]]:
    """Return the joint targets [rad] of every tick."""
    ticks = round(saved.duration * RATE) + 1
    inputs = np.linspace(1.0, SAMPLES, ticks)  # the network counts samples, from 1
    angles = saved.estimator.predict(inputs).tolist()
    columns = ("s0", "s1", "e0", "e1") if len(angles[0]) == 4 else ("s0", "s1", "e1")
    names = [f"{arm}_{column}" for column in columns]
    still = {} if "e0" in columns else {f"{arm}_e0": 0.0}  # the paper's mapping leaves it out
    return [still | dict(zip(names, row, strict=True)) for row in angles]


def replay_in_real_time(studio: Studio, motion: list[dict[str, float]]) -> bool:
    """Send each target when it is due, and wait for no answer; watch the block meanwhile."""
    blocks = studio.stream(Block, rate=10.0)
    studio.move_to(motion[0])
    begun = time.monotonic()
    for k, targets in enumerate(motion):
        time.sleep(max(0.0, begun + k / RATE - time.monotonic()))
        studio.set_joint_target(targets)
    end = time.monotonic() + SETTLE
    return any(block.down for block in takewhile(lambda _: time.monotonic() < end, blocks))


def replay_in_steps(studio: Studio, clock: Clock, motion: list[dict[str, float]]) -> bool:
    """Send a target, let a tick pass, and so on."""
    clock.move_to(motion[0])
    for targets in motion:
        studio.set_joint_target(targets)
        clock.step()
    return clock.step(round(SETTLE * RATE)).block.down


if __name__ == "__main__":
    sys.exit(main())
