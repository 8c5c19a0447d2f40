"""Make the pictures of the studio, and the short animation of teach, train, reproduce.

Run ``python docs/make_pictures.py``. Needs Chromium and the test extra, and some minutes. The
samples are loaded, as at every start of the studio, and it is used as people use it, by its
buttons. All goes into ``docs/pictures``. Time passes only between two pictures, so that they are
the same however slowly a browser without a graphics card draws.

With ``--all`` the measurements run too that draw all other pictures in ``docs``, and write their
figures anew beside them: most of an hour on two processors, and the bench extra.
"""

import argparse
import io
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from PIL import Image  # comes with viser
from playwright.sync_api import Page, sync_playwright

from studio.engine import commands
from studio.engine.clock import Pace, now
from studio.engine.resources import samples_folder
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings
from studio.engine.work import Work
from studio.panels.app import App

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs" / "pictures"
MEASURED = {  # what draws the other pictures of `docs`; FOLDER is one that is thrown away
    "page.png": ("tests/bench/bench_page.py",),
    "evaluate.svg, evaluate-zone.svg": ("tests/bench/bench_evaluate.py", "FOLDER"),
    "lasa.svg": ("tests/bench/bench_lasa.py", "--jobs", "2"),
}
SIZE = {"width": 1366, "height": 768}  # [px], a laptop's
FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
SETTLE = 5_000  # [ms] until the page has drawn another step
NOTHING = (683, 60)  # [px] where nothing explains itself to a pointer
SENT = 200  # [ms] until a change has come to the page
DRAWN = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
GUESSES = ((1, False), (2, True), (3, True), (12, True))  # neurons, and whether the block falls

FILM_SIZE = (960, 540)  # [px]
COARSE = "/?fixedDpr=0.7"  # draws the robot in no more pixels than that has
EVERY = 8  # ticks between two of its pictures
SHOWN = 150  # [ms] for which one of them is shown: 1.8 times real time
STILL = 2_500  # [ms] that a look at what was learned lasts in it, and one at the end
QUALITY = 60  # of 100


class Stepped:
    """A session that is ticked from here, where the page expects a loop."""

    def __init__(self, recordings: Path) -> None:
        self.session = Session(recordings, work=Work(now))
        self.pace = Pace()

    def tick(self, count: int = 1) -> None:
        """Let time pass."""
        for _ in range(count):
            self.session.tick()

    def until(self, reached: Callable[[Snapshot], bool]) -> None:
        """Let time pass until the session has got somewhere."""
        while not reached(self.session.snapshot):
            self.tick()
            if self.session.snapshot.message.is_error:
                raise SystemExit(self.session.snapshot.message.text)
            time.sleep(0.002)  # long work goes on in another process

    def close(self) -> None:
        """End the session."""
        self.session.close()


def main() -> None:
    """Make the pictures of the page, and all others if that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--all", action="store_true", help="those of the measurements, too")
    everything = parser.parse_args().all
    show_the_page()
    if everything:
        measure()


def measure() -> None:
    """Run what draws pictures of measurements, one after the other."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    for names, command in MEASURED.items():
        print(f"{names}: {' '.join(command)}")
        with tempfile.TemporaryDirectory() as folder:
            given = [folder if each == "FOLDER" else each for each in command]
            subprocess.run([sys.executable, *given], cwd=ROOT, env=environment, check=True)


def show_the_page() -> None:
    """Teach, learn and play in a studio of its own, and take pictures on the way."""
    PICTURES.mkdir(exist_ok=True)
    with (
        tempfile.TemporaryDirectory() as folder,
        closing(Stepped(Path(folder))) as studio,
        App(studio, port=8090) as app,
    ):
        app.scene.wait()
        for sample in sorted(samples_folder().glob("*.mcap")):
            studio.session.post(commands.UseFile(sample))
        studio.until(lambda now: len(now.entries) == 4)
        with opened(app.url) as page:
            show_source(studio, page)
            show_teaching(studio, page)
            show_learning(studio, page)
            show_comparing(studio, page)
        with opened(app.url + COARSE) as page:
            make_film(studio, page)


def show_source(studio: Stepped, page: Page) -> None:
    """Show the puppet, for whoever has no sensor."""
    press(page, "Be the puppet")
    studio.until(lambda now: now.who.puppet is not None)
    page.get_by_text("Your arm's six angles").click()
    page.get_by_text("shoulder yaw").wait_for()
    take_both(page, "source")


def show_teaching(studio: Stepped, page: Page) -> None:
    """Show the armed gate, and how Baxter follows."""
    begin(studio, page, "Watch only")
    studio.until(lambda now: now.gate is not None and now.gate.armed)
    studio.until(lambda now: now.world.block_down and is_sure(now))
    take_both(page, "teach")
    press(page, "Stop")
    studio.until(lambda now: now.mode is Mode.IDLE)


def is_sure(now: Snapshot) -> bool:
    """Tell whether the gate is armed and nothing about the hand is in doubt."""
    return now.gate is not None and now.gate.armed and now.gate.left is None


def show_learning(studio: Stepped, page: Page) -> None:
    """Show the error against neurons, and what somebody guessed."""
    press(page, "3 Learn")
    for neurons, falls in GUESSES:
        known = len(studio.session.snapshot.learning.tried)
        studio.session.post(commands.Guess(LearnerSettings("rbf", neurons), falls))
        studio.until(lambda now, known=known: len(now.learning.tried) > known)
    train(studio)
    studio.until(lambda now: not now.learning.curve.missing)
    take_both(page, "learn")


def show_comparing(studio: Stepped, page: Page) -> None:
    """Show what Baxter did alone, with its numbers."""
    press(page, "4 Compare")
    press(page, "Let Baxter do it alone")
    studio.until(lambda now: now.reproduction is not None)
    studio.until(lambda now: now.mode is Mode.IDLE)
    take_both(page, "compare")


def make_film(studio: Stepped, page: Page) -> None:
    """Teach, train, reproduce, as one animation."""
    begin(studio, page, "Record")
    studio.until(lambda now: now.gate is not None and now.gate.lit > 0)
    film = filmed(studio, page, Mode.IDLE)
    press(page, "3 Learn")
    train(studio)
    studio.until(lambda now: not now.learning.curve.missing)
    page.wait_for_timeout(SETTLE)
    film.append((seen(page), STILL))
    press(page, "4 Compare")
    press(page, "Let Baxter do it alone")
    studio.until(lambda now: now.mode is Mode.PLAYING)
    film += filmed(studio, page, Mode.IDLE)
    page.wait_for_timeout(SETTLE)
    film.append((seen(page), STILL))
    pictures, lasting = zip(*film, strict=True)
    packed = io.BytesIO()  # so that a run that ends early leaves the old one
    pictures[0].save(
        packed,
        "WEBP",
        save_all=True,
        append_images=pictures[1:],
        duration=list(lasting),
        loop=0,
        quality=QUALITY,
    )
    (PICTURES / "studio.webp").write_bytes(packed.getvalue())
    print(f"studio.webp: {len(film)} pictures, {sum(lasting) / 1000:.0f} s")


def filmed(studio: Stepped, page: Page, end: Mode) -> list[tuple[Image.Image, int]]:
    """Return pictures until a mode is reached, each with how long it is shown [ms]."""
    film = []
    while studio.session.snapshot.mode is not end:
        film.append((seen(page), SHOWN))
        studio.tick(EVERY)
    return film


def seen(page: Page) -> Image.Image:
    """Return what the page shows once it has drawn what it was sent, in the animation's size."""
    page.wait_for_timeout(SENT)
    page.evaluate(DRAWN)
    shot = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    return shot.resize(FILM_SIZE, Image.Resampling.LANCZOS)


def begin(studio: Stepped, page: Page, button: str) -> None:
    """Let the demonstrator teach another take."""
    press(page, "2 Teach")
    before = studio.session.snapshot.message.number
    studio.session.post(commands.UseDemonstrator())
    studio.until(lambda now: now.message.number != before)
    page.wait_for_timeout(SETTLE)
    press(page, button)
    studio.until(lambda now: now.mode is not Mode.IDLE)


def train(studio: Stepped) -> None:
    """Learn with 50 neurons."""
    before = studio.session.snapshot.lesson
    studio.session.post(commands.Train(LearnerSettings("rbf", 50)))
    studio.until(lambda now: now.lesson is not None and now.lesson is not before)


@contextmanager
def opened(url: str) -> Iterator[Page]:
    """Open the studio's page, without the remark that there is no graphics card."""
    with sync_playwright() as playwright:
        program = shutil.which("chromium") or playwright.chromium.executable_path
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        page = browser.new_page(viewport=SIZE)
        page.set_default_timeout(120_000)
        page.goto(url)
        page.get_by_text("IDLE").first.wait_for()
        page.add_style_tag(content=".mantine-Notification-root { display: none }")
        yield page
        browser.close()


def press(page: Page, name: str) -> None:
    """Press a button."""
    page.get_by_role("button", name=name, exact=True).click()


def take_both(page: Page, name: str) -> None:
    """Write a picture of the light page and one of the dark page; leave the page light."""
    page.mouse.move(*NOTHING)
    for theme in ("light", "dark"):
        page.wait_for_timeout(SETTLE)
        page.evaluate(DRAWN)
        page.screenshot(path=PICTURES / f"{name}-{theme}.png")
        print(f"{name}-{theme}.png")
        page.keyboard.press("n")


if __name__ == "__main__":
    main()
