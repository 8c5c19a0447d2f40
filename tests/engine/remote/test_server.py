"""What becomes of a line on which something cannot be sent: it is closed, in words, and logged."""

import asyncio
import logging
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import pytest
from websockets.frames import CloseCode

from studio.engine.remote.server import RemoteServer


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
