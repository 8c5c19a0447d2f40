"""Whether 30 Hz hold, with the simulator, a stream and three browsers; into docs/page.md.

    PYTHONPATH=. python tests/bench/bench_rate.py [--seconds 60]

A process of its own serves the studio as the command does. The baseline is that studio with nobody
connected, Baxter holding still in the simulator. Then a recording is played to it by `studio play`,
over a socket, in a loop, and Baxter follows it; then three headless Chromium have its page open as
well. They draw without a graphics card on the same two cores, hence small windows and a plain
robot. Ticks, pictures and frames are counted by who makes or takes them, in each of these.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, Page, sync_playwright

from studio.engine import commands
from studio.engine.clock import LiveLoop, now
from studio.engine.live.access import Address
from studio.engine.live.listener import Listener
from studio.engine.live.source import LiveSource
from studio.engine.robot import CONTROL_RATE
from studio.engine.session import Session
from studio.engine.snapshot import Snapshot
from studio.engine.work import Work
from studio.panels.app import App
from tests.browser.conftest import FLAGS, NAMES
from tests.browser.opened import PLAIN, SMALL

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "page.md"
STREAM = ROOT / "recordings" / "samples" / "teaches-the-push.jsonl"
BROWSERS = 3
WINDOW = {"width": 1024, "height": 600}
HELD = 0.99  # of the ticks that are due
ORDERS = {
    "follow": (commands.UseLive(), commands.Watch()),
    "stop": (commands.Stop(),),
    "count": (),
}
_HEARD = """() => new Promise(done => { let n = 0; const end = performance.now() + 4000;
const draw = t => { n += 1; t < end ? requestAnimationFrame(draw) : done(n / 4) };
requestAnimationFrame(draw) })"""

Counts = dict[str, float]


class Counted(Session):
    """A session that counts its ticks, and how much of the processor each takes."""

    ticks = 0
    taken: list[float]  # [ms]

    def tick(self) -> Snapshot:
        begun = time.thread_time()
        found = super().tick()
        self.ticks += 1
        self.taken.append(1000.0 * (time.thread_time() - begun))
        return found


def serve() -> None:
    """Serve the studio; for each line of standard input give its orders, and tell the counts."""
    live = LiveSource(now)
    with (
        tempfile.TemporaryDirectory() as folder,
        Listener(live, Address("127.0.0.1", 0)) as listener,
        LiveLoop(lambda: built(Path(folder), live)) as loop,
        App(loop, port=0, detail=PLAIN) as app,
    ):
        app.scene.wait()
        drawn = [0]
        draw = app.scene.draw

        def count(snapshot: Snapshot) -> None:
            drawn[0] += 1
            draw(snapshot)

        app.scene.draw = count  # type: ignore[method-assign] # nobody else sees every picture
        print(app.url, listener.address.url, flush=True)
        for line in sys.stdin:
            for order in ORDERS[line.strip()]:
                loop.session.post(order)
            print(json.dumps(counts(loop, live, drawn[0])), flush=True)


def built(folder: Path, live: LiveSource) -> Counted:
    Counted.taken = []
    return Counted(folder, live=live, work=Work(now))


def counts(loop: LiveLoop, live: LiveSource, drawn: int) -> Counts:
    """Return all counts so far, and what the ticks have taken since the last time."""
    session = loop.session
    taken, session.taken = session.taken, []
    return {
        "time": now(),
        "ticks": session.ticks,
        "skipped": loop.pace.skipped,
        "pictures": drawn,
        "processor": time.process_time(),
        "median": float(np.median(taken or [0.0])),
        "p99": float(np.percentile(taken or [0.0], 99)),
        **asdict(live.status().counts),
    }


class Studio:
    """The studio's process: orders in, counts out."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process
        self.page, self.stream = process.stdout.readline().split()

    def say(self, order: str) -> Counts:
        print(order, file=self._process.stdin, flush=True)
        return json.loads(self._process.stdout.readline())

    def count(self, wait: Iterator[None] | object) -> Counts:
        """Return what was counted during a wait."""
        before = self.say("count")
        wait()
        after = self.say("count")
        passed = after["time"] - before["time"]
        counted = {name: after[name] - before[name] for name in after}
        return counted | {"passed": passed, "median": after["median"], "p99": after["p99"]}


@contextmanager
def started(*arguments: str) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [sys.executable, *arguments],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        yield process
    finally:
        process.stdin.close()
        if "play" in arguments:
            process.terminate()
        process.wait(20.0)


def opened(browser: Browser, url: str) -> Page:
    page = browser.new_page(viewport=WINDOW)
    page.goto(url + SMALL)
    page.get_by_text("Evidence").first.wait_for(timeout=90_000)
    return page


def measured(seconds: float, nice: int) -> tuple[dict[str, Counts], list[float]]:
    """Return the counts with nobody, with a stream, and with browsers too; and what they draw."""
    found: dict[str, Counts] = {}
    with started(__file__, "--serve") as process, sync_playwright() as playwright:
        os.setpriority(os.PRIO_PROCESS, process.pid, nice)
        studio = Studio(process)
        time.sleep(3.0)
        found["nobody"] = studio.count(lambda: time.sleep(seconds))
        with started("-m", "studio", "play", str(STREAM), "--to", studio.stream, "--loop"):
            time.sleep(5.0)
            studio.say("follow")
            found["a stream"] = studio.count(lambda: time.sleep(seconds))
            program = next(path for path in map(shutil.which, NAMES) if path)
            browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
            pages = [opened(browser, studio.page) for _ in range(BROWSERS)]
            pages[0].wait_for_timeout(5_000)
            found["and browsers"] = studio.count(
                lambda: pages[0].wait_for_timeout(1000.0 * seconds)
            )
            rates = [float(page.evaluate(_HEARD)) for page in pages]
            browser.close()
    return found, rates


def table(found: dict[str, Counts], rates: list[float]) -> str:
    head = f"with a stream and {BROWSERS} browsers"
    lines = [f"| | nobody connected | with a stream | {head} | ratio |", "|---|---|---|---|---|"]

    lost = ("late", "others", "too_fast", "unreadable")
    for what, value, form, has_ratio in (
        ("seconds counted", lambda e: e["passed"], ".0f", False),
        ("ticks a second", lambda e: e["ticks"] / e["passed"], ".2f", True),
        ("ticks skipped", lambda e: e["skipped"], ".0f", False),
        ("a tick's processor time, median [ms]", lambda e: e["median"], ".1f", True),
        ("the same, p99 [ms]", lambda e: e["p99"], ".1f", True),
        ("pictures sent a second", lambda e: e["pictures"] / e["passed"], ".1f", True),
        ("frames received", lambda e: e["received"], ".0f", False),
        ("of them taken by a tick", lambda e: e["used"], ".0f", False),
        ("dropped, as a newer one came first", lambda e: e["dropped"], ".0f", False),
        ("lost in any other way", lambda e: sum(e[name] for name in lost), ".0f", False),
        ("share of one core", lambda e: e["processor"] / e["passed"], ".0%", True),
    ):
        values = [value(each) for each in found.values()]
        cells = [format(each, form) for each in values]
        cells.append(f"{values[-1] / values[0]:.2f}" if has_ratio else "")
        lines.append(f"| {what} | {' | '.join(cells)} |")
    drawn = ", ".join(f"{each:.1f}" for each in rates)
    share = found["and browsers"]["ticks"] / (CONTROL_RATE * found["and browsers"]["passed"])
    held = "held" if share >= HELD else "**missed**"
    return (
        "\n".join(lines)
        + f"\n\n30 Hz with a stream and {BROWSERS} browsers: {held}, {share:.1%} of all ticks. The "
        f"browsers themselves draw {drawn} pictures a second. The machine's load was "
        f"{os.getloadavg()[1]:.0f} for {os.cpu_count()} cores.\n"
    )


def main() -> None:
    """Measure, print, and put the table into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--nice", type=int, default=0, help="the studio's; below 0 for root only")
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.serve:
        serve()
        return
    text = table(*measured(asked.seconds, asked.nice))
    if asked.nice:
        text += f"\nThe studio's process ran at a niceness of {asked.nice}.\n"
    print(text)
    marked = re.compile(r"(<!-- rate: begin -->\n).*?(<!-- rate: end -->)", re.DOTALL)
    PAGE.write_text(marked.sub(lambda found: found[1] + text + found[2], PAGE.read_text()))


if __name__ == "__main__":
    main()
