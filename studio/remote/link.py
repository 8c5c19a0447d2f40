"""A connection to the studio: requests and their answers, and the streams beside them.

A thread of its own reads all the time, so that a program that is busy elsewhere is no slow reader.
"""

import itertools
import queue
import socket
import struct
import sys
import threading
from collections import deque
from collections.abc import Callable
from typing import Any, TypeVar

import msgspec
from websockets.exceptions import (
    ConnectionClosed,
    InvalidHandshake,
    InvalidStatus,
    InvalidURI,
)
from websockets.sync.client import ClientConnection, connect

from studio.remote.asked import Asked, Stream
from studio.remote.errors import LateError, LostError, RefusedError, UnreachableError
from studio.remote.snapshot import Snapshot
from studio.remote.told import Block, ClockLost, Error, Gate, JointStates, Role, Told, Welcome

Frame = JointStates | Gate | Block | Snapshot
_Answer = TypeVar("_Answer")
STREAMS: dict[type[Any], Stream] = {
    JointStates: "joint_states",
    Gate: "gate",
    Block: "block",
    Snapshot: "snapshot",
}
_LARGEST = 64 * 2**20  # [bytes] of a message
_KEPT = 90  # frames of a stream that nobody has looked at yet: three seconds
_BEGUN_ANEW = "this program has begun to read the stream anew: of one kind there is one at a time"
_DECODER = msgspec.json.Decoder(Told)


class Frames:
    """What has come of one stream. Any thread may use it."""

    def __init__(self) -> None:
        self._frames: deque[Frame] = deque(maxlen=_KEPT)
        self._came = threading.Condition()
        self.lost = ""  # why no more will come

    def add(self, frame: Frame) -> None:
        """Take in a frame; the oldest goes where nobody has looked for long."""
        with self._came:
            self._frames.append(frame)
            self._came.notify_all()

    def end(self, why: str) -> None:
        """Let nobody wait any more."""
        with self._came:
            self.lost = why
            self._came.notify_all()

    def next(self, timeout: float) -> Frame:
        """Return the oldest frame that nobody has seen; wait for it.

        Raises
        ------
        LateError, LostError
            Where none comes within ``timeout`` [s], or ever.
        """
        with self._came:
            if not self._came.wait_for(lambda: self._frames or self.lost, timeout):
                raise LateError(f"no frame of the stream in {timeout:g} s")
            if not self._frames:
                raise LostError(self.lost)
            return self._frames.popleft()


class Link:
    """See the module. Any thread may use it.

    Raises
    ------
    UnreachableError
        Where there is no studio, or it does not let this program in.
    """

    def __init__(self, url: str, token: str | None, timeout: float) -> None:
        self.timeout = timeout
        self._socket = _opened(url, token, timeout)
        self._numbers = itertools.count(1)
        self._waiting: dict[int, queue.SimpleQueue[Told | None]] = {}
        self._frames: dict[Stream, Frames] = {}
        self._lock = threading.Lock()
        self._lost = ""  # why the connection has ended
        self.complaints: deque[str] = deque(maxlen=100)  # what was wrong with what has no answer
        self.role: Role | None = None  # the newest
        self.clock_lost = ""  # why the clock was lost last
        self._welcome: queue.SimpleQueue[Welcome] = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read, name="studio.remote", daemon=True)
        self._reader.start()
        try:
            self.welcome = self._welcome.get(timeout=timeout)
        except queue.Empty:
            self.close()
            raise UnreachableError(
                f"{url}: {self._lost or 'whoever is there says nothing'}"
            ) from None

    def send(self, message: Asked) -> None:
        """Send a message that nobody answers; raise LostError where nobody hears it."""
        try:
            self._socket.send(msgspec.json.encode(message).decode())
        except ConnectionClosed as closed:
            raise LostError(self._lost or _why(closed)) from None

    def ask(
        self,
        build: Callable[[int], Asked],
        kind: type[_Answer],
        timeout: float | None = None,
    ) -> _Answer:
        """Send the request that ``build`` returns for a number, and return its answer.

        Raises
        ------
        RefusedError
            Where the studio says why it cannot be.
        LateError, LostError
            Where no answer comes in time, or ever.
        """
        patience = self.timeout if timeout is None else timeout
        number, answers = next(self._numbers), queue.SimpleQueue[Told | None]()
        with self._lock:
            self._waiting[number] = answers
        try:
            self.send(build(number))
            answer = answers.get(timeout=patience)
        except queue.Empty:
            raise LateError(f"the studio has not answered in {patience:g} s") from None
        finally:
            with self._lock:
                self._waiting.pop(number, None)
        if isinstance(answer, Error):
            raise RefusedError(answer.words, answer.place)
        if not isinstance(answer, kind):
            raise LostError(self._lost or f"expected {kind.__name__}, heard {answer!r:.80}")
        return answer

    def begin(self, stream: Stream) -> Frames:
        """Return what comes of a stream from now on; whoever read it before reads no more.

        To be called while it is not subscribed to, so that no older frame is on its way.
        """
        frames = Frames()
        with self._lock:
            before, self._frames[stream] = self._frames.get(stream), frames
        if before is not None:
            before.end(_BEGUN_ANEW)
        if self._lost:  # since when nobody is told any more
            frames.end(self._lost)
        return frames

    def is_newest(self, stream: Stream, frames: Frames) -> bool:
        """Tell whether nobody has begun to read the stream anew since then."""
        with self._lock:
            return self._frames.get(stream) is frames

    def close(self) -> None:
        """End the connection."""
        self._socket.close()
        if threading.current_thread() is not self._reader:
            self._reader.join(self.timeout)

    def _read(self) -> None:
        try:
            for text in self._socket:
                self._take(_DECODER.decode(text))
        except ConnectionClosed as closed:
            self._lost = _why(closed)
        except msgspec.MsgspecError as error:
            self._lost = f"the studio speaks another version of this: {error}"
            self._socket.close()
        self._lost = self._lost or "the connection was closed"
        with self._lock:
            waiting, frames = list(self._waiting.values()), list(self._frames.values())
        for each in waiting:
            each.put(None)
        for stream in frames:
            stream.end(self._lost)

    def _take(self, told: Told) -> None:
        number = getattr(told, "id", None)
        if isinstance(told, Role):
            self.role = told
        if number is not None:
            with self._lock:
                waiting = self._waiting.get(number)
            if waiting is not None:
                waiting.put(told)
        elif type(told) in STREAMS:
            with self._lock:
                frames = self._frames.get(STREAMS[type(told)])
            if frames is not None:
                frames.add(told)  # type: ignore[arg-type] # one of these
        elif isinstance(told, Welcome):
            self._welcome.put(told)
        elif isinstance(told, Error):
            self.complaints.append(told.words)
        elif isinstance(told, ClockLost):
            self.clock_lost = told.words


def _opened(url: str, token: str | None, timeout: float) -> ClientConnection:
    headers = {} if token is None else {"Authorization": f"Bearer {token}"}
    try:
        opened = connect(
            url,
            additional_headers=headers,
            open_timeout=timeout,
            close_timeout=1.0,
            compression=None,
            max_size=_LARGEST,
            proxy=None,
        )
        _limit_sending(opened, timeout)
    except InvalidStatus as refused:
        words = (refused.response.body or b"").decode(errors="replace").strip()
        raise UnreachableError(f"{url}: {words or refused}") from None
    except (InvalidURI, InvalidHandshake, OSError, ValueError) as error:
        raise UnreachableError(
            f"{url}: no studio answers there ({error}): start one with "
            "studio serve --remote 127.0.0.1:8766"
        ) from None
    return opened


def _limit_sending(opened: ClientConnection, timeout: float) -> None:
    """Let no message wait longer than that for a studio that does not read; it is lost then."""
    if sys.platform != "win32":  # where this option has another form
        whole, rest = divmod(timeout, 1.0)
        limit = struct.pack("ll", int(whole), int(1e6 * rest))
        opened.socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, limit)


def _why(closed: ConnectionClosed) -> str:
    said = closed.rcvd
    words = said.reason if said is not None and said.reason else "the connection was lost"
    return f"the studio: {words}" if said is not None and said.reason else words
