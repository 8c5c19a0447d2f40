"""Make the README's pictures of the studio.

Run ``python docs/make_pictures.py``. Needs Chromium and the test extra. The samples teach, as at
every start of the studio.
"""

import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

from studio.engine import commands
from studio.engine.clock import LiveLoop
from studio.engine.resources import samples_folder
from studio.engine.session import Session
from studio.engine.snapshot import Snapshot
from studio.engine.teaching import LearnerSettings
from studio.panels.app import App

DOCS = Path(__file__).resolve().parent
SIZE = {"width": 1600, "height": 900}  # [px]
FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
SLOW = 0.2  # times real time: a browser without a graphics card draws a picture a second
SETTLE = 6_000  # [ms] until the page has drawn what it was sent


def main() -> None:
    """Teach, learn and play in a studio of its own, and take pictures on the way."""
    with (
        tempfile.TemporaryDirectory() as folder,
        LiveLoop(lambda: Session(Path(folder)), SLOW) as loop,
        App(loop, port=8090) as app,
        opened(app.url) as page,
    ):
        app.scene.wait()
        for sample in sorted(samples_folder().glob("*.mcap")):
            loop.session.post(commands.UseFile(sample))
        loop.session.post(commands.UseDemonstrator())
        show_teaching(loop, page)
        show_playing(loop, page)


def show_teaching(loop: LiveLoop, page: Page) -> None:
    """Take a picture of the armed gate."""
    loop.session.post(commands.Watch())
    page.get_by_text("2 Teach", exact=True).click()
    wait_for(loop, lambda now: now.gate is not None and now.gate.armed)
    page.wait_for_timeout(SETTLE)
    take(page, "teaching.png")


def show_playing(loop: LiveLoop, page: Page) -> None:
    """Take a picture of what Baxter did alone."""
    loop.session.post(commands.Train(LearnerSettings("rbf", 50)))
    loop.session.post(commands.PlayReproduction())
    page.get_by_text("4 Compare", exact=True).click()
    wait_for(loop, lambda now: now.reproduction is not None)
    page.wait_for_timeout(SETTLE)
    take(page, "studio.png")


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


def wait_for(loop: LiveLoop, reached: Callable[[Snapshot], bool]) -> None:
    """Wait for the session to get somewhere."""
    while not reached(now := loop.session.snapshot):
        if now.message.is_error:
            raise SystemExit(now.message.text)
        time.sleep(0.05)


def take(page: Page, name: str) -> None:
    """Write one picture."""
    page.screenshot(path=DOCS / name)
    print(DOCS / name)


if __name__ == "__main__":
    main()
