"""The timeline under a real pointer and real keys."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from studio.engine.robot import CONTROL_PERIOD
from studio.engine.snapshot import Mode
from tests.browser.opened import Studio, studio_on
from tests.engine.cards_at_hand import takes
from tests.engine.lessons_at_hand import lesson


@pytest.fixture
def studio(page: Page, tmp_path: Path) -> Iterator[Studio]:
    page.set_viewport_size({"width": 1366, "height": 768})
    with studio_on(page, tmp_path / "recordings", 1.0) as opened:
        opened.loop.session._listed.add(takes(2))
        opened.loop.session._learning.lesson = lesson()
        opened.shows("Play lets Baxter do alone what it learned.")  # and so does its key
        yield opened


def test_play_pause_and_step_by_button_and_by_key(studio: Studio) -> None:
    studio.press("▶ Play")
    studio.waits(lambda now: now.mode is Mode.PLAYING and now.time > 0.3)
    studio.press("❚❚ Pause")
    paused = studio.waits(lambda now: now.mode is Mode.IDLE).time
    studio.press("step ▶")
    on = studio.waits(lambda now: now.time != paused).time
    assert 0.0 < on - paused < CONTROL_PERIOD * 1.01
    (client,) = studio.app._server.get_clients().values()
    stands = client.camera.position
    studio.page.keyboard.press("ArrowLeft", delay=300.0)
    back = studio.waits(lambda now: now.time != on).time
    assert on - back == pytest.approx(CONTROL_PERIOD)
    studio.page.wait_for_timeout(500)
    np.testing.assert_array_equal(client.camera.position, stands)  # viser turns it by arrows, too
    studio.page.keyboard.press("Space")
    studio.waits(lambda now: now.mode is Mode.PLAYING)
    studio.press("▶|")
    ended = studio.waits(lambda now: now.reproduction is not None)
    assert ended.time == pytest.approx(ended.duration)
    studio.shows("The block is down.")


def test_keys_are_heard_whatever_was_clicked_on(studio: Studio) -> None:
    page, press = studio.page, studio.page.keyboard.press
    studio.tick("Loop")
    studio.waits(lambda now: now.compare.timeline.loops)
    press("Space")  # plays, and leaves the box as it is
    playing = studio.waits(lambda now: now.mode is Mode.PLAYING)
    page.get_by_role("textbox").locator("visible=true").first.click()
    press("Escape")  # while somebody types
    studio.waits(lambda now: now.mode is Mode.IDLE)
    page.get_by_label("Speed", exact=True).first.click()
    page.get_by_role("option", name="2x", exact=True).click()
    studio.waits(lambda now: now.compare.timeline.speed == 2.0)
    press("Space")
    studio.waits(lambda now: now.mode is Mode.PLAYING)
    studio.press("❚❚ Pause")
    studio.waits(lambda now: now.mode is Mode.IDLE)
    press("Space")  # plays, and does not press the button once more
    studio.waits(lambda now: now.mode is Mode.PLAYING)
    page.wait_for_timeout(500)
    assert studio.now.mode is Mode.PLAYING
    assert playing.compare.timeline.loops
    assert studio.now.compare.timeline.loops
