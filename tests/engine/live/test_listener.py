"""On real sockets: who is let in, what is answered, what no publisher can do."""

import contextlib
import logging
import re
import socket
import threading
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from websockets.exceptions import ConnectionClosed, InvalidStatus

from studio.engine import clock
from studio.engine.errors import StudioError
from studio.engine.live.access import Address
from studio.engine.live.listener import MOST_CONNECTIONS, Listener
from studio.engine.live.reception import ANSWER_EVERY, LARGEST_MESSAGE
from studio.engine.live.source import LiveSource
from tests.engine.corruption import corrupted
from tests.engine.live.streaming import answers, demonstrated, eventually, message, publisher

FRAMES = demonstrated()
ANY_PORT = Address("127.0.0.1", 0)


@pytest.fixture
def live() -> LiveSource:
    return LiveSource(clock.now)


@pytest.fixture
def listener(live: LiveSource):
    with Listener(live, ANY_PORT) as listening:
        yield listening


@pytest.fixture(autouse=True)
def _nothing_fails_unseen(caplog):
    yield
    assert [record for record in caplog.records if record.levelno >= logging.ERROR] == []


def test_frames_come_in_and_the_publisher_is_told(listener: Listener, live: LiveSource) -> None:
    with publisher(listener.address.url) as sensor:
        for frame in FRAMES[:3]:
            sensor.send(message(frame))
        assert [answer["status"] for answer in answers(sensor, 2)] == ["ready", "driving"]
        assert live.take().skeleton.time == FRAMES[2].time
        now = live.status()
        assert (now.publishers, now.protocol, now.address) == (
            1,
            "studio jsonl",
            listener.address.url,
        )
    eventually(lambda: live.status().publishers == 0)
    assert live.status().driver == ""


def test_bytes_are_taken_like_text(listener: Listener, live: LiveSource) -> None:
    with publisher(listener.address.url) as sensor:
        sensor.send(message(FRAMES[0]).encode())
        eventually(lambda: live.status().driver != "")


def test_garbage_is_answered_in_words(listener: Listener, live: LiveSource) -> None:
    begun = time.monotonic()
    with publisher(listener.address.url) as sensor:
        for garbage in ("hello", b"\x00\xff", "[1, 2]"):
            sensor.send(garbage)
        eventually(lambda: live.status().counts.unreadable == 3)
        took = time.monotonic() - begun
        told = [answer["error"] for answer in answers(sensor, 2)[1:]]
        assert 1 <= len(told) <= 1 + took / ANSWER_EVERY
        assert "line 1, column 1" in told[0]
        sensor.send(message(FRAMES[0]))
        assert answers(sensor)[-1]["status"] == "driving"


@pytest.mark.parametrize("text", ["x" * (LARGEST_MESSAGE + 1), b"y" * (4 * LARGEST_MESSAGE)])
def test_too_large_a_message_ends_the_connection(listener, live, text) -> None:
    with publisher(listener.address.url) as sensor:
        sensor.send(text)
        sensor.recv(timeout=5.0)  # the greeting
        with pytest.raises(ConnectionClosed) as closed:
            sensor.recv(timeout=5.0)
        assert closed.value.rcvd.code == 1009
        assert str(LARGEST_MESSAGE) in closed.value.rcvd.reason
    eventually(lambda: live.status().counts.unreadable == 1)
    with publisher(listener.address.url) as sensor:
        assert answers(sensor)[0]["status"] == "ready"


def test_connections_are_counted(listener: Listener, live: LiveSource) -> None:
    opened = [publisher(listener.address.url) for _ in range(MOST_CONNECTIONS)]
    try:
        for each in opened:
            each.__enter__()
        with pytest.raises(InvalidStatus) as refused, publisher(listener.address.url):
            pass
        assert refused.value.response.status_code == 503
        assert b"8 publishers" in refused.value.response.body
    finally:
        for each in opened:
            each.__exit__(None, None, None)
    eventually(lambda: live.status().publishers == 0)
    with publisher(listener.address.url) as sensor:
        assert answers(sensor)[0]["status"] == "ready"


def test_two_publishers_take_turns(listener: Listener, live: LiveSource) -> None:
    url = listener.address.url
    with publisher(url) as second:
        with publisher(url) as first:
            first.send(message(FRAMES[0]))
            assert answers(first, 2)[-1]["status"] == "driving"
            second.send(message(FRAMES[0], "node-kinect2"))
            assert [answer["status"] for answer in answers(second, 2)] == ["ready", "waiting"]
            assert live.status().counts.waiting == 1
        eventually(lambda: live.status().driver == "")
        second.send(message(FRAMES[1], "node-kinect2"))
        assert answers(second)[-1] == {"status": "driving", "protocol": "node-kinect2"}
    with publisher(url) as third:
        assert answers(third)[0]["status"] == "ready"


def test_a_token_is_asked_for(live: LiveSource) -> None:
    with Listener(live, ANY_PORT, token="open sesame") as listener:
        url = listener.address.url
        for wrong in (url, f"{url}/?token=open", f"{url}/?token="):
            with pytest.raises(InvalidStatus) as refused, publisher(wrong):
                pass
            assert refused.value.response.status_code == 401
            assert b"token" in refused.value.response.body
        headers = {"Authorization": "Bearer open sesame"}
        for right, options in (
            (f"{url}/?token=open%20sesame", {}),
            (url, {"additional_headers": headers}),
            (url, {"additional_headers": headers, "origin": "https://example.org"}),
        ):
            with publisher(right, **options) as sensor:
                assert answers(sensor)[0]["status"] == "ready"


@pytest.mark.parametrize("origin", ["https://example.org", "null"])
def test_other_sites_pages_are_kept_out(listener: Listener, origin: str) -> None:
    with pytest.raises(InvalidStatus) as refused, publisher(listener.address.url, origin=origin):
        pass
    assert refused.value.response.status_code == 403
    with publisher(listener.address.url, origin="http://localhost:3000") as page:
        assert answers(page)[0]["status"] == "ready"


def test_beyond_this_machine_nothing_is_listened_to_without_a_token(live: LiveSource) -> None:
    for host in ("0.0.0.0", "::", "192.0.2.1"):
        with pytest.raises(StudioError, match="--token"):
            Listener(live, Address(host, 0))


def test_a_taken_port_is_said_or_passed_over(listener: Listener, live: LiveSource) -> None:
    with pytest.raises(StudioError, match="--listen"), Listener(live, listener.address):
        pass
    with Listener(live, listener.address, next_free=True) as other:
        assert other.address.port > listener.address.port


@pytest.mark.skipif(not socket.has_ipv6, reason="no IPv6 here")
def test_an_address_of_ipv6_is_listened_at(live: LiveSource) -> None:
    with Listener(live, Address.parse("[::1]:0")) as listener:
        assert re.fullmatch(r"ws://\[::1\]:[1-9]\d+", listener.address.url)
        with publisher(listener.address.url) as sensor:
            assert answers(sensor)[0]["status"] == "ready"


def test_an_address_that_is_not_ours_is_said(live: LiveSource) -> None:
    with (
        pytest.raises(StudioError, match="cannot listen"),
        Listener(live, Address("192.0.2.1", 0), token="open sesame"),
    ):
        pass


def test_it_ends_with_publishers_connected(live: LiveSource) -> None:
    before = threading.enumerate()  # another test's listener may be among them
    with Listener(live, ANY_PORT) as listener:
        sensor = publisher(listener.address.url)
        connection = sensor.__enter__()
        connection.send(message(FRAMES[0]))
        eventually(lambda: live.status().driver != "")
    sensor.__exit__(None, None, None)
    since = [thread for thread in threading.enumerate() if thread not in before]
    assert not any(thread.name == "listener" for thread in since)
    assert live.status().driver == ""


def test_a_flood_is_survived(listener: Listener, live: LiveSource) -> None:
    """As fast as it goes; where this machine is quick enough, the publisher is sent away."""
    with contextlib.suppress(ConnectionClosed), publisher(listener.address.url) as sensor:
        for _ in range(30_000):
            sensor.send("x")
        # Much of it may wait in the system still, and would be lost if this end hung up first.
        eventually(lambda: live.status().counts.too_fast > 1000, seconds=30.0)
    assert live.status().counts.too_fast > 1000
    with publisher(listener.address.url) as sensor:
        sensor.send(message(FRAMES[0]))
        assert answers(sensor, 2)[-1]["status"] == "driving"


@settings(deadline=None, derandomize=True, max_examples=20)
@given(raw=st.lists(st.binary(min_size=1, max_size=300), min_size=1, max_size=5))
def test_bytes_that_are_no_websocket_are_survived(live_listener, raw: list[bytes]) -> None:
    """Before and after the handshake."""
    listener, live = live_listener
    host, port = listener.address.host, listener.address.port
    with socket.create_connection((host, port), timeout=5.0) as plain:
        for part in raw:
            try:
                plain.sendall(part)
            except OSError:
                break
    with publisher(listener.address.url) as sensor:
        for part in raw:
            try:
                sensor.socket.sendall(part)
            except OSError:
                break
        with contextlib.suppress(OSError):  # the client may have closed it already
            sensor.socket.shutdown(socket.SHUT_RDWR)
    eventually(lambda: live.status().publishers == 0)


def test_damaged_messages_are_survived(listener: Listener, live: LiveSource) -> None:
    """A small share of what the bench sends."""
    rng = np.random.default_rng(4)
    whole = [message(FRAMES[30], kind).encode() for kind in ("jsonl", "node-kinect2", "kinectron")]
    with publisher(listener.address.url) as sensor:
        for n in range(150):
            sensor.send(corrupted(whole[n % 3], rng))
        eventually(lambda: live.status().counts.received == 150, seconds=30.0)
        assert live.status().counts.unreadable > 5
        assert "error" in answers(sensor, 2)[1]


@pytest.fixture(scope="module")
def live_listener():
    live = LiveSource(clock.now)
    with Listener(live, ANY_PORT) as listener:
        yield listener, live
        with publisher(listener.address.url) as sensor:
            sensor.send(message(FRAMES[0]))
            assert answers(sensor, 2)[-1]["status"] == "driving"


def test_who_never_reads_holds_up_only_itself(listener: Listener, live: LiveSource) -> None:
    """A hundred complaints are not sent where one a second is; the driver goes on being read."""
    begun = time.monotonic()
    with publisher(listener.address.url) as deaf:
        for n in range(100):
            deaf.send(message(FRAMES[n % 2], "jsonl"))
            time.sleep(0.002)
        eventually(lambda: live.status().counts.received == 100, seconds=30.0)
        took = time.monotonic() - begun
        # Ready, driving, the first complaint, and one more a second.
        assert len(answers(deaf, 3)) <= 3 + took / ANSWER_EVERY
    assert live.status().counts.late > 0
