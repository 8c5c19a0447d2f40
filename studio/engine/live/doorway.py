"""Lets programs in on a WebSocket, in a thread of its own: who may, how many, and for how long.

What is said there is no business of its: each connection that may be made is handed on.
"""

import asyncio
import contextlib
import errno
import logging
import threading
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from http import HTTPStatus

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.frames import CloseCode
from websockets.http11 import Request, Response

from studio.engine.errors import StudioError
from studio.engine.live.access import LOOPBACK, Address, check_address, refusal
from studio.engine.live.handshakes import Handshakes

_HANDSHAKE_WITHIN = 5.0  # [s]; who has not said by then what it wants is not counted, but sent away
_GOODBYE_WITHIN = 1.0  # [s]
_PORTS_TRIED = 20


@dataclass(frozen=True)
class House:
    """What a doorway leads to, and how much of it."""

    who: str  # comes: "publishers"
    what: str  # they come for: "live streams"
    option: str  # of the command line, by which it is told where to listen
    most: int  # connections
    largest: int  # [bytes] of a message
    queue: int  # messages; what waits longer than that waits in the other machine
    alive_every: float  # [s] between two pings, and until the answer


class Doorway:
    """A context manager: it lets in from entering to leaving it.

    Parameters
    ----------
    house, address
        What is there, and where.
    token
        What has to be presented. Without one, only this machine's programs are let in.
    handle
        Serves one connection until it ends, on the doorway's event loop.
    opened
        Is told the address once it is open.
    next_free
        Whether to take one of the next ports where that one is taken.
    beside
        Runs on the same event loop for as long as the doorway is open.

    Raises
    ------
    StudioError
        Where the address is beyond this machine and there is no token, or the token is too short;
        on entering, where it can't be listened at.
    """

    def __init__(
        self,
        house: House,
        address: Address,
        token: str | None,
        handle: Callable[[ServerConnection], Awaitable[None]],
        opened: Callable[[Address], None],
        next_free: bool = False,
        beside: Callable[[], Awaitable[None]] | None = None,
    ) -> None:
        check_address(address, token, house.option)
        self.address, self.connected = address, 0
        self._house, self._token = house, token
        self._handle, self._opened, self._beside = handle, opened, beside
        tried = _PORTS_TRIED if next_free else 1
        self._ports = range(address.port, min(address.port + tried, 65536))
        self._handshakes, self._ready = Handshakes(), threading.Event()
        self._failure: BaseException | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._closing: asyncio.Event | None = None
        self._thread = threading.Thread(target=self._run, name=house.who, daemon=True)

    def __enter__(self) -> "Doorway":
        self._thread.start()
        self._ready.wait()
        if self._failure is not None:
            self._thread.join()
            raise self._failure
        return self

    def __exit__(self, *_: object) -> None:
        if self._closing is not None:
            self.later(self._closing.set)
        self._thread.join()

    def later(self, act: Callable[[], object]) -> None:
        """Have something done on the event loop, soon; once that has ended, never. Any thread."""
        if self._loop is not None:
            with contextlib.suppress(RuntimeError):
                self._loop.call_soon_threadsafe(act)

    def _run(self) -> None:
        try:
            asyncio.run(self._listen())
        except BaseException as failure:
            self._failure = failure
            if self._ready.is_set():
                raise
        finally:
            self._ready.set()

    async def _listen(self) -> None:
        self._loop, self._closing = asyncio.get_running_loop(), asyncio.Event()
        self._handshakes.watch(self._loop)
        async with await self._bind() as server:
            port = next(iter(server.sockets)).getsockname()[1]
            self.address = Address(self.address.host, port)
            self._opened(self.address)
            beside = asyncio.ensure_future(self._beside()) if self._beside is not None else None
            self._ready.set()
            await self._closing.wait()
            if beside is not None:
                beside.cancel()
                with contextlib.suppress(asyncio.CancelledError):
                    await beside

    async def _bind(self) -> Server:
        failure = OSError("there is no such port")
        for port in self._ports:
            try:
                return await self._serve(port)
            except OSError as error:
                failure = error
                if error.errno != errno.EADDRINUSE:
                    break
        raise StudioError(self._cannot_listen(failure)) from failure

    async def _serve(self, port: int) -> Server:
        return await serve(
            self._let_in,
            self.address.host,
            port,
            process_request=self._refuse,
            compression=None,  # costs more time than it saves here, and can be a bomb
            max_size=self._house.largest,
            max_queue=self._house.queue,
            open_timeout=_HANDSHAKE_WITHIN,
            close_timeout=_GOODBYE_WITHIN,
            ping_interval=self._house.alive_every,
            ping_timeout=self._house.alive_every,
            logger=_silent_logger(),
            create_connection=self._handshakes.begin,  # type: ignore[arg-type] # as good as a class
        )

    def _refuse(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return the refusal of a connection, None where it may be made."""
        headers = request.headers
        authorization = headers.get("Authorization", "")
        words = refusal(request.path, authorization, headers.get("Origin"), self._token)
        if words:
            status = HTTPStatus.FORBIDDEN if self._token is None else HTTPStatus.UNAUTHORIZED
            return connection.respond(status, f"{words}\n")
        if self.connected >= self._house.most:
            words = f"{self._house.most} {self._house.who} are connected already, the most taken"
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, f"{words}\n")
        return None

    async def _let_in(self, connection: ServerConnection) -> None:
        if self.connected >= self._house.most:  # several may have passed `_refuse` at once
            await connection.close(CloseCode.TRY_AGAIN_LATER, f"too many {self._house.who}")
            return
        self._handshakes.through(connection)
        self.connected += 1
        try:
            await self._handle(connection)
        finally:
            self.connected -= 1

    def _cannot_listen(self, failure: OSError) -> str:
        return (
            f"cannot listen for {self._house.what} at {self.address}: "
            f"{failure.strerror or failure}; choose another address: "
            f"{self._house.option} {LOOPBACK}:0 takes any port that is free"
        )


def _silent_logger() -> logging.Logger:
    """Return a logger for the library, which logs a traceback for every handshake gone wrong."""
    logger = logging.getLogger("studio.live.websockets")
    logger.propagate = False
    logger.addHandler(logging.NullHandler())
    return logger
