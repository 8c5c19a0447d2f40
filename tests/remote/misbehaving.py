"""A program that gets somewhere, says so, and then only goes on with it: to be killed or stopped.

Usage: ``misbehaving.py WHAT URL``. It imports no engine, so that it is there at once.
"""

import itertools
import sys
import time
from contextlib import suppress

from studio.remote import RefusedError, Snapshot, Studio, commands, connect

FAR = 1.5  # [rad] on the way there for longer than any test takes


def drive(studio: Studio) -> None:
    studio.do(commands.PutBlockBack())
    studio.do(commands.BeginDriving())
    for k in itertools.count():
        studio.set_joint_target({"left_s0": FAR})
        if k == 10:
            print("ready", flush=True)
        time.sleep(1 / 30)


def hold_clock(studio: Studio) -> None:
    studio.do(commands.PutBlockBack())
    studio.do(commands.BeginDriving())
    ready = False
    while True:
        with suppress(RefusedError), studio.clock(patience=0.5) as clock:
            for k in itertools.count():
                studio.set_joint_target({"left_s0": FAR})
                clock.step()
                if k == 20 and not ready:
                    ready = print("ready", flush=True) is None
                time.sleep(1 / 30)


def record(studio: Studio) -> None:
    studio.do(commands.UseDemonstrator())
    studio.do(commands.Record())
    print("ready", flush=True)
    time.sleep(60.0)


def watch(studio: Studio) -> None:
    for k, _ in enumerate(studio.stream(Snapshot)):
        if k == 3:
            print("ready", flush=True)


if __name__ == "__main__":
    with connect(sys.argv[2], timeout=120.0) as connected:
        if sys.argv[1] != "watch":
            connected.take_control()
        globals()[sys.argv[1]](connected)
