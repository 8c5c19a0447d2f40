"""The one way in for publishers and programs: what is common to both; each has tests of its own."""

import asyncio
import threading

import pytest
from websockets.sync.client import connect

from studio.engine.errors import StudioError
from studio.engine.live.access import Address
from studio.engine.live.doorway import Doorway, House
from tests.engine.live.streaming import eventually

HOUSE = House("guests", "a chat", "--door", 2, 1000, 4, 5.0)
HERE = Address("127.0.0.1", 0)


async def greet(connection) -> None:
    await connection.send("hello")
    await connection.wait_closed()


def test_each_is_handed_on_and_counted() -> None:
    opened: list[Address] = []
    with Doorway(HOUSE, HERE, None, greet, opened.append) as door:
        assert opened == [door.address]
        with connect(door.address.url, proxy=None) as one, connect(door.address.url, proxy=None):
            assert one.recv(timeout=10.0) == "hello"
            eventually(lambda: door.connected == 2)
    assert not any(thread.name == "guests" for thread in threading.enumerate())


def test_something_runs_beside_it_for_as_long() -> None:
    beats, ended = [], threading.Event()

    async def beat() -> None:
        try:
            while True:
                beats.append(1)
                await asyncio.sleep(0.001)
        finally:
            ended.set()

    with Doorway(HOUSE, HERE, None, greet, lambda _: None, beside=beat) as door:
        done = threading.Event()
        door.later(done.set)
        assert done.wait(10.0)
    assert beats
    assert ended.is_set()
    door.later(beats.clear)  # too late: never, and nobody is hurt
    assert beats


def test_its_words_name_the_option() -> None:
    with pytest.raises(StudioError, match=r"--door 0\.0\.0\.0:0: beyond this machine a token"):
        Doorway(HOUSE, Address("0.0.0.0", 0), None, greet, lambda _: None)
    with Doorway(HOUSE, HERE, None, greet, lambda _: None) as door:
        taken = Doorway(HOUSE, door.address, None, greet, lambda _: None)
        with pytest.raises(StudioError, match=r"listen for a chat at .*--door 127.0.0.1:0"), taken:
            pass
