"""The studio with its browser: the engine's live loop, and the panels hung on it."""

import os
import tempfile
import time
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.clock import LiveLoop, now
from studio.engine.errors import StudioError
from studio.engine.experiment import Setup
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.work import Work
from studio.panels.app import App
from studio.running import Doors, running, say, serve_until_interrupted


def serve_studio(host: str, port: int, recordings: Path, browser: bool, doors: Doors) -> None:
    """Serve the studio with the samples loaded until interrupted.

    Raises
    ------
    StudioError
        Where it can't be reached at an address that was asked for.
    """
    with (
        running(recordings, doors) as engine,
        App(engine.loop, host, port, seat=engine.seat) as app,
    ):
        _announce(app.url, browser)
        serve_until_interrupted()


@contextmanager
def shown_demo(port: int, setup: Setup, demonstrations: int) -> Iterator[None]:
    """Show the whole demonstration in the browser as it happens; the page stays until the end.

    Raises
    ------
    StudioError
        Where something goes wrong on the way.
    """
    with tempfile.TemporaryDirectory() as folder:
        build: Callable[[], Session] = lambda: Session(  # noqa: E731
            Path(folder), setup.seed, work=Work(now)
        )
        with LiveLoop(build) as loop, App(loop, "127.0.0.1", port) as app:
            _announce(app.url, browser=True)
            session = loop.session
            choices = Choices(setup.arms, setup.mapping, setup.gate, setup.mirrored, setup.hands)
            session.post(commands.ChooseScene(setup.scene))
            session.post(commands.Configure(choices))
            for take in range(1, demonstrations + 1):
                say(f"the demonstrator teaches, {take} of {demonstrations}")
                session.post(commands.UseDemonstrator())
                session.post(commands.Record())
                _wait_for(loop, lambda now: now.mode is Mode.RECORDING)
                _wait_for(loop, lambda now: now.mode is not Mode.RECORDING)
            say("Baxter does it alone")
            session.post(commands.Train(setup.learner))
            _wait_for(loop, lambda now: now.lesson is not None)
            session.post(commands.PlayReproduction())
            _wait_for(loop, lambda now: now.reproduction is not None)
            yield


def _wait_for(loop: LiveLoop, reached: Callable[[Snapshot], bool]) -> None:
    while not reached(now := loop.session.snapshot):
        if now.message.is_error:
            raise StudioError(now.message.text)
        time.sleep(0.05)


def _announce(url: str, browser: bool) -> None:
    print(f"The teaching studio is at {url} (Ctrl-C ends it)", flush=True)
    # Without a display the standard library would open a text browser in this very terminal.
    if browser and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        webbrowser.open(url)
