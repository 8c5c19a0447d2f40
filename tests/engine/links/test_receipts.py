"""Receipts are for all before them, come in order, and what waits too long is never sent."""

import socket
from collections import deque
from collections.abc import Callable

import pytest

from studio.engine.links.driver import STALE
from studio.engine.links.receipts import Receipts
from tests.engine.live.streaming import Clock


class Wire:
    """A connection of roslibpy's and its loop, which has a turn where the test says so."""

    def __init__(self) -> None:
        self.factory = self.transport = self.loop = self
        self.ready: deque[tuple[Callable[..., None], tuple[object, ...]]] = deque()
        self.left: list[str] = []
        self.options: list[tuple[int, int, object]] = []
        self.onPong: Callable[[bytes], None]

    def get_extra_info(self, name: str) -> "Wire":
        assert name == "socket"
        return self

    def setsockopt(self, *option) -> None:
        self.options.append(option)

    def call_soon_threadsafe(self, function, *given) -> None:
        self.ready.append((function, given))

    call_soon = call_soon_threadsafe

    def sendPing(self, number: bytes) -> None:  # noqa: N802 - the library's name
        self.left.append(f"ping {number.decode()}")

    def abort(self) -> None:
        self.left.append("aborted")

    def turn(self) -> None:
        while self.ready:
            function, given = self.ready.popleft()
            function(*given)


@pytest.fixture
def wire() -> Wire:
    return Wire()


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def receipts(wire: Wire, clock: Clock) -> Receipts:
    return Receipts(wire, clock)


def test_a_ping_follows_what_is_sent(wire: Wire, receipts: Receipts) -> None:
    # A library that itself puts what it is given behind all else: roslibpy does.
    receipts.send(lambda: wire.call_soon(lambda: wire.left.append("command")))
    assert receipts.is_waiting
    wire.turn()
    assert wire.left == ["command", "ping 1"]
    wire.onPong(b"1")
    assert not receipts.is_waiting
    assert receipts.come()


def test_a_receipt_is_for_all_before_it_and_no_more(wire: Wire, receipts: Receipts) -> None:
    for _ in range(3):
        receipts.send(lambda: None)
    wire.turn()
    wire.onPong(b"another's")
    wire.onPong(b"2")
    assert receipts.is_waiting
    wire.onPong(b"1")  # nothing is left of it
    wire.onPong(b"3")
    assert not receipts.is_waiting


def test_what_is_not_read_in_time_is_late(wire: Wire, receipts: Receipts, clock: Clock) -> None:
    receipts.send(lambda: None)
    wire.turn()
    clock.time += STALE - 0.01
    receipts.send(lambda: None)
    assert not receipts.is_late
    clock.time += 0.02  # the first
    assert receipts.is_late
    assert not receipts.come()


def test_what_its_thread_could_not_send_in_time_never_leaves(wire, receipts, clock: Clock) -> None:
    receipts.send(lambda: wire.left.append("command"))
    clock.time += STALE + 0.01
    wire.turn()
    assert wire.left == []
    assert receipts.is_late


def test_the_end_is_on_the_network_s_thread(wire: Wire, receipts: Receipts) -> None:
    receipts.abort()
    assert wire.left == []
    wire.turn()
    assert wire.left == ["aborted"]


def test_the_system_is_told_to_forget(wire: Wire, receipts: Receipts) -> None:

    options = {option: value for _, option, value in wire.options}
    assert options[socket.SO_LINGER].strip(b"\0") == b"\1"
    if hasattr(socket, "TCP_USER_TIMEOUT"):
        assert options[socket.TCP_USER_TIMEOUT] == round(1000 * STALE)
