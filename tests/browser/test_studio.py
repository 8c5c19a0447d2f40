"""The studio in a real browser, as a newcomer uses it: by its buttons, reading its words."""

import re
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page, expect

from studio.engine.clock import LiveLoop
from studio.engine.session import Session
from studio.engine.snapshot import Mode
from studio.engine.sources import write_skeletons
from studio.engine.sources.recording import from_skeletons
from studio.panels.app import App
from tests.browser.conftest import PATIENCE
from tests.engine.people import stand

CALIBRATE = "Calibrate (stand with arms hanging)"
FAST, SLOW = 8.0, 0.25  # times real time: to get through, and to catch what passes

expect.set_options(timeout=PATIENCE)


class Studio:
    """A running studio with its page open."""

    def __init__(self, loop: LiveLoop, page: Page) -> None:
        self.loop, self.page = loop, page

    def press(self, name: str) -> None:
        self.button(name).click()

    def button(self, name: str) -> Locator:
        return self.page.get_by_role("button", name=name, exact=True)

    def open_step(self, name: str) -> None:
        self.page.get_by_text(name, exact=True).click()

    def shows(self, words: str) -> None:
        expect(self.page.get_by_text(words).first).to_be_visible()

    def teach_once(self, name: str) -> None:
        self.open_step("1 Source")
        self.press("Take the demonstrator")
        self.shows("Source: demonstrator")
        self.open_step("2 Teach")
        self.press("Record")
        self.shows(f"Added {name}.")
        self.shows("IDLE")


@pytest.fixture
def studio(page: Page, tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Studio]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    build = lambda: Session(tmp_path / "recordings")  # noqa: E731 - built on the loop's thread
    with LiveLoop(build, request.param) as loop, App(loop, port=port, detail=0.02) as app:
        page.goto(app.url)
        opened = Studio(loop, page)
        opened.shows("IDLE")
        yield opened


@pytest.mark.parametrize("studio", [FAST], indirect=True)
def test_teach_train_play_and_see_the_block_fall(studio: Studio, tmp_path: Path) -> None:
    expect(studio.page.locator("canvas").first).to_be_visible()
    studio.open_step("4 Compare")
    expect(studio.button("Let Baxter do it alone")).to_be_disabled()
    studio.shows("Nothing is learned yet")

    studio.teach_once("demonstration-001")
    studio.teach_once("demonstration-002")
    assert len(list((tmp_path / "recordings").glob("*.mcap"))) == 2

    studio.open_step("3 Learn")
    studio.press("Train")
    studio.shows("Learned with 50 neurons")
    row = studio.page.locator("tr", has_text="left_s0").first
    expect(row).to_have_text(re.compile(r"left_s0\d\.\d\de-0\d\d\.\d\de-0\d1\.0\d\d\d"))

    studio.open_step("4 Compare")
    studio.press("Let Baxter do it alone")
    studio.shows("✔ The block is down.")
    now = studio.loop.session.snapshot
    assert now.world.block_down
    assert now.reproduction is not None
    assert now.reproduction.performance.block_down
    studio.shows(f"{1000.0 * now.reproduction.deviation.hand_mean:.1f}")

    studio.page.reload()  # another client, and the same truth
    studio.shows("The block is down.")
    studio.open_step("2 Teach")
    studio.shows("demonstration-002")


@pytest.mark.parametrize("studio", [SLOW], indirect=True)
def test_a_broken_file_and_stop(studio: Studio, tmp_path: Path) -> None:
    broken = tmp_path / "waving <b>hand.json"
    broken.write_text('{"version": "0.3", "frames": [')
    studio.page.locator("input[type=file]").set_input_files(broken)
    studio.shows("Problem:")
    studio.shows("waving <b>hand.json")  # as words, and under the user's name

    studio.press("Take the demonstrator")  # and the studio goes on
    studio.shows("Source: demonstrator")
    studio.open_step("2 Teach")
    studio.press("Record")
    studio.shows("RECORDING")
    studio.shows("waiting for Lasso of the left hand")
    expect(studio.button("Record")).to_be_disabled()
    studio.press("Stop")
    studio.shows("IDLE")
    studio.shows("nothing armed")
    now = studio.loop.session.snapshot
    assert (now.mode, now.entries) == (Mode.IDLE, ())


@pytest.mark.parametrize("studio", [1.0], indirect=True)
def test_choose_both_arms_with_fingers_and_calibrate(studio: Studio, tmp_path: Path) -> None:
    expect(studio.button(CALIBRATE)).to_be_disabled()
    standing = tmp_path / "standing.jsonl"
    write_skeletons(standing, from_skeletons(stand(0.1, frames=240), "made up", "test"))
    studio.page.locator("input[type=file]").set_input_files(standing)
    studio.shows("Source: standing.jsonl")
    studio.press(CALIBRATE)
    studio.shows("CALIBRATING")
    studio.shows("✔ Calibrated: torso leans 6°: corrected")
    studio.press("Forget the calibration")
    studio.shows("Not calibrated")

    for box, words in ((0, "what your right arm does"), (1, "opens and closes Baxter's fingers")):
        studio.page.get_by_role("checkbox").nth(box).check()
        studio.shows(words)
    now = studio.loop.session.snapshot
    assert now.choices.mirrored
    assert len(now.world.fingers) == 4
    studio.open_step("2 Teach")
    studio.press("Watch only")
    studio.shows("WATCHING")
    studio.open_step("1 Source")
    studio.shows("Stop first: this stays as it is")
    expect(studio.page.get_by_role("checkbox").first).to_be_disabled()
