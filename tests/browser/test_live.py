"""A live stream in a real browser: its address is shown, a press takes it, and Baxter follows."""

import threading
from pathlib import Path

from playwright.sync_api import Page

from studio.engine import clock
from studio.engine.live.access import Address
from studio.engine.live.listener import Listener
from studio.engine.live.source import LiveSource
from studio.engine.skeleton import HandState
from tests.browser.opened import studio_on
from tests.engine.live.streaming import SIGNS, publisher, signing


def test_a_stream_is_taken_and_followed(page: Page, tmp_path: Path) -> None:
    live, ending = LiveSource(clock.now), threading.Event()
    with (
        Listener(live, Address("127.0.0.1", 0)) as listener,
        studio_on(page, tmp_path, 1.0, live) as studio,
    ):

        def send() -> None:
            """Sign once in a while, and keep the hand closed in between."""
            with publisher(listener.address.url) as sensor:
                for n in range(100_000):
                    lap = n % 300
                    state = SIGNS[lap] if lap < len(SIGNS) else HandState.CLOSED
                    sensor.send(signing(n / 30, state))
                    if ending.wait(1 / 30):
                        return

        sending = threading.Thread(target=send)
        try:
            studio.unfold("A sensor: live stream, webcam")
            studio.shows("Nobody sends yet")
            studio.shows(listener.address.url)
            sending.start()
            studio.shows("drives with studio jsonl")
            studio.press("Take the live stream")
            studio.shows("Source: live stream, until Stop")
            studio.open_step("2 Teach")
            studio.press("Watch only")
            studio.shows("ARMED")
            ending.set()
            studio.shows("WATCHING")
            studio.press("Stop")
            studio.shows("IDLE")
        finally:
            ending.set()
            if sending.is_alive():
                sending.join()
