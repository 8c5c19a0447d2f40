"""Connections that have not said yet what they want: so many at once, then the oldest goes.

Whoever is a publisher says so within milliseconds; who opens connections and says nothing must not
take the descriptors that publishers and recordings need.
"""

import asyncio
import errno
import logging
from collections import deque
from typing import Any

from websockets.asyncio.server import Server, ServerConnection
from websockets.server import ServerProtocol

_LOG = logging.getLogger(__name__)
MOST_PENDING = 256  # a quarter of the descriptors that a process usually may have
_SOON = 0.05  # [s]
_USED_UP = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)
_NO_MORE = (
    "live streams: this computer has no %s left for another connection (%s); it is tried again "
    "every second, who is connected stays so. End programs that keep many files open, or raise "
    "the limit: ulimit -n 4096"
)


class Handshakes:
    """The pending connections of a listener; its event loop alone may use it."""

    def __init__(self) -> None:
        self._pending: deque[ServerConnection] = deque()
        self._told = False

    def begin(self, protocol: ServerProtocol, server: Server, **options: Any) -> ServerConnection:
        """Return a new connection, as websockets' ``create_connection`` does."""
        connection = ServerConnection(protocol, server, **options)
        self._pending.append(connection)
        self._trim()
        return connection

    def through(self, connection: ServerConnection) -> None:
        """Take note that a connection has said what it wants, and may stay."""
        if connection in self._pending:
            self._pending.remove(connection)

    def _trim(self) -> None:
        while len(self._pending) > MOST_PENDING:
            oldest = getattr(self._pending[0], "transport", None)
            if oldest is None:  # the loop has accepted many at once, and not begun with them
                asyncio.get_running_loop().call_later(_SOON, self._trim)
                return
            oldest.abort()
            self._pending.popleft()

    def watch(self, loop: asyncio.AbstractEventLoop) -> None:
        """Say it once, in words, where the system has no more connections to give."""
        loop.set_exception_handler(self._handle)

    def _handle(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        fault = context.get("exception")
        if not isinstance(fault, OSError) or fault.errno not in _USED_UP:
            loop.default_exception_handler(context)
        elif not self._told:
            self._told = True
            files = fault.errno in (errno.EMFILE, errno.ENFILE)
            _LOG.warning(_NO_MORE, "open files" if files else "memory", fault.strerror)
