"""Connections that never say what they want: bounded, and told in words where the system ends."""

import contextlib
import errno
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from studio.engine import clock
from studio.engine.live import handshakes
from studio.engine.live.access import Address
from studio.engine.live.handshakes import Handshakes
from studio.engine.live.listener import MOST_CONNECTIONS, Listener
from studio.engine.live.source import LiveSource
from tests.engine.live.streaming import answers, eventually, publisher

ROOT = Path(__file__).resolve().parents[3]


@contextmanager
def half_open(address: Address, count: int) -> Iterator[list[socket.socket]]:
    """So many connections, each of which begins its request and never ends it."""
    with contextlib.ExitStack() as stack:
        opened = []
        for _ in range(count):
            each = socket.create_connection((address.host, address.port), timeout=5.0)
            opened.append(stack.enter_context(each))
            with contextlib.suppress(OSError):
                each.send(b"GET / HTTP/1.1\r\nHost: x\r\n")
        yield opened


def is_open(connection: socket.socket) -> bool:
    connection.setblocking(False)
    try:
        return connection.recv(1, socket.MSG_PEEK) != b""
    except BlockingIOError:
        return True
    except OSError:
        return False


def test_the_oldest_go_and_publishers_come_in(monkeypatch) -> None:
    monkeypatch.setattr(handshakes, "MOST_PENDING", 32)
    live = LiveSource(clock.now)
    with contextlib.ExitStack() as stack:
        listener = stack.enter_context(Listener(live, Address("127.0.0.1", 0)))
        first = stack.enter_context(publisher(listener.address.url))
        assert answers(first)[0]["status"] == "ready"
        crowd = stack.enter_context(half_open(listener.address, 100))
        eventually(lambda: sum(map(is_open, crowd)) <= 32)
        assert is_open(crowd[-1])
        assert not is_open(crowd[0])
        for _ in range(MOST_CONNECTIONS - 1):
            late = stack.enter_context(publisher(listener.address.url))
            assert answers(late)[0]["status"] == "ready"
        first.ping().wait(5.0)  # was never one of the pending
        assert live.status().publishers == MOST_CONNECTIONS


LISTENING = """
import asyncio, resource
from studio.engine import clock
from studio.engine.live.access import Address
from studio.engine.live.listener import Listener
from studio.engine.live.source import LiveSource
asyncio.constants.ACCEPT_RETRY_DELAY = 0.2  # of a second, which asyncio waits otherwise
resource.setrlimit(resource.RLIMIT_NOFILE, (32, 32))
with Listener(LiveSource(clock.now), Address("127.0.0.1", 0)) as listener:
    print(listener.address.port, flush=True)
    input()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of open files to set")
def test_a_system_without_more_files_is_told_once_and_got_over() -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", LISTENING],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    try:
        address = Address("127.0.0.1", int(process.stdout.readline()))
        with half_open(address, 60):
            time.sleep(0.5)  # it is tried a second time
        with publisher(address.url) as sensor:  # as soon as files are free again
            assert answers(sensor)[0]["status"] == "ready"
        _, said = process.communicate("\n", timeout=20.0)
    finally:
        process.kill()
    assert process.returncode == 0
    assert said.count("no open files left for another connection") == 1
    assert "Traceback" not in said
    assert len(said.splitlines()) == 1


def test_other_faults_are_told_as_they_are() -> None:
    told = []

    class Loop:
        default_exception_handler = told.append

    pending = Handshakes()
    contexts = [{"exception": ValueError()}, {"exception": OSError(errno.EPIPE, "")}, {}]
    for context in contexts:
        pending._handle(Loop, context)
    assert told == contexts
