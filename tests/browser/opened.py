"""A running studio with its page open, and what a person does there, by the page's own words."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

import pytest
from playwright.sync_api import Locator, Page, expect

from studio.engine.clock import LiveLoop
from studio.engine.live.source import LiveSource
from studio.engine.session import Session
from studio.engine.snapshot import Snapshot
from studio.panels import app as app_module
from studio.panels import scene as scene_module
from studio.panels.app import App
from tests.browser.conftest import PATIENCE

SMALL = "/?fixedDpr=0.25"  # draws fewer pixels, for a browser without a graphics card
PLAIN = 0.02  # [m] the robot's detail, for the same reason

expect.set_options(timeout=PATIENCE)


class Studio:
    """See the module."""

    def __init__(self, loop: LiveLoop, app: App, page: Page) -> None:
        self.loop, self.app, self.page = loop, app, page

    @property
    def now(self) -> Snapshot:
        return self.loop.session.snapshot

    def open(self) -> None:
        self.page.goto(self.app.url + SMALL)
        self.shows("IDLE")

    def press(self, name: str) -> None:
        self.button(name).click()

    def button(self, name: str) -> Locator:
        return self.page.get_by_role("button", name=name, exact=True)

    def tick(self, label: str) -> None:
        self.page.get_by_label(label, exact=True).check()

    def open_step(self, name: str) -> None:
        self.press(name)

    def command(self, label: str) -> None:
        """Choose from the palette, which opens as soon as the page listens to keys."""
        search = self.page.get_by_placeholder("Search commands")
        while not search.is_visible():
            self.page.keyboard.press("Control+k")
            self.page.wait_for_timeout(100)
        search.fill(label)
        self.page.keyboard.press("Enter")

    def unfold(self, label: str) -> None:
        self.page.get_by_text(label, exact=True).click()

    def upload(self, beside: str, path: Path) -> None:
        with self.page.expect_file_chooser() as chooser:
            self.press(beside)
        chooser.value.set_files(path)

    def shows(self, words: str) -> None:
        expect(self.page.get_by_text(words).locator("visible=true").first).to_be_visible()

    def waits(self, reached: Callable[[Snapshot], bool], patience: int = PATIENCE) -> Snapshot:
        for _ in range(patience // 50):
            if reached(self.now):
                return self.now
            self.page.wait_for_timeout(50)
        raise AssertionError(self.now.message.text)

    def teach_once(self, name: str) -> None:
        self.open_step("1 Source")
        self.press("Take the demonstrator")
        self.shows("Source: demonstrator")
        self.open_step("2 Teach")
        self.press("Record")
        self.shows(f"Added {name}.")
        self.shows("IDLE")


class NoScene:
    """In the place of the 3D view, where a test is about buttons: drawing it takes all the time."""

    lacks_meshes = False

    def __init__(self, *_: object) -> None:
        pass

    def draw(self, _: Snapshot) -> None:
        pass

    def shade(self, _: bool) -> None:
        pass

    def wait(self, _: float | None = None) -> None:
        pass


class NoRobot:
    """In the place of the robot, or of its ghost, where a test is about what stands around it."""

    has_meshes = True

    def __init__(self, *_: object) -> None:
        pass

    def draw(self, *_: object) -> None:
        pass


@contextmanager
def studio_on(
    page: Page,
    recordings: Path,
    speed: float,
    live: LiveSource | None = None,
    drawn: Literal["nothing", "furniture", "all"] = "nothing",
) -> Iterator[Studio]:
    """Run a studio whose time passes ``speed`` times as fast, and open its page.

    Of the 3D view only so much is drawn as a test needs.
    """
    build = lambda: Session(recordings, live=live)  # noqa: E731 - built on the loop's thread
    with (
        pytest.MonkeyPatch.context() as patch,
        LiveLoop(build, speed) as loop,
    ):
        if drawn == "nothing":
            patch.setattr(app_module, "SceneView", NoScene)
        elif drawn == "furniture":
            patch.setattr(scene_module, "RobotView", NoRobot)
            patch.setattr(scene_module, "GhostView", NoRobot)
        with App(loop, port=0, detail=PLAIN) as app:
            opened = Studio(loop, app, page)
            opened.open()
            yield opened
