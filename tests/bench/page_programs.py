"""The programs whose pages `bench_page` opens: each serves one and ends with its input."""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import viser

from studio.engine import commands
from studio.engine.clock import LiveLoop
from studio.engine.session import Session
from studio.engine.snapshot import Mode
from studio.engine.teaching import LearnerSettings
from studio.panels.app import App
from studio.panels.meshes import FINE
from studio.panels.robot_view import RobotView
from tests.bench.page_yardstick import CAMERA, NEURONS, looking

ROOT = Path(__file__).resolve().parents[2]
YARDSTICK = Path(__file__).with_name("page_yardstick.py")
PLAYHEAD = 2.0  # [s] where that of a taught session is
GHOST = "1: demonstration-001"  # what is chosen there


def light(camera: tuple[tuple[float, ...], ...] = CAMERA) -> viser.ViserServer:
    """The yardstick's page with the studio's robot: for the pictures, as all else is alike."""
    server = looking(camera)
    RobotView(server.scene, FINE)
    return server


def taught(folder: Path) -> Session:
    """Return a session with two demonstrations, where not all is as it was at the beginning."""
    session = Session(folder)
    for count in (1, 2):
        for order in (commands.UseDemonstrator(), commands.Record()):
            session.post(order)
        while len(session.tick().entries) < count:
            pass
    first = session.snapshot.entries[0].number
    for order in (
        commands.ChooseLearner(LearnerSettings("rbf", NEURONS)),
        commands.Choose(first),
        commands.PlayDemonstration(),
    ):
        session.post(order)
        session.tick()
    while session.tick().mode is Mode.PLAYING:
        pass
    session.post(commands.Scrub(PLAYHEAD))
    session.tick()
    return session


def serve(what: str) -> None:
    """Serve the studio, say where, and go on until standard input ends."""
    begin: Callable[[Path], Session] = {"studio": Session, "taught": taught}[what]
    with (
        tempfile.TemporaryDirectory() as folder,
        LiveLoop(lambda: begin(Path(folder))) as loop,
        App(loop) as app,
    ):
        app.scene.wait()
        print(app.url, flush=True)
        sys.stdin.read()


@contextmanager
def served(what: str, cache: Path) -> Iterator[tuple[str, float]]:
    """Start a page's program; yield the address and how long it took to have all ready [s]."""
    start = time.perf_counter()
    script = YARDSTICK if what in ("minimal", "field") else Path(__file__)
    environment = os.environ | {"PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(cache)}
    program = subprocess.Popen(
        [sys.executable, str(script), what],
        env=environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        url = next(line for line in program.stdout if line.startswith("http")).strip()
        yield url, time.perf_counter() - start
    finally:
        program.stdin.close()
        program.wait(20.0)


if __name__ == "__main__":
    serve(sys.argv[1])
