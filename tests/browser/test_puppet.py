"""The puppet under a real pointer: the hand goes where it is dragged, and Baxter is taught."""

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import viser
from playwright.sync_api import Page, expect

from studio.engine.clock import LiveLoop
from studio.engine.placement import Placement
from studio.engine.skeleton import FloatArray, Joint
from studio.panels.app import App
from tests.browser.conftest import PATIENCE
from tests.browser.opened import studio_on
from tests.browser.pixels import pixel


class Puppet:
    """Somebody at the page, who knows where the picture shows what."""

    def __init__(self, loop: LiveLoop, app: App, page: Page) -> None:
        self.loop, self.page = loop, page
        self._server: viser.ViserServer = app._server

    def hand(self) -> FloatArray:
        """Return where the left hand is (3,) [m], in the world."""
        skeleton = self.loop.session.snapshot.skeleton
        hand: FloatArray = Placement.of(skeleton).place(skeleton.positions[Joint.HAND_LEFT])
        return hand

    def pixel(self, point: FloatArray) -> FloatArray:
        """Return where a point (3,) [m] of the world is on the page (2,) [px]."""
        return pixel(self._server, self.page, point)

    def wait(self, reached, what: str) -> None:
        end = time.monotonic() + PATIENCE / 1000.0
        while not reached():
            assert time.monotonic() < end, what
            self.page.wait_for_timeout(100)


@pytest.fixture
def puppet(page: Page, tmp_path: Path) -> Iterator[Puppet]:
    page.set_viewport_size({"width": 1366, "height": 768})  # the hand is behind no panel
    with studio_on(page, tmp_path / "recordings", 1.0, drawn="furniture") as studio:
        studio.press("Be the puppet")
        studio.shows("you, with the puppet")
        studio.open_step("2 Teach")
        yield Puppet(studio.loop, studio.app, page)


def test_the_hand_goes_where_it_is_dragged_keys_sign_and_it_is_taught(puppet: Puppet) -> None:
    page = puppet.page
    page.get_by_role("button", name="Record", exact=True).click()
    puppet.wait(lambda: puppet.loop.session.snapshot.gate is not None, "nobody is watched")
    expect(page.get_by_text("● RECORDING").first).to_be_visible()  # the page has heard of it
    for lit, key in enumerate("loc", start=1):
        page.keyboard.press(key)
        puppet.wait(lambda lit=lit: puppet.loop.session.snapshot.gate.lit == lit, f"{key}: {lit}")
    expect(page.get_by_text("ARMED").first).to_be_visible()

    page.wait_for_timeout(2000)  # until a slow machine has drawn the handles where they are
    start = puppet.pixel(puppet.hand())
    target = start + np.array([-60.0, 25.0])
    page.mouse.move(*start)
    page.mouse.down()
    for share in np.linspace(0.1, 1.0, 10):
        page.mouse.move(*(start + share * (target - start)))
        page.wait_for_timeout(200)
    puppet.wait(
        lambda: np.linalg.norm(puppet.pixel(puppet.hand()) - target) < 8.0,
        "the hand does not come under the pointer",
    )
    page.mouse.up()
    page.wait_for_timeout(1000)
    assert np.linalg.norm(puppet.pixel(puppet.hand()) - target) < 8.0  # and stays there

    page.keyboard.press("l")
    puppet.wait(lambda: not puppet.loop.session.snapshot.gate.armed, "it is armed for ever")
    page.keyboard.press("Escape")
    expect(page.get_by_text("Added demonstration-001.").first).to_be_visible()
    (entry,) = puppet.loop.session.snapshot.entries
    sent = entry.demonstration.sent
    assert np.degrees(np.ptp(sent, axis=0)).max() > 2.0  # Baxter's arm went with the hand
