"""What is exported opens in a browser, from a file and without a network."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page

from studio.engine.camera import Camera
from studio.engine.export import Job
from studio.engine.export.video import FRAME_RATE, Side, write_film
from studio.panels.replay_page import replay_page
from tests.engine.export.materials import done

PLAYER = 45  # [px] at the bottom of a replay
VISIBLE = 200  # [px] of red when Baxter has appeared
PLAIN = 0.02  # [m] detail for a browser without a graphics card

_PLAYED = """async () => {
  const video = document.querySelector('video');
  video.muted = true;
  await video.play();
  await new Promise(done => video.ended ? done() : video.addEventListener('ended', done));
  return [video.duration, video.videoWidth, video.videoHeight,
          video.getVideoPlaybackQuality().totalVideoFrames];
}"""


def test_a_film_plays_to_its_end(page: Page, tmp_path: Path) -> None:
    whole = done().reproduction.performance
    some = replace(whole, ticks=whole.ticks[30:60])
    sides = (Side.of("Demonstration", some), Side.of("Alone", some))
    path = tmp_path / "film.webm"
    count = write_film(path, sides, Job(tmp_path), Camera(size=(240, 180)))
    page.context.set_offline(True)
    page.goto(path.as_uri())
    duration, width, height, frames = page.evaluate(_PLAYED)
    assert (width, height) == (480, 180)
    assert duration == pytest.approx(count / FRAME_RATE, abs=1.0 / FRAME_RATE)
    # A busy browser may skip one; more than there are it cannot show.
    assert count - 3 <= frames <= count


def test_a_replay_opens_without_a_network_and_moves(page: Page, tmp_path: Path) -> None:
    material = done()
    whole = material.reproduction.performance
    moving = replace(whole, ticks=whole.ticks[60:90:3])
    reproduction = replace(material.reproduction, performance=moving)
    ghost = material.takes[0].demonstration
    path = tmp_path / "replay.html"
    path.write_bytes(replay_page(material.lesson, reproduction, ghost, Job(tmp_path), PLAIN))
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.set_viewport_size({"width": 300, "height": 280})
    page.context.set_offline(True)
    page.goto(path.as_uri())
    page.locator("canvas").first.wait_for()
    # Viser's word that it draws by software is in the way.
    page.add_style_tag(content=".mantine-Notification-root { display: none; }")
    # No click, which waits for frames that come slowly.
    page.locator("button.mantine-ActionIcon-root").first.dispatch_event("click")
    wait_until(page, lambda: it_moves_and_comes_back(page))
    assert {url.split(":")[0] for url in asked} <= {"file", "blob", "data"}


def it_moves_and_comes_back(page: Page) -> bool:
    begin, end, again = (standing_still(page, time) for time in ("0.0", "0.3", "0.0"))
    # Not to the pixel: while it is paused, viser may leave a joint's last step undrawn.
    return changed(begin, end) > 0.25 and changed(begin, again) < 0.18


def standing_still(page: Page, time: str) -> np.ndarray:
    """Return Baxter's red parts at a time, once they have not moved for some seconds."""
    field = page.locator("input[inputmode=decimal]")
    seen = [red_parts(page)]

    def stand_still() -> bool:
        # Asked again: a slow browser may play one step more after it was told to pause.
        if field.input_value() != time:
            field.fill(time)
            seen.clear()
        page.wait_for_timeout(300)
        seen.append(red_parts(page))
        if len(seen) < 6 or seen[-1].sum() < VISIBLE:
            return False
        return max(changed(seen[-1], each) for each in seen[-5:-1]) < 0.02

    wait_until(page, stand_still)
    return seen[-1]


def red_parts(page: Page) -> np.ndarray:
    """Return where Baxter is red, (height, width); the same however far it has faded in."""
    png = np.frombuffer(page.screenshot(), np.uint8)
    blue, green, red = np.moveaxis(cv2.imdecode(png, cv2.IMREAD_COLOR).astype(float), -1, 0)
    redness = (red - np.maximum(blue, green))[:-PLAYER]
    return redness > 0.5 * max(redness.max(), 20.0)


def changed(before: np.ndarray, after: np.ndarray) -> float:
    """Return the share of two pictures' red parts that only one of them has."""
    return float((before ^ after).sum() / max(1, (before | after).sum()))


def wait_until(page: Page, reached: Callable[[], bool]) -> None:
    for _ in range(150):
        if reached():
            return
        page.wait_for_timeout(300)
    raise AssertionError("waited too long")
