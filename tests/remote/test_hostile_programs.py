"""Programs that send garbage, too much, or read nothing: told in words, then sent away."""

import json
import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from studio.engine.remote.guest import MOST_UNREADABLE
from studio.engine.remote.reading import LARGEST_MESSAGE
from studio.engine.remote.server import MOST_PROGRAMS
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.snapshot import Mode
from studio.remote import RefusedError, commands
from tests.remote.house import PATIENCE, House, eventually, goes_on, open_house

GARBAGE = [
    "",
    "nonsense",
    "[]",
    "42",
    "{}",
    '{"type": "rumor"}',
    '{"type": "do", "id": 7, "command": {"type": "choose", "number": "three"}}',
    '{"type": "do", "id": 7, "command": {"type": "scrub", "position": NaN}}',
    '{"type": "do", "id": 7, "command": {"type": "scrub", "position": 1e999}}',
    '{"type": "subscribe", "id": 7, "stream": "gate", "rate": 1000}',
    '{"type": "set_joint_target", "targets": {"left_s0": "far"}}',
    '{"type": "do", "id": 7, "command": {"type": "record", "surprise": 1}}',
    '{"type": "step", "id": 7, "ticks": 1000000}',
    '{"type": "upload", "id": 7, "content": "%%%"}',
    '{"a":' * 5000,
    "[" * 100_000,
]
BINARY = b"\x00\xff"


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    with open_house(tmp_path_factory.mktemp("house")) as opened:
        opened.overheard.garbage |= {*GARBAGE, str(BINARY)}
        yield opened


@pytest.fixture(autouse=True)
def the_studio_goes_on(house: House) -> Iterator[None]:
    yield
    eventually(lambda: house.seat.present == 0)
    assert goes_on(house)
    assert house.now.mode is Mode.IDLE
    with house.connect() as studio:
        assert studio.snapshot().mode == "idle"


@contextmanager
def line(house: House, **options) -> Iterator[ClientConnection]:
    with connect(house.url, compression=None, proxy=None, close_timeout=1.0, **options) as opened:
        assert json.loads(opened.recv(timeout=PATIENCE))["type"] == "welcome"
        yield opened


def drain(opened: ClientConnection) -> None:
    while True:
        opened.recv(timeout=PATIENCE)


def heard(opened: ClientConnection, kind: str) -> dict:
    while (message := json.loads(opened.recv(timeout=PATIENCE)))["type"] != kind:
        pass
    return message


@pytest.mark.parametrize("garbage", GARBAGE, ids=range(len(GARBAGE)))
def test_garbage_is_answered_in_words_and_the_line_stays(house: House, garbage: str) -> None:
    with line(house) as opened:
        opened.send(garbage)
        error = heard(opened, "error")
        assert len(error["words"]) > 20
        if '"id": 7' in garbage and "999" not in garbage and "NaN" not in garbage:
            assert error["id"] == 7
            assert error["place"].startswith("$.")
        opened.send('{"type": "get", "id": 8, "what": "gate"}')
        assert heard(opened, "gate")["id"] == 8


def test_the_place_of_an_error_is_named(house: House) -> None:
    with line(house) as opened:
        opened.send(GARBAGE[6])
        error = heard(opened, "error")
    assert error["place"] == "$.command.number"
    assert "Expected `int`, got `str`" in error["words"]
    assert "docs/remote.md" in error["words"]


def test_binary_and_nothing_but_garbage_is_sent_away(house: House) -> None:
    with line(house) as opened:
        with suppress(ConnectionClosed):
            for _ in range(10 * MOST_UNREADABLE):
                opened.send(BINARY)
        with pytest.raises(ConnectionClosed, match="cannot be read"):
            drain(opened)


def test_a_message_that_is_too_large_closes_the_line(house: House) -> None:
    with line(house) as opened:
        with suppress(ConnectionClosed):
            opened.send(" " * (LARGEST_MESSAGE + 1))
        with pytest.raises(ConnectionClosed, match="1009"):
            drain(opened)


@dataclass(frozen=True)
class Second:
    """A second of the session's time, in which a program sends joint targets now and then."""

    cost: float  # [s] that the engine works at a tick, whoever else is busy
    ticks: int  # that were made
    skipped: int  # that were given up
    rounds: int  # of sending, and then waiting for a hundredth of a second


def second_of(house: House, opened: ClientConnection, burst: int) -> Second:
    clock = time.pthread_getcpuclockid(house.loop._thread.ident)
    before, begun = time.clock_gettime(clock), house.now.world.time
    skipped, rounds = house.loop.pace.skipped, 0
    while house.now.world.time < begun + 1.0:
        for k in range(burst):
            target = {"type": "set_joint_target", "targets": {"left_s0": 0.2 * (k % 2)}}
            opened.send(json.dumps(target))
        rounds += 1
        assert rounds < 10_000, "ticks have ceased"
        time.sleep(0.01)
    ticks = round((house.now.world.time - begun) / CONTROL_PERIOD)
    cost = (time.clock_gettime(clock) - before) / ticks
    return Second(cost, ticks, house.loop.pace.skipped - skipped, rounds)


@pytest.mark.skipif(
    not hasattr(time, "pthread_getcpuclockid"), reason="Linux tells a thread's work"
)
def test_a_flood_of_targets_costs_no_tick_and_leaves_no_queue(house: House) -> None:
    with line(house) as opened:
        for command in ("put_block_back", "begin_driving"):
            opened.send(json.dumps({"type": "do", "id": 1, "command": {"type": command}}))
            heard(opened, "done")
        calm = second_of(house, opened, burst=1)
        assert house.now.mode is Mode.DRIVEN
        flooded = second_of(house, opened, burst=20)
        assert 20 * flooded.rounds > 5 * calm.rounds  # so many targets
        assert flooded.cost < 2 * calm.cost + 1e-3
        # Ticks went on: no more are given up than are made, and none comes later than that much.
        assert flooded.skipped <= calm.skipped + flooded.ticks
        assert flooded.rounds <= 2 * calm.rounds + 20
        opened.send('{"type": "set_joint_target", "targets": {"left_s0": -0.1}}')
        opened.send('{"type": "do", "id": 2, "command": {"type": "stop"}}')
        assert heard(opened, "done")["id"] == 2  # behind no queue


def test_a_flood_of_ten_times_that_is_sent_away(house: House) -> None:
    with line(house) as opened:
        with suppress(ConnectionClosed):
            while True:
                opened.send('{"type": "set_joint_target", "targets": {"left_s0": 0.1}}')
        with pytest.raises(ConnectionClosed, match=r"too fast|no close frame"):
            drain(opened)


def test_a_flood_of_requests_is_refused_then_sent_away(house: House) -> None:
    with line(house) as opened:
        with suppress(ConnectionClosed):
            for number in range(100_000):
                opened.send(json.dumps({"type": "get", "id": number, "what": "gate"}))
        # Who does not read while it sends may miss the words: "too fast", or "does not read".
        with pytest.raises(ConnectionClosed):
            drain(opened)


def test_commands_that_wait_are_bounded(house: House) -> None:
    with line(house) as opened:
        for number in range(100):
            opened.send(
                json.dumps({"type": "do", "id": number, "command": {"type": "forget_kept"}})
            )
        answers = []
        while len(answers) < 100:
            answer = json.loads(opened.recv(timeout=PATIENCE))
            answers += [answer] if answer["type"] != "role" else []
    assert sorted(answer["id"] for answer in answers) == list(range(100))
    refused = [answer["words"] for answer in answers if answer["type"] == "error"]
    assert len(refused) <= 68
    assert all("wait for a tick" in words for words in refused)


def test_who_reads_nothing_is_sent_away(house: House, monkeypatch) -> None:
    monkeypatch.setattr("studio.engine.remote.server._SEND_WITHIN", 0.2)
    with socket.create_connection((house.server.address.host, house.server.address.port)) as bare:
        bare.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        bare.sendall(
            b"GET / HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
        )
        ask = b'{"type": "get", "id": 1, "what": "snapshot"}'
        frame = b"\x81" + bytes([0x80 | len(ask)]) + bytes(4) + ask
        eventually(lambda: house.seat.present == 1)
        with suppress(OSError):
            while house.seat.present:
                bare.sendall(frame)
                time.sleep(0.0005)
        eventually(lambda: house.seat.present == 0)


def test_pages_of_other_sites_are_turned_away(house: House) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        connect(house.url, origin="https://evil.example", proxy=None)
    with line(house, origin="http://localhost:8080") as opened:
        opened.send('{"type": "get", "id": 8, "what": "gate"}')
        assert heard(opened, "gate")["id"] == 8


def test_more_programs_than_are_let_in(house: House) -> None:
    with ExitStack() as stack:
        for _ in range(MOST_PROGRAMS):
            stack.enter_context(line(house))
        with pytest.raises(InvalidStatus, match="503"):
            connect(house.url, proxy=None)


def test_one_controls_at_a_time_the_others_read(house: House) -> None:
    with house.connect() as first, house.connect() as second:
        assert first.control("ask").controls
        assert not second.control("ask").controls
        with pytest.raises(
            RefusedError, match=r"a program at 127\.0\.0\.1 controls Baxter: ask for"
        ):
            second.do(commands.Record())
        with pytest.raises(RefusedError, match="controls Baxter"), second.clock():
            pass
        assert second.snapshot().mode == "idle"
        eventually(lambda: first.control().asking == "a program at 127.0.0.1")
        first.control("hand_over")
        assert second.control().controls
        second.do(commands.PutBlockBack())
        with second.clock():
            second.control("let_go")
            assert first.control("ask").controls
            eventually(lambda: goes_on(house))  # whoever loses control loses the clock
