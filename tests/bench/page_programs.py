"""The programs whose pages `bench_page` opens: each serves one and ends with its input."""

import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import viser
import yourdfpy
from viser.extras import ViserUrdf

from studio.engine import commands
from studio.engine.clock import LiveLoop
from studio.engine.robot import BASE_HEIGHT, description_folder
from studio.engine.session import Session
from studio.engine.snapshot import Mode
from studio.engine.teaching import LearnerSettings
from studio.panels.app import App
from studio.panels.meshes import FINE
from studio.panels.robot_view import RobotView

ROOT = Path(__file__).resolve().parents[2]
CAMERA = (3.6, 0.75, 1.95), (0.25, -0.34, 0.84)  # [m] where from and where to, the studio's own
NEURONS, PLAYHEAD = 17, 2.0  # where the slider and the playhead [s] of a taught session are
GHOST = "1: demonstration-001"  # what is chosen there


def minimal(camera: tuple[tuple[float, ...], ...] = CAMERA) -> viser.ViserServer:
    """The yardstick: all that a viser user writes to show Baxter."""
    server = viser.ViserServer("127.0.0.1", 0, verbose=False)
    server.initial_camera.position, server.initial_camera.look_at = camera
    server.initial_camera.fov = math.radians(43.0)
    server.scene.add_frame("/robot", show_axes=False, position=(0.0, 0.0, BASE_HEIGHT))
    robot = ViserUrdf(server, upstream(), root_node_name="/robot")
    robot.update_cfg(np.zeros(len(robot.get_actuated_joint_names())))
    return server


def light(camera: tuple[tuple[float, ...], ...] = CAMERA) -> viser.ViserServer:
    """The same with the studio's robot: for the pictures, as everything else is alike."""
    server = viser.ViserServer("127.0.0.1", 0, verbose=False)
    server.initial_camera.position, server.initial_camera.look_at = camera
    server.initial_camera.fov = math.radians(43.0)
    RobotView(server.scene, FINE)
    return server


def upstream() -> yourdfpy.URDF:
    folder = description_folder()
    assert folder is not None, "pip install example-robot-data"
    share = folder.parents[2]
    return yourdfpy.URDF.load(
        str(folder / "urdf" / "baxter.urdf"),
        filename_handler=lambda fname: str(share / fname.removeprefix("package://")),
    )


def with_a_field() -> viser.ViserServer:
    """The yardstick of a reload: the minimal page with one number field."""
    server = minimal()
    server.gui.add_number("Neurons", NEURONS)
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
    """Serve one of the pages, say where, and go on until standard input ends."""
    pages = {"minimal": minimal, "light": light, "field": with_a_field}
    if what in pages:
        server = pages[what]()
        print(f"http://127.0.0.1:{server.get_port()}", flush=True)
        sys.stdin.read()
        return
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
    environment = os.environ | {"PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(cache)}
    program = subprocess.Popen(
        [sys.executable, __file__, what],
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
