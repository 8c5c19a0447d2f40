"""A studio without a page, in this process; programs reach it from others. Nothing goes unheard."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from studio.engine import commands as engine
from studio.engine.clock import LiveLoop
from studio.engine.live.access import Address
from studio.engine.remote.server import RemoteServer
from studio.engine.seat import Seat
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.remote import Studio, connect
from tests.remote.overheard import Overheard

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 120.0  # [s] for a busy machine; what depends on its speed is counted in ticks


@dataclass
class House:
    loop: LiveLoop
    seat: Seat
    server: RemoteServer
    overheard: Overheard
    folder: Path
    programs: list[subprocess.Popen[str]] = field(default_factory=list)
    halts: int = 0  # ticks in which the robot held, as a program that drove it said nothing
    failed: int = 0  # tries of programs that were run

    @property
    def url(self) -> str:
        return self.server.address.url

    @property
    def now(self) -> Snapshot:
        return self.loop.session.snapshot

    def connect(self, **options) -> Studio:
        return connect(self.url, **{"timeout": PATIENCE, **options})

    def start(self, *command: str | Path, **environment: str) -> subprocess.Popen[str]:
        """Start a program; it is gone when the house is closed."""
        here = {"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
        program = subprocess.Popen(
            [*map(str, command)],
            env={**os.environ, **here, **environment},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=self.folder,
        )
        self.programs.append(program)
        return program

    def run(self, *command: str | Path, tries: int = 1, **environment: str) -> str:
        """Run a program until it succeeds, at most so often, and return what it printed.

        Nothing that it asks is refused. A try may fail only if the program was silent for so long
        that the robot held (``halts``): a busy machine may stop a process for that long, which no
        program can help.
        """
        for _ in range(tries):
            before = self.halts
            program = self.start(*command, **environment)
            printed, said = program.communicate(timeout=2 * PATIENCE)
            if program.returncode == 0:
                assert self.failed or self.overheard.count("told", "error") == 0, said
                return printed
            self.failed += 1
            assert self.halts > before, (printed, said)
        raise AssertionError((printed, said))

    def look(self, now: Snapshot) -> None:
        """Take note of a tick."""
        self.halts += now.driven is not None and now.driven.holds

    def stop_once_driven(self) -> None:
        """Press Stop in the first tick that comes in which a program drives, however soon."""
        waiting = [engine.Stop()]

        def look(now: Snapshot) -> None:
            if now.mode is Mode.DRIVEN and waiting:
                self.loop.session.post(waiting.pop())

        self.loop.watch(look)

    def run_python(self, file: Path, *arguments: str | Path, tries: int = 1) -> str:
        python = (sys.executable, "-W", "error")
        return self.run(*python, file, *arguments, "--url", self.url, tries=tries)


@contextmanager
def open_house(folder: Path, speed: float = 1.0, token: str | None = None) -> Iterator[House]:
    """A studio that is reached by programs; in the end all that was said has to be documented."""
    overheard, seat = Overheard(), Seat()
    with ExitStack() as stack:
        loop = stack.enter_context(LiveLoop(lambda: Session(folder), speed))
        address = Address("127.0.0.1", 0)
        server = stack.enter_context(RemoteServer(loop, seat, address, token, overheard))
        house = House(loop, seat, server, overheard, folder)
        loop.watch(house.look)
        stack.callback(_end, house)
        yield house
    assert overheard.check() > 0


def _end(house: House) -> None:
    for program in house.programs:
        with suppress(ProcessLookupError):
            program.kill()
        program.communicate()


def eventually(reached: Callable[[], object], seconds: float = PATIENCE) -> None:
    deadline = time.monotonic() + seconds
    while not reached():
        assert time.monotonic() < deadline, "it never came to that"
        time.sleep(0.01)


def goes_on(house: House) -> bool:
    """Whether ticks come by themselves, however seldom."""
    before = house.now
    eventually(lambda: house.now.world.time != before.world.time)
    return not house.loop.steps.is_held


def stands_still(house: House) -> bool:
    """Whether the robot's joints rest, for a quarter of a second of the session's ticks.

    Before that it has as long to come to rest.
    """
    begun = house.now
    eventually(lambda: house.now.world.time - begun.world.time > 0.25)
    before = house.now
    eventually(lambda: house.now.world.time - before.world.time > 0.25)
    moved = house.now.world.joint_positions - before.world.joint_positions
    return float(np.abs(moved).max()) < 1e-3
