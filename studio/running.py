"""The engine with all that reaches it but the page: live streams in, programs on a WebSocket."""

import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

from studio.engine import commands
from studio.engine.clock import LiveLoop, now
from studio.engine.links.address import link_at
from studio.engine.links.linked import Linked
from studio.engine.live.access import Address
from studio.engine.live.listener import Listener
from studio.engine.live.source import LiveSource
from studio.engine.remote.server import RemoteServer
from studio.engine.resources import samples_folder
from studio.engine.seat import Seat
from studio.engine.session import Session
from studio.engine.work import Work
from studio.heap import share_heaps


@dataclass(frozen=True)
class Doors:
    """Where the studio can be reached, beside its page."""

    streams: Address | None = None  # None: on this machine, at the first free port from the usual
    remote: Address | None = None  # None: programs are not let in
    token: str | None = None
    robot: str | None = None  # the address of one that goes along


@dataclass(frozen=True, eq=False)
class Running:
    """What a page needs of an engine that runs."""

    loop: LiveLoop
    seat: Seat  # who controls: a browser or a program


@contextmanager
def running(recordings: Path, doors: Doors) -> Iterator[Running]:
    """Run the engine with the samples loaded, and print where it can be reached.

    Raises
    ------
    StudioError
        Where it can't be reached at an address that was asked for.
    """
    share_heaps()
    live, seat = LiveSource(now), Seat()
    if doors.robot is not None:
        link_at(doors.robot, now)  # a wrong address is told before anything runs
    listener = Listener(
        live, doors.streams or Address(), doors.token, next_free=doors.streams is None
    )

    def build() -> Session:
        return Session(recordings, live=live, work=Work(now), linked=Linked(now))

    with ExitStack() as stack:
        stack.enter_context(listener)
        loop = stack.enter_context(LiveLoop(build))
        for sample in sorted(samples_folder().glob("*.mcap")):
            loop.session.post(commands.UseFile(sample))
        print(f"Live streams are taken at {listener.address.url}", flush=True)
        if doors.robot is not None:  # before a program can take the clock
            loop.session.post(commands.ConnectLink(doors.robot))
        if doors.remote is not None:
            server = RemoteServer(loop, seat, doors.remote, doors.token)
            stack.enter_context(server)
            print(f"Programs are let in at {server.address.url}", flush=True)
        yield Running(loop, seat)


def serve_programs(recordings: Path, doors: Doors) -> None:
    """Serve programs alone, without a page, until interrupted; see `running`."""
    with running(recordings, doors):
        serve_until_interrupted()


def serve_until_interrupted() -> None:
    """Wait for Ctrl-C, which is how a server ends, while the other threads serve."""
    try:
        while True:
            time.sleep(3600.0)
    except KeyboardInterrupt:
        say("closing")


def say(text: str) -> None:
    """Tell the user what goes on, on standard error."""
    print(f"studio: {text}", file=sys.stderr, flush=True)
