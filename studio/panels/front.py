"""The studio's one address: the page, looked over on its way, and all else passed on to viser.

viser serves its page as it is, and that page stays blank where a browser cannot draw in 3D. So
viser listens on this machine only, at a port of its own; here its page goes out with a few lines
before it that look first, and a browser without WebGL 2 gets a page that explains itself. Whatever
else comes, the WebSocket first of all, is passed through as the bytes that it is.
"""

import asyncio
import gzip
import socket
import urllib.request
from collections.abc import Coroutine
from concurrent.futures import Future
from http import HTTPStatus
from typing import Any

from studio.engine.errors import StudioError
from studio.panels.first_page import NO_WEBGL, NO_WEBGL_PATH, checked

_MOST_PORTS = 100  # tried, from the one asked for
_LONGEST_HEAD = 1 << 16  # [bytes] of a request
_PATIENCE = 20.0  # [s] for a request's head
_CHUNK = 1 << 16  # [bytes]
_WAITING = 1 << 16  # [bytes] between viser and a slow browser: viser drops what is old, we cannot


class Front:
    """See the module.

    Parameters
    ----------
    loop
        A running event loop that serves; it may be viser's own.
    host, port
        Where to listen; the next free port is taken where this one is busy.
    inner
        viser's port on this machine.

    Raises
    ------
    StudioError
        Where there is no such address, or no port is free.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, host: str, port: int, inner: int) -> None:
        self._loop, self._inner = loop, inner
        self._talks: set[asyncio.Task[None]] = set()
        self._pages: dict[str, bytes] = {}
        self._server = self._do(self._listen(host, port)).result()
        self.port: int = self._server.sockets[0].getsockname()[1]

    def close(self) -> None:
        """Hang up on everybody."""
        self._do(self._hang_up()).result()

    def _do(self, work: Coroutine[Any, Any, Any]) -> "Future[Any]":
        return asyncio.run_coroutine_threadsafe(work, self._loop)

    async def _listen(self, host: str, port: int) -> asyncio.Server:
        last: OSError | None = None
        for candidate in range(port, min(port + _MOST_PORTS, 1 << 16)):
            try:
                return await asyncio.start_server(
                    self._answer, host, candidate, limit=_LONGEST_HEAD
                )
            except OSError as error:
                last = error
        raise StudioError(f"{host}:{port}: the page cannot be served here: {last}") from last

    async def _hang_up(self) -> None:
        self._server.close()
        for talk in self._talks:
            talk.cancel()
        await asyncio.gather(*self._talks, return_exceptions=True)

    async def _answer(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer one connection to its end."""
        talk = asyncio.current_task()
        if talk is not None:
            self._talks.add(talk)
            talk.add_done_callback(self._talks.discard)
        try:
            head = await asyncio.wait_for(reader.readuntil(b"\r\n\r\n"), _PATIENCE)
            own = await self._own(head)
            if own is None:
                await self._pass_on(head, reader, writer)
            else:
                writer.write(own)
                await writer.drain()
        except (OSError, EOFError, TimeoutError, asyncio.LimitOverrunError):
            pass  # whoever is not heard to the end, or hangs up, gets nothing more
        except asyncio.CancelledError:
            pass  # the studio closes; asyncio would print a traceback for every connection
        finally:
            writer.close()

    async def _own(self, head: bytes) -> bytes | None:
        """Return the answer to what is asked of us, None for what is viser's."""
        lines = head.decode("latin-1").split("\r\n")
        method, _, rest = lines[0].partition(" ")
        path = rest.partition(" ")[0].partition("?")[0]
        parts = (line.partition(":") for line in lines[1:])
        fields = {name.lower(): value.lower() for name, _, value in parts}
        if method != "GET" or "upgrade" in fields or path not in ("/", NO_WEBGL_PATH):
            return None
        if path not in self._pages:
            self._pages[path] = await asyncio.to_thread(self._made, path)
        packed = self._pages[path]
        is_packed = "gzip" in fields.get("accept-encoding", "")
        content = packed if is_packed else gzip.decompress(packed)
        return _response(content, is_packed)

    def _made(self, path: str) -> bytes:
        """Return a page, packed."""
        if path == NO_WEBGL_PATH:
            return gzip.compress(NO_WEBGL.encode())
        inner = f"http://127.0.0.1:{self._inner}/"
        with urllib.request.urlopen(inner, timeout=_PATIENCE) as answer:
            page: str = answer.read().decode()
        return gzip.compress(checked(page).encode())

    async def _pass_on(
        self, head: bytes, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        """Let a browser and viser talk until one of them hangs up."""
        line = socket.socket()
        line.setblocking(False)
        line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _WAITING)
        try:
            await self._loop.sock_connect(line, ("127.0.0.1", self._inner))
            inner_reader, inner_writer = await asyncio.open_connection(sock=line, limit=_WAITING)
        except BaseException:
            line.close()
            raise
        inner_writer.write(head)
        ways = [
            asyncio.create_task(_pump(reader, inner_writer)),
            asyncio.create_task(_pump(inner_reader, writer)),
        ]
        try:
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for way in ways:
                way.cancel()
            await asyncio.gather(*ways, return_exceptions=True)
            inner_writer.close()


async def _pump(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    while data := await reader.read(_CHUNK):
        writer.write(data)
        await writer.drain()


def _response(content: bytes, is_packed: bool) -> bytes:
    head = (
        f"HTTP/1.1 {HTTPStatus.OK.value} {HTTPStatus.OK.phrase}\r\n"
        "Content-Type: text/html; charset=utf-8\r\n"
        f"Content-Length: {len(content)}\r\n"
        f"Content-Encoding: {'gzip' if is_packed else 'identity'}\r\n"
        "Connection: close\r\n\r\n"
    )
    return head.encode() + content
