"""What the tests of live streams share: frames, a clock to turn by hand, and a publisher."""

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from websockets.sync.client import ClientConnection, connect

from studio.engine.commands import Command
from studio.engine.live.access import Address
from studio.engine.live.listener import Listener
from studio.engine.live.player import encoder, schedule
from studio.engine.live.source import LiveSource
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.session import Session
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Snapshot
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.family import Frame
from tests.engine.people import held, person


class Clock:
    """Time that passes when told to."""

    def __init__(self) -> None:
        self.time = 100.0

    def __call__(self) -> float:
        return self.time


def demonstrated(take: int = 1) -> list[Frame]:
    """The demonstrator's frames, from time 0 on."""
    stream = demonstrate(0, take)
    seen = [Frame(time, (body,) if body else ()) for time, body in stream.by_frame()]
    return list(schedule(seen))


def message(frame: Frame, kind: str = "jsonl") -> str:
    return encoder(kind)(frame)


@contextmanager
def publisher(url: str, **options) -> Iterator[ClientConnection]:
    with connect(url, compression=None, proxy=None, close_timeout=1.0, **options) as connection:
        yield connection


def answers(connection: ClientConnection, least: int = 1) -> list[dict]:
    """All that a publisher is told until nothing comes for a while, but so many are awaited."""
    heard: list[dict] = []
    while True:
        try:
            # However busy this machine is, what has to come is not missed.
            patience = 20.0 if len(heard) < least else 0.2
            heard.append(json.loads(connection.recv(timeout=patience)))
        except TimeoutError:
            return heard


def eventually(reached: Callable[[], bool], seconds: float = 30.0) -> None:
    deadline = time.monotonic() + seconds
    while not reached():
        assert time.monotonic() < deadline, "it never came to that"
        time.sleep(0.005)


class LiveStudio:
    """A session and its listener, whose time passes tick by tick, with or without a frame."""

    def __init__(self, recordings: Path) -> None:
        self.clock = Clock()
        self.live = LiveSource(self.clock)
        self.listener = Listener(self.live, Address("127.0.0.1", 0))
        self.session = Session(recordings, live=self.live)

    def __enter__(self) -> "LiveStudio":
        self.listener.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        self.listener.__exit__(None, None, None)
        self.session.close()

    @property
    def url(self) -> str:
        return self.listener.address.url

    def do(self, *orders: Command) -> Snapshot:
        for order in orders:
            self.session.post(order)
        return self.wait()

    def send(self, sensor: ClientConnection, *messages: str | bytes) -> None:
        """Send, and wait until all of it has come in."""
        before = self.live.status().counts.received
        for text in messages:
            sensor.send(text)
        eventually(lambda: self.live.status().counts.received == before + len(messages))

    def show(self, sensor: ClientConnection, *messages: str | bytes) -> Snapshot:
        """Let a tick pass in which these messages came in."""
        self.send(sensor, *messages)
        return self.wait()

    def wait(self, ticks: int = 1) -> Snapshot:
        """Let ticks pass without a frame."""
        for _ in range(ticks):
            self.clock.time += CONTROL_PERIOD
            self.session.tick()
        return self.session.snapshot

    def arm(self, sensor: ClientConnection, kind: str = "jsonl", start: float = 0.0) -> Snapshot:
        """Watch, and sign Lasso, Open, Closed."""
        for number, state in enumerate(SIGNS):
            self.show(sensor, signing(start + number / 30, state, kind))
        return self.session.snapshot


SIGNS = held((HandState.LASSO, 14), (HandState.OPEN, 14), (HandState.CLOSED, 14))


def signing(time: float, state: HandState, kind: str = "jsonl", body_id: str = "7") -> str:
    """The message of somebody who shows a sign."""
    return message(Frame(time, (person(time, hand=state, body_id=body_id),)), kind)
