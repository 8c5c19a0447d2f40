"""What `bench_page` does in a browser, and what it sees there."""

import base64
import io
import time
from dataclasses import dataclass

import numpy as np
from PIL import Image
from playwright.sync_api import Browser, Page

SIZE = {"width": 1366, "height": 768}
MIDDLE = {"x": 390, "y": 120, "width": 630, "height": 560}  # the scene, clear of all panels
RED = 60  # by how much a red pixel is redder than it is green: only Baxter is
PATIENCE = 90.0  # [s]
SETTLED = 8000  # [ms] until a page does nothing but show


@dataclass(frozen=True)
class Visit:
    """What it took until the robot was on the screen."""

    socket: int  # [bytes] over the websocket
    page: int  # [bytes] all that was loaded, the websocket included
    seconds: float


def visit(browser: Browser, url: str) -> Visit:
    """Open a page in a fresh browser profile, and watch what it shows until the robot stands."""
    context = browser.new_context(viewport=SIZE)
    page = context.new_page()
    wire = context.new_cdp_session(page)
    wire.send("Network.enable")
    loaded: list[tuple[float, int]] = []
    heard: list[tuple[float, int]] = []
    shown: list[tuple[float, int]] = []  # when each picture was drawn, and its red pixels

    def see(event: dict) -> None:
        wire.send("Page.screencastFrameAck", {"sessionId": event["sessionId"]})
        picture = red_pixels(base64.b64decode(event["data"]), MIDDLE)
        shown.append((event["metadata"]["timestamp"], picture))

    wire.on(
        "Network.loadingFinished", lambda e: loaded.append((time.time(), e["encodedDataLength"]))
    )
    wire.on("Page.screencastFrame", see)
    page.on(
        "websocket",
        lambda socket: socket.on(
            "framereceived", lambda data: heard.append((time.time(), len(data)))
        ),
    )
    wire.send("Page.startScreencast", {"format": "png"})
    start = time.time()
    page.goto(url)
    while time.time() - start < PATIENCE and not stands(shown):
        page.wait_for_timeout(100)
    context.close()
    seen = next(at for at, count in shown if count >= 0.5 * shown[-1][1] > 0)
    socket = sum(size for at, size in heard if at <= seen)
    other = sum(int(size) for at, size in loaded if at <= seen)
    return Visit(socket, socket + other, seen - start)


def stands(shown: list[tuple[float, int]]) -> bool:
    """Whether the last pictures show the same robot, for some seconds."""
    if len(shown) < 3 or shown[-1][1] < 1000:
        return False
    lately = [count for at, count in shown if at > shown[-1][0] - 4.0]
    enough = shown[-1][0] - shown[0][0] > 4.0 and len(lately) >= 3
    return enough and max(lately) - min(lately) <= 0.02 * max(lately)


def red_pixels(png: bytes, clip: dict[str, int] | None = None) -> int:
    picture = Image.open(io.BytesIO(png)).convert("RGB")
    if clip:
        left, top = clip["x"], clip["y"]
        picture = picture.crop((left, top, left + clip["width"], top + clip["height"]))
    pixels = np.asarray(picture, np.int64)
    return int(np.sum(pixels[..., 0] - pixels[..., 1] > RED))


def reload(page: Page, value: str, words: str) -> float:
    """Return how long [s] it takes until a page that is loaded anew shows what it showed before.

    That is a field with a value, and words anywhere.
    """
    page.wait_for_timeout(SETTLED)
    start = time.perf_counter()
    page.reload(wait_until="commit")
    page.wait_for_function(_SHOWN, arg=[value, words], polling=50)
    return time.perf_counter() - start


_SHOWN = """([value, words]) =>
  [...document.querySelectorAll("input")].some((each) => each.value === value && each.offsetParent)
  && document.body.textContent.includes(words)"""
