"""What the other side of a WebSocket has read of what was sent to it.

Between a command and who reads it lie three buffers: the WebSocket library's, this system's and
the other system's. None tells when it is read, and each would deliver what is old once somebody
reads again. So every message is followed by a ping, which WebSockets answer in order (RFC 6455,
5.5.2): its answer is the receipt of all before it.
"""

import socket
import struct
import sys
import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from studio.engine.links.driver import STALE

_LOOKS = 0.005  # [s] between two looks at the clock, at the end
_LINGER = struct.pack("hh" if sys.platform == "win32" else "ii", 1, 0)


class Receipts:
    """See the module.

    Parameters
    ----------
    protocol
        An open connection of roslibpy's on asyncio; whatever ends it, nothing of it is delivered
        later that had not left.
    now
        Any clock [s].
    """

    def __init__(self, protocol: Any, now: Callable[[], float]) -> None:
        self._protocol, self._loop, self._now = protocol, protocol.factory.loop, now
        self._lock, self._heard = threading.Lock(), threading.Event()
        self._asked: deque[tuple[bytes, float]] = deque()  # which, and when [s] it was sent
        self._count = 0
        protocol.onPong = self._hear
        _forget_what_waits(protocol.transport.get_extra_info("socket"))

    @property
    def is_waiting(self) -> bool:
        """Whether anything that was sent is not known to be read."""
        return bool(self._asked)

    @property
    def is_late(self) -> bool:
        """Whether anything should have been read by now, and is not known to be."""
        with self._lock:
            return bool(self._asked) and self._now() - self._asked[0][1] > STALE

    def send(self, publish: Callable[[], None]) -> None:
        """Send something, soon or not at all, and ask for its receipt."""
        at = self._now()
        with self._lock:
            self._count += 1
            number = str(self._count).encode()
            self._asked.append((number, at))
        self._loop.call_soon_threadsafe(self._pass_on, publish, number, at)

    def come(self) -> bool:
        """Wait until all is read, or late; tell which."""
        while self.is_waiting and not self.is_late:
            self._heard.wait(_LOOKS)
            self._heard.clear()
        return not self.is_waiting

    def abort(self) -> None:
        """End the connection at once; what has not left is forgotten."""
        self._loop.call_soon_threadsafe(self._protocol.transport.abort)

    def _pass_on(self, publish: Callable[[], None], number: bytes, at: float) -> None:
        """Do it on the network's thread, which may have had no turn for long."""
        if self._now() - at <= STALE:
            publish()
            self._loop.call_soon(self._protocol.sendPing, number)  # behind what publish put there

    def _hear(self, number: bytes) -> None:
        """Take a receipt, for all that was sent up to it."""
        with self._lock:
            if number not in [asked for asked, _ in self._asked]:
                return
            while self._asked.popleft()[0] != number:
                pass
            self._heard.set()


def _forget_what_waits(connection: Any) -> None:
    """Let the system deliver nothing that has waited for long, or when all else has ended."""
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _LINGER)
    if hasattr(socket, "TCP_USER_TIMEOUT"):  # Linux
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, round(1000 * STALE))
