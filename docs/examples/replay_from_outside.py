"""Replays a trained network from outside, as the paper's MATLAB step did, target by target.

    studio serve --no-page --remote 127.0.0.1:8766     # in another terminal
    python docs/examples/replay_from_outside.py model.json --teach

Without ``--teach`` it takes a model.json that the studio has exported. It sends each target when it
is due, and waits for no answer; with ``--blocking`` it waits for the answer to each, which comes
after the tick that took it. ``--synchronous`` takes the studio's clock: the world stands still
between two steps, so that it does not matter how long this program thinks. It prints whether the
block is down, and that is its exit status.
"""

import argparse
import json
import sys
from contextlib import ExitStack
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
        elif options.blocking:
            down = replay_answered(studio, motion)
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
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--synchronous", action="store_true", help="the world waits for each step")
    how.add_argument("--blocking", action="store_true", help="wait for the answer to each target")
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
    """Send each target when it is due by the studio's time, which a stream tells tick by tick."""
    blocks = studio.stream(Block)
    studio.move_to(motion[0])
    begun = studio.block().time
    end = begun + len(motion) / RATE + SETTLE
    for block in blocks:  # those from before `begun`, which wait to be read, repeat the first one
        row = round((block.time - begun) * RATE)
        studio.set_joint_target(motion[min(max(row, 0), len(motion) - 1)])
        if block.time >= end:
            break
    return block.down


def replay_answered(studio: Studio, motion: list[dict[str, float]]) -> bool:
    """Send a target, wait until a tick has taken it, and so on."""
    studio.move_to(motion[0])
    for targets in motion + [motion[-1]] * round(SETTLE * RATE):
        studio.do(commands.SetJointTarget(targets))
    return studio.block().down


def replay_in_steps(studio: Studio, clock: Clock, motion: list[dict[str, float]]) -> bool:
    """Send a target, let a tick pass, and so on."""
    clock.move_to(motion[0])
    for targets in motion:
        studio.set_joint_target(targets)
        clock.step()
    return clock.step(round(SETTLE * RATE)).block.down


if __name__ == "__main__":
    sys.exit(main())
