"""The studio with its browser: the engine's live loop, and the panels hung on it."""

import os
import sys
import tempfile
import time
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.clock import LiveLoop, now
from studio.engine.errors import StudioError
from studio.engine.experiment import Setup
from studio.engine.live.access import Address
from studio.engine.live.listener import Listener
from studio.engine.live.source import LiveSource
from studio.engine.resources import samples_folder
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.work import Work
from studio.panels.app import App


@dataclass(frozen=True)
class Streams:
    """Where live streams are taken."""

    address: Address | None = None  # None: on this machine, at the first free port from the usual
    token: str | None = None


def serve_studio(host: str, port: int, recordings: Path, browser: bool, streams: Streams) -> None:
    """Serve the studio with the samples loaded until interrupted.

    Raises
    ------
    StudioError
        Where live streams can't be taken at the address asked for.
    """
    live = LiveSource(now)
    listener = Listener(
        live, streams.address or Address(), streams.token, next_free=streams.address is None
    )
    with (
        listener,
        LiveLoop(lambda: Session(recordings, live=live, work=Work(now))) as loop,
        App(loop, host, port) as app,
    ):
        for sample in sorted(samples_folder().glob("*.mcap")):
            loop.session.post(commands.UseFile(sample))
        print(f"Live streams are taken at {listener.address.url}", flush=True)
        _announce(app.url, browser)
        serve_until_interrupted()


def serve_until_interrupted() -> None:
    """Wait for Ctrl-C, which is how a server ends, while the other threads serve."""
    try:
        while True:
            time.sleep(3600.0)
    except KeyboardInterrupt:
        _say("closing")


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
            session.post(commands.Configure(choices))
            for take in range(1, demonstrations + 1):
                _say(f"the demonstrator teaches, {take} of {demonstrations}")
                session.post(commands.UseDemonstrator())
                session.post(commands.Record())
                _wait_for(loop, lambda now: now.mode is Mode.RECORDING)
                _wait_for(loop, lambda now: now.mode is not Mode.RECORDING)
            _say("Baxter does it alone")
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


def _say(text: str) -> None:
    print(f"studio: {text}", file=sys.stderr, flush=True)
