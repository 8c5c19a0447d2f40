"""Faults of ours are logged: a line that cannot be sent to is closed, what is due goes on."""

import asyncio
import logging
from concurrent.futures import CancelledError, ThreadPoolExecutor
from types import SimpleNamespace

import pytest
from websockets.frames import CloseCode

from studio.engine.remote.server import RemoteServer
from studio.engine.seat import Seat


def test_a_fault_while_sending_closes_the_line_and_is_logged(
    caplog: pytest.LogCaptureFixture,
) -> None:
    closed: list[CloseCode] = []

    async def close(code: CloseCode, _: str) -> None:
        closed.append(code)

    async def tell(*_: object) -> None:
        raise ValueError("a number that is not finite")

    async def send() -> None:
        waiting = asyncio.Event()
        waiting.set()
        guest = SimpleNamespace(outbox=SimpleNamespace(next=lambda: "something"))
        connection = SimpleNamespace(close=close)
        await RemoteServer._send(SimpleNamespace(_tell=tell), connection, guest, waiting)

    # Of a thread of its own: this one may run a loop already, a browser's.
    with caplog.at_level(logging.ERROR), ThreadPoolExecutor(1) as other:
        other.submit(asyncio.run, send()).result()
    assert closed == [CloseCode.INTERNAL_ERROR]
    assert "cannot be sent" in caplog.text


def test_a_look_that_fails_is_logged_once_and_the_next_ones_follow(
    caplog: pytest.LogCaptureFixture, monkeypatch
) -> None:
    monkeypatch.setattr("studio.engine.remote.server._LOOK_EVERY", 0.0)
    looks: list[int] = []

    def look() -> None:
        looks.append(len(looks))
        if len(looks) == 5:
            raise asyncio.CancelledError  # the end
        raise OSError("the disk is gone")

    server = RemoteServer(SimpleNamespace(steps=None), Seat())
    server._reception = SimpleNamespace(look=look)
    with caplog.at_level(logging.ERROR), ThreadPoolExecutor(1) as other:
        ended = other.submit(asyncio.run, server._look()).exception()
    assert isinstance(ended, asyncio.CancelledError | CancelledError)
    assert len(looks) == 5
    (record,) = caplog.records
    assert "the disk is gone" in str(record.exc_info)
