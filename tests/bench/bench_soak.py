"""A soak: half an hour of a studio that is never left alone; writes its table into docs/soak.md.

    PYTHONPATH=. python tests/bench/bench_soak.py [--minutes 30] [--seed 1]

A process of its own serves the studio as the command does: listener, live loop, worker process and
page. A recording is played to it as a live stream, in a loop. `Restless` asks its session for
anything, by a seed; beside it a headless Chromium clicks on any button, uploads whatever a file
chooser asks for, and loads the page again every so often. The robot is drawn plainly and small, for
want of a graphics card. The commands begin with one of each kind, so that what is loaded when first
needed is there before memory is weighed. Once a minute the process's memory is read; what it writes
to standard error is its log. In the end every recording that was ever made is read.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, Error, FileChooser, Page, sync_playwright

from studio.engine import commands
from studio.engine.clock import LiveLoop, now
from studio.engine.live.access import Address
from studio.engine.live.listener import Listener
from studio.engine.live.source import LiveSource
from studio.engine.session import Session
from studio.engine.work import Work
from studio.heap import share_heaps
from studio.panels.app import App
from tests.browser.conftest import FLAGS, NAMES
from tests.browser.opened import PLAIN, SMALL
from tests.restless import Kept, Restless, Watched

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "soak.md"
SAMPLES = ROOT / "recordings" / "samples"
FILES = sorted((*SAMPLES.glob("*.mcap"), *SAMPLES.glob("*.jsonl")))
STREAM = SAMPLES / "teaches-the-push.jsonl"
WARM = 5.0  # [min] in which memory may grow
FLAT = 1.05  # times what it was then
CLICKS, UPLOADS = 20, 9  # clicks between two reloads, and between two uploads
OURS = "setInterceptFileChooserDialog"  # a complaint about this bench's own choosing of files
PATIENT = 2_000  # [ms] for a click
DONE = "that was all"


def serve(folder: Path, seed: int) -> None:
    """Serve the studio and ask it for anything, until standard input ends; then tell the sums."""
    share_heaps()
    safe, made = folder / "safe", folder / "recordings"
    safe.mkdir()
    made.mkdir()
    live, ending, kept = LiveSource(now), threading.Event(), Kept(made, safe)
    with (
        Listener(live, Address("127.0.0.1", 0)) as listener,
        LiveLoop(lambda: Watched(kept, live=live, work=Work(now))) as loop,
        App(loop, port=0, detail=PLAIN) as app,
    ):
        app.scene.wait()
        print(app.url, listener.address.url, flush=True)
        asking = threading.Thread(target=ask, args=(loop.session, seed, kept, ending))
        asking.start()
        sys.stdin.read()
        ending.set()
        asking.join()
    print(f"{DONE}: {kept.made} recordings, {loop.pace.skipped} ticks skipped")
    for words in kept.lost():
        print(f"lost: {words}")


def ask(session: Session, seed: int, kept: Kept, ending: threading.Event) -> None:
    """Ask for everything once, then for anything, and look after every recording."""
    restless = Restless(seed, lambda: session.snapshot, FILES)
    for orders, seconds in chain(restless.everything_once(), restless.asks()):
        for order in orders:
            session.post(order)
        until = now() + seconds
        while not ending.wait(min(0.1, max(0.0, until - now()))) and now() < until:
            kept.look(session.snapshot)
        kept.look(session.snapshot)
        if ending.is_set():
            session.post(commands.Stop())
            return


@dataclass
class Soak:
    """What was seen of it."""

    minutes: list[float] = field(default_factory=list)  # when memory was read
    memory: list[float] = field(default_factory=list)  # [MB] of the studio's process
    helpers: list[float] = field(default_factory=list)  # [MB] of the processes that it started
    handles: list[int] = field(default_factory=list)  # open files and sockets
    threads: list[int] = field(default_factory=list)
    clicks: int = 0
    reloads: int = 0
    uploads: int = 0
    downloads: int = 0
    page_errors: list[str] = field(default_factory=list)
    log: list[str] = field(default_factory=list)
    told: list[str] = field(default_factory=list)  # at the end, by the studio's process

    def read(self, process: int, minute: float) -> None:
        """Read the process's memory."""
        folder = Path(f"/proc/{process}")
        self.minutes.append(minute)
        self.memory.append(resident(process))
        self.helpers.append(sum(map(resident, children(process))))
        self.handles.append(len(list((folder / "fd").iterdir())))
        self.threads.append(len(list((folder / "task").iterdir())))
        print(
            f"{minute:5.1f} min: {self.memory[-1]:.0f} MB, helpers {self.helpers[-1]:.0f} MB, "
            f"{self.handles[-1]} handles, {self.threads[-1]} threads, {self.clicks} clicks",
            flush=True,
        )


def resident(process: int) -> float:
    """Return a process's resident memory [MB]; nothing of one that has gone."""
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    except OSError:
        return 0.0
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def children(process: int) -> list[int]:
    """Return the processes that a process has started, by any of its threads."""
    found = []
    for task in Path(f"/proc/{process}/task").iterdir():
        try:
            found += map(int, (task / "children").read_text().split())
        except OSError:
            continue
    return found


@contextmanager
def served(folder: Path, seed: int, soak: Soak) -> Iterator[tuple[int, str]]:
    """Start the studio and a stream to it; yield its process and address, then take its sums."""
    log = folder / "log"
    arguments = [sys.executable, __file__, "--serve", str(folder), "--seed", str(seed)]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    with log.open("w") as errors:
        studio = subprocess.Popen(
            arguments,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            text=True,
        )
        page, stream = studio.stdout.readline().split()
        player = subprocess.Popen(
            [sys.executable, "-m", "studio", "play", str(STREAM), "--to", stream, "--loop"],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            yield studio.pid, page
        finally:
            player.terminate()
            player.wait(10.0)
            soak.told = studio.communicate(timeout=120.0)[0].splitlines()
            soak.log = log.read_text().splitlines()


class Wanderer:
    """Clicks on anything that can be clicked on, in a browser that often begins anew."""

    def __init__(self, browser: Browser, url: str, seed: int, soak: Soak) -> None:
        self._browser, self._url, self._soak = browser, url + SMALL, soak
        self._random = np.random.default_rng(seed)
        self._page = self._opened()

    def step(self) -> None:
        """Click once; now and then load the page again instead, or open it in a new browser."""
        self._soak.clicks += 1
        if self._soak.clicks % CLICKS == 0:
            self._soak.reloads += 1
            if self._soak.reloads % 4 == 0:
                self._page.context.close()
                self._page = self._opened()
            else:
                self._page.goto(self._url)
            self._page.wait_for_timeout(3_000)
            return
        kind = "button:enabled, input[type=checkbox]:enabled"
        if self._soak.clicks % UPLOADS == 0:
            self._upload_one()
            return
        targets = [each for each in self._page.locator(kind).all() if each.is_visible()]
        if targets:
            target = targets[int(self._random.integers(len(targets)))]
            target.click(timeout=PATIENT, no_wait_after=True)
        self._page.wait_for_timeout(float(self._random.uniform(100, 1_000)))

    def _upload_one(self) -> None:
        """Open the first step, and have a file chosen there."""
        self._page.get_by_role("button", name="1 Source", exact=True).click(timeout=PATIENT)
        self._page.get_by_role("button", name="Upload a file").first.click(timeout=PATIENT)
        self._page.wait_for_timeout(500)

    def close(self) -> None:
        self._page.context.close()

    def _opened(self) -> Page:
        context = self._browser.new_context(viewport={"width": 1100, "height": 700})
        page = context.new_page()
        page.on("pageerror", self._hear)
        page.on("filechooser", self._upload)
        page.on("download", self._count_download)
        page.on("dialog", lambda dialog: dialog.dismiss())
        page.goto(self._url)
        return page

    def _hear(self, error: Error) -> None:
        if OURS not in str(error):
            self._soak.page_errors.append(str(error))

    def _upload(self, chooser: FileChooser) -> None:
        self._soak.uploads += 1
        chooser.set_files(FILES[int(self._random.integers(len(FILES)))])

    def _count_download(self, _: object) -> None:
        self._soak.downloads += 1


def wander(url: str, process: int, minutes: float, seed: int, soak: Soak) -> None:
    """Click until the time is over, and read the memory once a minute."""
    begun = now()
    with sync_playwright() as playwright:
        program = next(path for path in map(shutil.which, NAMES) if path)
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        wanderer = Wanderer(browser, url, seed, soak)
        while (passed := (now() - begun) / 60.0) < minutes:
            if passed >= len(soak.minutes):
                soak.read(process, passed)
            try:
                wanderer.step()
            except Error as error:  # what was to be clicked on has gone, or is covered
                if "Timeout" not in str(error) and "not attached" not in str(error):
                    soak.page_errors.append(str(error).splitlines()[0])
        soak.read(process, (now() - begun) / 60.0)
        wanderer.close()
        browser.close()


def table(soak: Soak, seed: int) -> tuple[str, bool]:
    """Return the page's table, and whether all went well."""
    warm = [k for k, minute in enumerate(soak.minutes) if minute >= min(WARM, soak.minutes[-1] / 2)]
    minutes, memory = np.array(soak.minutes)[warm], np.array(soak.memory)[warm]
    slope = float(np.polyfit(minutes, memory, 1)[0])
    late = float(np.median(memory[-3:]) / np.median(memory[:3]))
    lost = [line for line in soak.told if line.startswith("lost")]
    sums = next((line for line in soak.told if line.startswith(DONE)), f"{DONE}: it never ended")
    clean = not soak.log and not soak.page_errors and not lost
    rows = (
        ("run", f"{soak.minutes[-1]:.0f} minutes, seed {seed}, {time.strftime('%Y-%m-%d')}"),
        ("the machine's load", f"{os.getloadavg()[2]:.0f} for {os.cpu_count()} cores"),
        ("clicks, reloads", f"{soak.clicks}, {soak.reloads}"),
        ("uploads, downloads by the browser", f"{soak.uploads}, {soak.downloads}"),
        ("made meanwhile", sums.partition(": ")[2]),
        ("recordings lost", str(len(lost))),
        ("lines in the log; errors in the page", f"{len(soak.log)}; {len(soak.page_errors)}"),
        ("memory after the warm-up, median of three [MB]", f"{np.median(memory[:3]):.0f}"),
        ("memory at the end, median of three [MB]", f"{np.median(memory[-3:]):.0f}"),
        ("ratio of both; flat is at most 1.05", f"{late:.3f}"),
        ("slope after the warm-up [MB a minute]", f"{slope:+.2f}"),
        ("least and most after the warm-up [MB]", f"{memory.min():.0f}, {memory.max():.0f}"),
        ("open files and sockets, then and at the end", ends(soak.handles, warm)),
        ("threads, then and at the end", ends(soak.threads, warm)),
    )
    text = "| | |\n|---|---|\n" + "".join(f"| {what} | {value} |\n" for what, value in rows)
    course = ", ".join(f"{mb:.0f}" for mb in soak.memory)
    text += f"\nMemory minute by minute [MB]: {course}.\n"
    return text, clean and late <= FLAT


def ends(numbers: list[int], warm: list[int]) -> str:
    return f"{numbers[warm[0]]}, {numbers[-1]}"


def main() -> int:
    """Soak, print, and put the table into the page; return 1 where anything went wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--serve", type=Path, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.serve:
        serve(asked.serve, asked.seed)
        return 0
    soak = Soak()
    with (
        tempfile.TemporaryDirectory() as folder,
        served(Path(folder), asked.seed, soak) as (process, url),
    ):
        wander(url, process, asked.minutes, asked.seed, soak)
    for line in (*soak.log, *soak.page_errors, *soak.told):
        print(line)
    rows, good = table(soak, asked.seed)
    print(rows)
    if PAGE.exists():
        marked = re.compile(r"(<!-- soak: begin -->\n).*?(<!-- soak: end -->)", re.DOTALL)
        text = marked.sub(lambda found: found[1] + rows + found[2], PAGE.read_text())
        PAGE.write_text(text)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
