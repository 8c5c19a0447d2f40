"""``studio listen`` and ``studio play``: both ends of a live stream, without a page."""

import json
import threading
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro
from websockets.exceptions import (
    ConnectionClosed,
    InvalidHandshake,
    InvalidStatus,
    WebSocketException,
)
from websockets.sync.client import ClientConnection, connect
from websockets.sync.connection import Connection

from studio.console import as_json_text, log
from studio.engine.clock import now, wait_until
from studio.engine.conversion import read_any
from studio.engine.errors import StudioError
from studio.engine.live.access import Address, check_url
from studio.engine.live.listener import Listener
from studio.engine.live.player import MessageFormat, encoder, schedule
from studio.engine.live.recorder import FrameRecorder
from studio.engine.live.source import LiveSource
from studio.engine.live.status import LiveStatus, in_short
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.sources.family import Frame
from studio.stream_token import stream_token

_USUAL = Address()
_TICKS_A_LINE = 30  # between two lines that tell how it goes: one a second


@dataclass(frozen=True)
class Listen:
    """Take live streams without the studio: tell what arrives, and keep it. Ctrl-C ends it."""

    listen: str = f"{_USUAL.host}:{_USUAL.port}"
    """HOST:PORT to listen on. Beyond this machine it needs a token."""
    token: str | None = None
    """What publishers have to present: ws://...?token=TOKEN or Authorization: Bearer TOKEN. Better
    set STUDIO_TOKEN: other users of this machine can read what is typed here."""
    record: Path | None = None
    """File to write all frames to, as our JSONL."""
    json: bool = False
    """Print one JSON object at the end."""

    def run(self) -> int:
        """Listen until interrupted; the status is 1 where no frame came."""
        with ExitStack() as stack:
            kept = None if self.record is None else stack.enter_context(FrameRecorder(self.record))
            live = LiveSource(now, kept.record if kept else None)
            address = Address.parse(self.listen)
            listener = stack.enter_context(Listener(live, address, stream_token(self.token)))
            log(f"listening at {listener.address.url} (Ctrl-C ends it)")
            begun = now()
            with suppress(KeyboardInterrupt):
                _watch(live, kept)
            status, seconds = live.status(), now() - begun
        if kept is not None and kept.failure:
            raise StudioError(kept.failure)
        counts = status.counts
        if self.json:
            print(as_json_text(_summary(status, seconds, kept)))
        else:
            print(f"{seconds:.0f} s: {_counted(status)}")
            if kept is not None:
                print(f"{kept.frames} frames are in {kept.path}" if kept.frames else "nothing kept")
        return 0 if counts.used + counts.dropped else 1


@dataclass(frozen=True)
class Play:
    """Play a recording as if it were a live sensor. Ctrl-C ends it."""

    file: Annotated[Path, tyro.conf.Positional]
    """A skeleton file in any supported format, or a recording (MCAP)."""
    to: str = _USUAL.url
    """Where the studio, or studio listen, takes live streams."""
    speed: float = 1.0
    """Times as fast as it was."""
    loop: bool = False
    """Begin anew at its end, with stamps that go on rising."""
    format: MessageFormat = "jsonl"
    """The message: our own, or as these programs send it."""
    token: str | None = None
    """What the studio wants to be shown, if anything; STUDIO_TOKEN says it unseen."""
    json: bool = False
    """Print one JSON object at the end."""

    def run(self) -> int:
        """Play to the end or until interrupted; the status is 1 where the studio ended it."""
        parsed, left_out = read_any(self.file)
        frames = schedule(parsed.frames, self.speed, self.loop)
        for note in left_out:
            log(note)
        heard: list[str] = []
        with _connect(self.to, stream_token(self.token)) as connection:
            # Answers are read all the time: a full pipe would hold up what is sent.
            threading.Thread(target=_repeat, args=(connection, heard), daemon=True).start()
            begun = now()
            sent = self._send(frames, connection)
            seconds = now() - begun
        if self.json:
            print(as_json_text({"sent": sent, "seconds": seconds, "answers": heard}))
        else:
            print(f"sent {sent} frames in {seconds:.1f} s")
        return 0

    def _send(self, frames: Iterator[Frame], connection: Connection) -> int:
        """Send every frame when it is due; return how many."""
        encode, never, begun, sent = encoder(self.format), threading.Event(), now(), 0
        try:
            for frame in frames:
                wait_until(begun + frame.time, never)
                connection.send(encode(frame))
                sent += 1
        except KeyboardInterrupt:
            pass
        except ConnectionClosed as closed:
            why = closed.rcvd.reason if closed.rcvd is not None else ""
            raise StudioError(
                f"{self.to}: the studio has ended the connection after {sent} frames"
                f"{': ' if why else ''}{why}"
            ) from None
        return sent


def _watch(live: LiveSource, kept: FrameRecorder | None) -> None:
    """Take frames as the studio would, and tell once a second how it goes."""
    stopping, due, ticks = threading.Event(), now(), 0
    while wait_until(due, stopping):
        live.take()
        ticks += 1
        due = max(due + CONTROL_PERIOD, now() - 1.0)  # after a machine slept, no second of racing
        if ticks % _TICKS_A_LINE == 0:
            status = live.status()
            log(f"{in_short(status)} {_counted(status)}")
            if kept is not None and kept.failure:
                return


def _counted(status: LiveStatus) -> str:
    """Return the counts that are not nothing, in words."""
    counts = asdict(status.counts)
    received = counts.pop("received")
    parts = [f"{number} {name.replace('_', ' ')}" for name, number in counts.items() if number]
    return f"{received} messages" + (f": {', '.join(parts)}" if parts else "")


def _summary(status: LiveStatus, seconds: float, kept: FrameRecorder | None) -> dict[str, Any]:
    return {
        "address": status.address,
        "seconds": seconds,
        "streams": status.stream,
        "protocol": status.protocol,
        "counts": asdict(status.counts),
        "latency": asdict(status.latency),
        "recorded": None if kept is None else {"file": str(kept.path), "frames": kept.frames},
    }


def _connect(url: str, token: str | None) -> ClientConnection:
    """Return a connection; raise StudioError in words where there is none."""
    check_url(url)
    headers = {} if token is None else {"Authorization": f"Bearer {token}"}
    try:
        # No proxy: the studio is on this machine or on the next one.
        return connect(url, additional_headers=headers, compression=None, proxy=None)
    except InvalidStatus as refused:
        body = refused.response.body or b""
        words = body.decode(errors="replace").strip() or f"status {refused.response.status_code}"
        raise StudioError(f"{url}: refused: {words}") from None
    except (OSError, TimeoutError, InvalidHandshake, WebSocketException) as error:
        raise StudioError(
            f"{url}: nobody takes live streams there ({error}): start the studio, or studio listen"
        ) from None


def _repeat(connection: Connection, heard: list[str]) -> None:
    """Say what the studio answers, until the connection ends."""
    with suppress(ConnectionClosed):
        for message in connection:
            words = _in_words(message)
            heard.append(words)
            log(f"the studio answers: {words}")


def _in_words(message: str | bytes) -> str:
    """Return an answer as a person reads it."""
    try:
        answer = json.loads(message)
    except ValueError:
        return repr(message)
    if isinstance(answer, dict):
        return ", ".join(f"{key}: {value}" for key, value in answer.items())
    return repr(answer)
