"""The page's weight, its time to the robot, a frame's price: writes its table into docs/page.md.

Run it by ``python tests/bench/bench_page.py``; it takes some five minutes, and needs Chromium. All
figures are ratios to a minimal viser script of the same run, which adds the same Baxter by
`viser.extras.ViserUrdf`; it is the function `minimal` below.
"""

import argparse
import base64
import io
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import viser
import yourdfpy
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright
from viser.extras import ViserUrdf

from studio.engine import commands
from studio.engine.clock import LiveLoop
from studio.engine.robot import BASE_HEIGHT, description_folder, load_robot
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings
from studio.panels.app import App
from studio.panels.arcs import ArcsView
from studio.panels.handles import Handles
from studio.panels.meshes import FINE
from studio.panels.robot_view import RobotView
from studio.panels.scene import SceneView
from tests.browser.conftest import FLAGS, NAMES

ROOT = Path(__file__).resolve().parents[2]
PAGE, PICTURE = ROOT / "docs" / "page.md", ROOT / "docs" / "page.png"
SIZE = {"width": 1366, "height": 768}
MIDDLE = {"x": 390, "y": 120, "width": 630, "height": 560}  # the scene, clear of all panels
CAMERA = (3.6, 0.75, 1.95), (0.25, -0.34, 0.84)  # [m] where from and where to, the studio's own
VIEWS = (CAMERA, ((1.5, 1.6, 1.9), (0.2, 0.1, 0.95)), ((-2.2, -1.6, 1.6), (0.0, 0.0, 0.8)))
RED = 60  # by how much a red pixel is redder than it is green: only Baxter is
PATIENCE = 90.0  # [s]
KINDS = ("minimal", "studio")
VISITS = 5  # of which the median counts, unless others are asked for


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


def serve(what: str) -> None:
    """Serve one of the pages, say where, and go on until standard input ends."""
    if what == "studio":
        with (
            tempfile.TemporaryDirectory() as folder,
            LiveLoop(lambda: Session(Path(folder))) as loop,
            App(loop) as app,
        ):
            app.scene.wait()
            print(app.url, flush=True)
            sys.stdin.read()
        return
    server = {"minimal": minimal, "light": light}[what]()
    print(f"http://127.0.0.1:{server.get_port()}", flush=True)
    sys.stdin.read()


@contextmanager
def served(what: str, cache: Path) -> Iterator[tuple[str, float]]:
    """Start a page's program; yield the address and how long it took to have all ready [s]."""
    start = time.perf_counter()
    environment = os.environ | {"PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(cache)}
    program = subprocess.Popen(
        [sys.executable, __file__, "--serve", what],
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


@dataclass(frozen=True)
class Visit:
    """What it took until the robot was on the screen."""

    socket: int  # [bytes] over the websocket
    page: int  # [bytes] all that was loaded, the websocket included
    seconds: float


def visit(browser: Browser, url: str) -> Visit:
    """Open a page in a fresh browser profile, and watch what it shows until the robot stands."""
    context = browser.new_context(viewport=SIZE)
    page = context.new_page()
    wire = context.new_cdp_session(page)
    wire.send("Network.enable")
    loaded: list[tuple[float, int]] = []
    heard: list[tuple[float, int]] = []
    shown: list[tuple[float, int]] = []  # when each picture was drawn, and its red pixels

    def see(event: dict) -> None:
        wire.send("Page.screencastFrameAck", {"sessionId": event["sessionId"]})
        picture = red_pixels(base64.b64decode(event["data"]), MIDDLE)
        shown.append((event["metadata"]["timestamp"], picture))

    wire.on(
        "Network.loadingFinished", lambda e: loaded.append((time.time(), e["encodedDataLength"]))
    )
    wire.on("Page.screencastFrame", see)
    page.on(
        "websocket",
        lambda socket: socket.on(
            "framereceived", lambda data: heard.append((time.time(), len(data)))
        ),
    )
    wire.send("Page.startScreencast", {"format": "png"})
    start = time.time()
    page.goto(url)
    while time.time() - start < PATIENCE and not stands(shown):
        page.wait_for_timeout(100)
    context.close()
    seen = next(at for at, count in shown if count >= 0.5 * shown[-1][1] > 0)
    socket = sum(size for at, size in heard if at <= seen)
    other = sum(int(size) for at, size in loaded if at <= seen)
    return Visit(socket, socket + other, seen - start)


def stands(shown: list[tuple[float, int]]) -> bool:
    """Whether the last pictures show the same robot, for some seconds."""
    if len(shown) < 3 or shown[-1][1] < 1000:
        return False
    lately = [count for at, count in shown if at > shown[-1][0] - 4.0]
    enough = shown[-1][0] - shown[0][0] > 4.0 and len(lately) >= 3
    return enough and max(lately) - min(lately) <= 0.02 * max(lately)


def red_pixels(png: bytes, clip: dict[str, int] | None = None) -> int:
    picture = Image.open(io.BytesIO(png)).convert("RGB")
    if clip:
        left, top = clip["x"], clip["y"]
        picture = picture.crop((left, top, left + clip["width"], top + clip["height"]))
    pixels = np.asarray(picture, np.int64)
    return int(np.sum(pixels[..., 0] - pixels[..., 1] > RED))


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    what: str
    wanted: str
    minimal: str
    studio: str
    ratio: str
    met: bool | None = None  # None where nothing was promised


def weights(browser: Browser, visits: int) -> Iterator[Row]:
    """Bytes and seconds, from pages opened by turns."""
    with tempfile.TemporaryDirectory() as folder:
        cache = Path(folder)
        with served("studio", cache) as (_, first_start):
            pass
        rounds = [[visited(browser, what, cache) for what in KINDS] for _ in range(visits)]
    yard_start, start = (float(np.median([each[i][1] for each in rounds])) for i in (0, 1))
    pairs = [(yard, own) for (yard, _), (own, _) in rounds]
    for what, wanted, bar, part in (
        ("websocket [MB]", "≤ .35", 0.35, lambda v: v.socket / 1e6),
        ("whole page [MB]", "≤ .45", 0.45, lambda v: v.page / 1e6),
        ("page opened to robot on screen [s]", "≤ 1", 1.0, lambda v: v.seconds),
    ):
        theirs, ours = (float(np.median([part(pair[i]) for pair in pairs])) for i in (0, 1))
        yield compared(what, wanted, theirs, ours, bar)
    theirs, ours = (
        float(np.median([pair[i].page - pair[i].socket for pair in pairs])) for i in (0, 1)
    )
    yield compared("of it HTML and scripts, viser's own [MB]", "", theirs / 1e6, ours / 1e6)
    yield compared("program started to page ready [s]", "≤ 1", yard_start, start, 1.0)
    yield compared("the same, very first start [s]", "", yard_start, first_start)


def visited(browser: Browser, what: str, cache: Path) -> tuple[Visit, float]:
    """Start a page's program, open the page, and end it, so that nothing else runs beside it."""
    with served(what, cache) as (url, seconds):
        return visit(browser, url), seconds


def compared(what: str, wanted: str, theirs: float, ours: float, bar: float | None = None) -> Row:
    ratio = ours / theirs
    met = None if bar is None else ratio <= bar
    return Row(what, wanted, f"{theirs:.2f}", f"{ours:.2f}", f"{ratio:.2f}", met)


def frames() -> Iterator[Row]:
    """What a frame costs the server: all that is drawn in the scene, against `update_cfg`."""
    alone = snapshots()
    beside = [replace(now, compare=replace(now.compare, beside=now.world)) for now in alone]
    server = viser.ViserServer("127.0.0.1", 0, verbose=False)
    view = SceneView(server, FINE)
    others = Handles(server.scene, lambda _: None), ArcsView(server.scene)
    robots = [ViserUrdf(server, upstream(), root_node_name=f"/urdf_{n}") for n in range(3)]
    names = list(robots[0].get_actuated_joint_names())
    own_names = load_robot().joint_names
    known = [(names.index(name), own_names.index(name)) for name in names if name in own_names]
    rows = np.zeros((len(alone), 3, len(names)))
    for target, source in known:
        rows[:, 0, target] = rows[:, 2, target] = [
            now.world.joint_positions[source] for now in alone
        ]
        rows[:, 1, target] = [now.ghost[source] for now in alone]

    def ours(scenes: list[Snapshot], index: int) -> None:
        for each in (view, *others):
            each.draw(scenes[index])

    def theirs(count: int, index: int) -> None:
        for robot, joints in zip(robots[:count], rows[index], strict=False):
            robot.update_cfg(joints)

    for scenes, count, what in ((alone, 2, "robot and ghost"), (beside, 3, "a second robot too")):
        ours(scenes, 0)  # asks for the meshes
        view.wait()
        draws = (partial(ours, scenes), partial(theirs, count))
        own, yard = (milliseconds(server, draw, len(scenes)) for draw in draws)
        yield compared(f"a frame on the server, {what} [ms]", "≤ .15", yard, own, 0.15)
    server.stop()


def snapshots() -> list[Snapshot]:
    """Baxter does alone what it learned, its ghost beside it, and a person who moves."""
    with tempfile.TemporaryDirectory() as folder:
        session = Session(Path(folder))
        for order in (commands.UseDemonstrator(), commands.Record()):
            session.post(order)
        taught = [session.tick()]
        while not taught[-1].entries:
            taught.append(session.tick())
        people = [now.skeleton for now in taught if now.skeleton is not None]
        for order in (commands.Train(LearnerSettings("rbf", 20)), commands.PlayReproduction()):
            session.post(order)
            session.tick()
        played = []
        while not played or played[-1].mode is not Mode.IDLE:
            played.append(session.tick())
        session.close()
    moving = [now for now in played if now.ghost is not None]
    return [replace(now, skeleton=person) for now, person in zip(moving, people, strict=False)]


def milliseconds(server: viser.ViserServer, draw: Callable[[int], None], count: int) -> float:
    """Return the processor's time of the median frame [ms], drawn as the studio draws."""
    taken = []
    for index in [*range(count), *range(count)]:
        start = time.thread_time()
        with server.atomic():
            draw(index)
        taken.append(time.thread_time() - start)
    return 1000.0 * float(np.median(taken[count:]))


def pictures(browser: Browser) -> Iterator[Row]:
    """Put both robots side by side, and count the pixels that only one of them covers."""
    pairs = []
    for camera in VIEWS:
        pair = []
        for make in (minimal, light):
            server = make(camera)
            page = browser.new_page(viewport=SIZE)
            page.set_default_timeout(1000.0 * PATIENCE)
            page.goto(f"http://127.0.0.1:{server.get_port()}")
            pair.append(Image.open(io.BytesIO(settled(page))).convert("RGB"))
            page.close()
            server.stop()
        pairs.append(pair)
    width, height = pairs[0][0].size
    sheet = Image.new("RGB", (width * len(pairs), height * 2))
    for column, pair in enumerate(pairs):
        for row, shot in enumerate(pair):
            sheet.paste(shot, (column * width, row * height))
    sheet.quantize(128).save(PICTURE, optimize=True)
    covered = [[np.asarray(shot).min(axis=2) < 250 for shot in pair] for pair in pairs]
    differ = [float((a ^ b).sum() / a.sum()) for a, b in covered]
    share = ", ".join(f"{100 * value:.1f} %" for value in differ)
    yield Row("outline: pixels that only one covers, three views", "", "", share, "")


def settled(page: Page) -> bytes:
    """Return a picture of the page once nothing in it has changed for three pictures."""
    shots = [b"", b"", page.screenshot(clip=MIDDLE)]
    start = time.perf_counter()
    while time.perf_counter() - start < PATIENCE:
        time.sleep(1.0)
        shots.append(page.screenshot(clip=MIDDLE))
        if red_pixels(shots[-1]) and len({*shots[-3:]}) == 1:
            break
    return shots[-1]


def main() -> None:
    """Measure, print, and put the table into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--serve", choices=("studio", "minimal", "light"))
    parser.add_argument("--visits", type=int, default=VISITS, help="of each page")
    asked = parser.parse_args()
    if asked.serve:
        serve(asked.serve)
        return
    rows = list(frames())
    with sync_playwright() as playwright:
        program = next(path for path in map(shutil.which, NAMES) if path)
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        rows = [*weights(browser, asked.visits), *rows]
        print(*rows, sep="\n", flush=True)
        rows += pictures(browser)
        browser.close()
    table = "| | wanted | minimal script | studio | ratio |\n|---|---|---|---|---|\n"
    for row in rows:
        missed = " **missed**" if row.met is False else ""
        cells = (row.what, row.wanted, row.minimal, row.studio, row.ratio + missed)
        table += f"| {' | '.join(cells)} |\n"
    table += (
        f"\nVisits of each page: {asked.visits}. The machine's load meanwhile was "
        f"{os.getloadavg()[2]:.0f} for {os.cpu_count()} cores.\n"
    )
    print(table)
    text = PAGE.read_text()
    marked = re.compile(r"(<!-- bars: begin -->\n).*?(<!-- bars: end -->)", re.DOTALL)
    PAGE.write_text(marked.sub(lambda found: found[1] + table + found[2], text))


if __name__ == "__main__":
    main()
