"""Listens for publishers on a WebSocket, in a thread of its own."""

import asyncio
import contextlib
import errno
import json
import logging
import threading
from http import HTTPStatus
from types import TracebackType

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode
from websockets.http11 import Request, Response

from studio.engine.errors import StudioError
from studio.engine.live.access import LOOPBACK, Address, check_address, refusal
from studio.engine.live.handshakes import Handshakes
from studio.engine.live.reception import LARGEST_MESSAGE, Answer, FloodError, Reception
from studio.engine.live.source import LiveSource

_LOG = logging.getLogger(__name__)
MOST_CONNECTIONS = 8
_HANDSHAKE_WITHIN = 5.0  # [s]; who has not said by then what it wants is not counted, but sent away
_GOODBYE_WITHIN = 1.0  # [s]
_ANSWER_WITHIN = 2.0  # [s]; a publisher that does not read must not hold up its own frames for long
_ALIVE_EVERY = 10.0  # [s]; a machine that was switched off does not say goodbye
_QUEUE = 4  # messages; what waits longer than that waits in the publisher's machine
_PORTS_TRIED = 20
_NOT_READ = (CloseCode.MESSAGE_TOO_BIG, CloseCode.INVALID_DATA, CloseCode.PROTOCOL_ERROR)


class Listener:
    """A context manager: it listens from entering to leaving it.

    Parameters
    ----------
    source
        Where the driver's frames go.
    address
        Where to listen.
    token
        What publishers have to present. Without one, only this machine's are taken.
    next_free
        Whether to take one of the next ports where that one is taken.

    Raises
    ------
    StudioError
        Where the address is beyond this machine and there is no token, or the token is too short;
        on entering, where it can't be listened at.
    """

    def __init__(
        self,
        source: LiveSource,
        address: Address = Address(),  # noqa: B008 - frozen
        token: str | None = None,
        next_free: bool = False,
    ) -> None:
        check_address(address, token)
        self.address = address
        self._source, self._token = source, token
        tried = _PORTS_TRIED if next_free else 1
        self._ports = range(address.port, min(address.port + tried, 65536))
        self._reception, self._handshakes = Reception(source, source.now), Handshakes()
        self._connected = self._numbered = 0
        self._ready = threading.Event()
        self._failure: BaseException | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._closing: asyncio.Event | None = None
        self._thread = threading.Thread(target=self._run, name="listener", daemon=True)

    def __enter__(self) -> "Listener":
        self._thread.start()
        self._ready.wait()
        if self._failure is not None:
            self._thread.join()
            raise self._failure
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._loop is not None and self._closing is not None:
            with contextlib.suppress(RuntimeError):  # it has ended by itself
                self._loop.call_soon_threadsafe(self._closing.set)
        self._thread.join()

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
            self._tell_source()
            self._ready.set()
            await self._closing.wait()

    async def _bind(self) -> Server:
        failure = OSError("there is no such port")
        for port in self._ports:
            try:
                return await self._serve(port)
            except OSError as error:
                failure = error
                if error.errno != errno.EADDRINUSE:
                    break
        raise StudioError(_cannot_listen(self.address, failure)) from failure

    async def _serve(self, port: int) -> Server:
        return await serve(
            self._handle,
            self.address.host,
            port,
            process_request=self._refuse,
            compression=None,  # costs more time than it saves here, and can be a bomb
            max_size=LARGEST_MESSAGE,
            max_queue=_QUEUE,
            open_timeout=_HANDSHAKE_WITHIN,
            close_timeout=_GOODBYE_WITHIN,
            ping_interval=_ALIVE_EVERY,
            ping_timeout=_ALIVE_EVERY,
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
        if self._connected >= MOST_CONNECTIONS:
            words = f"{MOST_CONNECTIONS} publishers are connected already, the most that are taken"
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, f"{words}\n")
        return None

    async def _handle(self, connection: ServerConnection) -> None:
        """Serve one publisher until it leaves."""
        if self._connected >= MOST_CONNECTIONS:  # several may have passed `_refuse` at once
            await connection.close(CloseCode.TRY_AGAIN_LATER, "too many publishers")
            return
        self._handshakes.through(connection)
        self._connected += 1
        self._numbered += 1
        self._tell_source()
        host, port = (connection.remote_address or ("gone", 0))[:2]
        publisher, greeting = self._reception.welcome(f"Publisher {self._numbered} ({host}:{port})")
        try:
            await _answer(connection, greeting)
            async for message in connection:
                answer = self._reception.receive(publisher, message)
                if answer is not None:
                    await _answer(connection, answer)
        except FloodError as error:
            await connection.close(CloseCode.POLICY_VIOLATION, str(error))
        except ConnectionClosed as closed:
            if closed.sent is not None and closed.sent.code in _NOT_READ:
                self._source.count("unreadable")
        except TimeoutError:
            await connection.close(CloseCode.POLICY_VIOLATION, "does not read its answers")
        except Exception:  # of one connection; the others, and the robot, go on
            _LOG.exception("a live connection has failed")
        finally:
            self._connected -= 1
            self._reception.leave(publisher)
            self._tell_source()

    def _tell_source(self) -> None:
        self._source.connect(self.address.url, self._connected)


async def _answer(connection: ServerConnection, answer: Answer) -> None:
    async with asyncio.timeout(_ANSWER_WITHIN):
        await connection.send(json.dumps(answer))


def _cannot_listen(address: Address, failure: OSError) -> str:
    return (
        f"cannot listen for live streams at {address}: "
        f"{failure.strerror or failure}; choose another address: "
        f"--listen {LOOPBACK}:0 takes any port that is free"
    )


def _silent_logger() -> logging.Logger:
    """Return a logger for the library, which logs a traceback for every handshake gone wrong."""
    logger = logging.getLogger("studio.live.websockets")
    logger.propagate = False
    logger.addHandler(logging.NullHandler())
    return logger
