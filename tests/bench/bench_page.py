"""The page's weight, its time to the robot, a frame's price: writes its table into docs/page.md.

Run it by ``python tests/bench/bench_page.py``; it takes some ten minutes, and needs Chromium. All
figures are ratios to a minimal viser script of the same run, which adds the same Baxter by
`viser.extras.ViserUrdf`; it is the function `minimal` of `page_yardstick`.
"""

import argparse
import io
import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import viser
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright
from viser.extras import ViserUrdf

from studio.engine import commands
from studio.engine.robot import load_robot
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings
from studio.panels.arcs import ArcsView
from studio.panels.handles import Handles
from studio.panels.meshes import FINE
from studio.panels.scene import SceneView
from tests.bench.page_programs import GHOST, PLAYHEAD, ROOT, light, served
from tests.bench.page_visits import MIDDLE, PATIENCE, SIZE, Visit, red_pixels, reload, visit
from tests.bench.page_yardstick import CAMERA, NEURONS, minimal, upstream
from tests.browser.conftest import FLAGS, NAMES

PAGE, PICTURE = ROOT / "docs" / "page.md", ROOT / "docs" / "page.png"
VIEWS = (CAMERA, ((1.5, 1.6, 1.9), (0.2, 0.1, 0.95)), ((-2.2, -1.6, 1.6), (0.0, 0.0, 0.8)))
KINDS = ("minimal", "studio")
VISITS = 5  # of which the median counts, unless others are asked for


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


def reloads(browser: Browser, visits: int) -> Iterator[Row]:
    """How soon a page that is loaded anew is where it was: step, choice, slider and playhead."""
    theirs, ours = [], []
    head = f"{PLAYHEAD:.2f} of"
    with tempfile.TemporaryDirectory() as cache:
        for _ in range(visits):
            with opened(browser, "field", Path(cache)) as page:
                theirs.append(reload(page, str(NEURONS), "Neurons"))
            with opened(browser, "taught", Path(cache)) as page:
                page.get_by_role("button", name="3 Learn", exact=True).click()
                learn = reload(page, str(NEURONS), head)
                page.get_by_role("button", name="4 Compare", exact=True).click()
                ours.append(max(learn, reload(page, GHOST, head)))
    yard, own = float(np.median(theirs)), float(np.median(ours))
    row = compared("loaded anew to where it was [s]", "≤ 2 s", yard, own)
    yield replace(row, met=own <= 2.0)


@contextmanager
def opened(browser: Browser, what: str, cache: Path) -> Iterator[Page]:
    """Start a page's program and open its page in a fresh browser profile."""
    with served(what, cache) as (url, _):
        page = browser.new_page(viewport=SIZE)
        page.set_default_timeout(1000.0 * PATIENCE)
        page.goto(url)
        yield page
        page.close()


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
    parser.add_argument("--visits", type=int, default=VISITS, help="of each page")
    asked = parser.parse_args()
    rows = list(frames())
    with sync_playwright() as playwright:
        program = next(path for path in map(shutil.which, NAMES) if path)
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        rows = [*weights(browser, asked.visits), *reloads(browser, asked.visits), *rows]
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
