"""The studio in a real browser: what goes wrong there, who watches, and what comes back."""

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page, expect

from studio.engine import commands
from studio.engine.snapshot import Mode
from studio.engine.sources import write_skeletons
from studio.engine.sources.recording import from_skeletons
from tests.browser.opened import SMALL, Studio, studio_on
from tests.engine.export.materials import listed
from tests.engine.people import stand

CALIBRATE = "Calibrate (stand with arms hanging)"


@pytest.fixture
def studio(page: Page, tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Studio]:
    """A studio at a speed: 1 unless a test asks for another one."""
    with studio_on(page, tmp_path / "recordings", getattr(request, "param", 1.0)) as opened:
        yield opened


@pytest.mark.parametrize("studio", [0.25], indirect=True)
def test_a_broken_file_and_stop(studio: Studio, tmp_path: Path) -> None:
    broken = tmp_path / "waving <b>hand.json"
    broken.write_text('{"version": "0.3", "frames": [')
    studio.upload("Upload a file", broken)
    studio.shows("Problem:")
    studio.shows("waving <b>hand.json")  # as words, and under the user's name

    studio.press("Take the demonstrator")  # and the studio goes on
    studio.shows("Source: demonstrator")
    studio.open_step("2 Teach")
    studio.press("Record")
    studio.waits(lambda now: now.mode is Mode.RECORDING)
    studio.shows("● RECORDING")
    expect(studio.button("Record")).to_be_disabled()
    studio.page.keyboard.press("Escape")
    studio.shows("IDLE")
    studio.shows("nothing armed")
    assert (studio.now.mode, studio.now.entries) == (Mode.IDLE, ())


def test_choose_both_arms_with_fingers_and_calibrate(studio: Studio, tmp_path: Path) -> None:
    studio.unfold("How Baxter follows")
    expect(studio.button(CALIBRATE)).to_be_disabled()
    standing = tmp_path / "standing.jsonl"
    write_skeletons(standing, from_skeletons(stand(0.1, frames=240), "made up", "test"))
    studio.upload("Upload a file", standing)
    studio.shows("Source: standing.jsonl")
    studio.press(CALIBRATE)
    studio.shows("CALIBRATING")
    studio.shows("✔ Calibrated: torso leans 6°: corrected")
    studio.press("Forget the calibration")
    studio.shows("Not calibrated")

    for box, words in (
        ("Mirrored", "what your right arm does"),
        ("Gripper", "opens and closes Baxter's fingers"),
    ):
        studio.tick(box)
        studio.shows(words)
    assert studio.now.choices.mirrored
    assert len(studio.now.world.fingers) == 4
    studio.open_step("2 Teach")
    studio.press("Watch only")
    studio.shows("WATCHING")
    studio.open_step("1 Source")
    studio.unfold("How Baxter follows")
    studio.shows("Stop first: this stays as it is")
    expect(studio.page.get_by_label("Mirrored", exact=True)).to_be_disabled()


def test_a_reload_brings_back_where_one_was(studio: Studio) -> None:
    """The step, the ghost that was chosen, the slider of neurons, and the playhead."""
    studio.loop.session._listed.add(listed(2).takes)
    entry = studio.waits(lambda now: len(now.entries) == 2).entries[1]
    studio.loop.session.post(commands.Choose(entry.number))
    studio.loop.session.post(commands.SetSpeed(0.25))  # not over before a slow page pauses it
    studio.loop.session.post(commands.PlayDemonstration())
    studio.waits(lambda now: now.mode is Mode.PLAYING)
    studio.press("❚❚ Pause")
    paused = studio.waits(lambda now: not now.compare.timeline.is_playing).time
    studio.press("step ▶")
    at = studio.waits(lambda now: now.time > paused).time
    studio.open_step("3 Learn")
    neurons = studio.page.get_by_label("Neurons", exact=True)
    neurons.fill("17")
    neurons.press("Enter")
    studio.page.reload()
    expect(studio.page.get_by_label("Neurons", exact=True)).to_have_value("17")
    studio.open_step("4 Compare")
    expect(studio.page.get_by_label("Ghost", exact=True)).to_have_value(
        f"{entry.number}: {entry.name}"
    )
    assert studio.now.time == at
    studio.shows(f"{at:.2f} of")


def test_one_page_controls_the_other_watches_and_asks(studio: Studio) -> None:
    studio.press("2 Teach")  # the first click takes the seat
    other = studio.page.context.new_page()
    other.goto(studio.app.url + SMALL)
    watching = Studio(studio.loop, studio.app, other)
    watching.shows("You watch; another page controls Baxter.")
    studio.shows("You control Baxter; 1 other watches.")
    watching.press("1 Source")
    watching.shows("You are watching")
    expect(watching.button("Record")).to_be_visible()  # 2 Teach is open still
    watching.press("Ask for control")
    studio.press("Hand over")
    watching.shows("You control Baxter")
    watching.press("1 Source")
    expect(watching.button("Take the tour")).to_be_visible()
    other.close()
    expect(studio.page.get_by_text("You watch")).to_be_hidden()


def test_closing_the_page_while_somebody_teaches_lets_go(studio: Studio) -> None:
    studio.press("Take the demonstrator")
    studio.shows("Source: demonstrator")
    studio.open_step("2 Teach")
    studio.press("Record")
    studio.waits(lambda now: now.gate is not None and now.gate.armed)
    other = studio.page.context.new_page()
    studio.page.close()
    for _ in range(200):
        if studio.now.mode is Mode.IDLE:
            break
        other.wait_for_timeout(100)
    assert studio.now.mode is Mode.IDLE
    other.goto(studio.app.url + SMALL)
    Studio(studio.loop, studio.app, other).shows("was closed or lost its line")


def test_the_tour_is_begun_and_left(studio: Studio) -> None:
    notice = studio.page.get_by_text("Software WebGL").locator("visible=true")
    expect(notice).to_be_visible()  # of this machine, which has no graphics card
    above = notice.bounding_box()["y"]
    studio.press("Take the tour")
    studio.shows("Tour 1/")
    leave = studio.button("Leave the tour").bounding_box()
    assert notice.bounding_box()["y"] > leave["y"] + leave["height"]  # below the caption
    studio.shows("Tour 2/")
    expect(studio.button("Record")).to_be_visible()  # it opens its steps by itself
    studio.press("Stop")
    studio.shows("You took over")
    studio.press("Close")
    expect(studio.page.get_by_text("You took over")).to_be_hidden()
    assert notice.bounding_box()["y"] == above


def test_baxter_stands_on_the_page(page: Page, tmp_path: Path) -> None:
    with studio_on(page, tmp_path / "recordings", 1.0, drawn="all") as studio:
        red = 0
        for _ in range(60):  # Baxter is the only thing that is red
            red = count_red(page.screenshot())
            if red > 500:
                break
            page.wait_for_timeout(500)
        assert red > 500
        assert not studio.app.scene.lacks_meshes


def count_red(png: bytes) -> int:
    """Return how many pixels left of the panels are a robot's red."""
    pixels = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR).astype(int)
    blue, green, red = np.moveaxis(pixels[:, 380:980], -1, 0)
    return int((red - np.maximum(blue, green) > 60).sum())


def test_a_browser_without_webgl_is_told_why(studio: Studio) -> None:
    """A browser whose WebGL is off, as far as a page can see."""
    page = studio.page.context.new_page()  # on which viser may complain before it is left
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.goto(studio.app.url)
    expect(page.get_by_text("This browser cannot draw Baxter")).to_be_visible()
    page.get_by_text("Try again").click()
    expect(page).to_have_url(studio.app.url + "/no-webgl")
