"""The listener against damaged messages and damaged connections, with a session that watches.

Run it by ``python tests/bench/bench_fuzz_socket.py [--inputs 100000] [--seed 0]``. Nineteen in
twenty inputs are messages of every protocol, each damaged in a few places and sent over one real
connection after another; the rest are whole connections, handshake and frames, damaged as bytes.

It fails where a connection's handler fails, the listener or the session ends, an answer takes
longer than `SLOWEST`, or memory grows by more than `GROWTH`; and it ends by teaching the session
over the same listener, to see that it still works.
"""

import argparse
import base64
import gc
import logging
import resource
import socket
import sys
import tempfile
import time
from itertools import count
from pathlib import Path

import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.frames import Frame as WireFrame
from websockets.frames import Opcode

from studio.engine import commands
from studio.engine.gate import GateStatus
from studio.engine.live.access import Address
from studio.engine.live.listener import Listener
from studio.engine.live.source import LiveSource
from studio.engine.session import Session
from tests.engine.corruption import corrupted
from tests.engine.live.streaming import SIGNS, demonstrated, message, publisher, signing
from tests.engine.skeleton_files import landmark_files

SLOWEST = 5.0  # [s] for a batch; this machine may be busy with other things
GROWTH = 64.0  # [MB] of the peak after the first tenth of the inputs
BATCH = 50  # messages between two ticks
ANSWERED = 4  # batches of one connection


class Complaints(logging.Handler):
    """Keeps what the studio logs: there must be nothing."""

    def __init__(self) -> None:
        super().__init__()
        self.records: list[logging.LogRecord] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.records.append(record)


class PatientClock:
    """Half a second passes whenever it is looked at, so that nobody is ever too fast."""

    def __init__(self) -> None:
        self._ticks = count(200)

    def __call__(self) -> float:
        return next(self._ticks) / 2


def subjects() -> list[bytes]:
    """Return a whole message of each protocol, of one person, of two, and of nobody."""
    one = demonstrated()[30]
    messages = [message(one, kind) for kind in ("jsonl", "node-kinect2", "kinectron")]
    messages.append(message(one) + "\n" + message(one).replace('"body": "', '"body": "2'))
    messages.append('{"skeleton": 1, "time": 0.5}')
    landmarks = next(iter(landmark_files().values())).decode().splitlines()[0]
    return [text.encode() for text in (*messages, landmarks)]


def send_messages(url: str, session: Session, live: LiveSource, texts: list[bytes]) -> float:
    """Send messages, let the session tick, and return how long the slowest batch took [s]."""
    slowest = 0.0
    with publisher(url) as sensor:
        for first in range(0, len(texts), BATCH):
            start, before = time.perf_counter(), live.status().counts.received
            batch = texts[first : first + BATCH]
            try:
                for text in batch:
                    sensor.send(text)
                while live.status().counts.received < before + len(batch):
                    if time.perf_counter() - start > SLOWEST:
                        raise TimeoutError("messages were not taken in")
                    time.sleep(0.0005)
            except ConnectionClosed:
                break
            session.tick()
            slowest = max(slowest, time.perf_counter() - start)
    return slowest


def wire(rng: np.random.Generator, texts: list[bytes]) -> bytes:
    """Return what a client sends in a whole connection."""
    key = base64.b64encode(rng.bytes(16)).decode()
    handshake = (
        "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
    ).encode()
    frames = (
        WireFrame(Opcode.TEXT, texts[rng.integers(len(texts))]).serialize(mask=True)
        for _ in range(3)
    )
    return handshake + b"".join(frames)


def send_bytes(address: Address, data: bytes) -> None:
    """Send bytes to the listener's port, and hang up."""
    with socket.create_connection((address.host, address.port), timeout=5.0) as plain:
        plain.settimeout(0.05)
        try:
            plain.sendall(data)
            plain.recv(4096)
        except OSError:
            pass


def peak() -> float:
    """Return the most memory that the process has held so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def teach(url: str, session: Session, live: LiveSource) -> GateStatus | None:
    """Let somebody sign over the listener; return what the gate thinks then."""
    with publisher(url) as sensor:
        for number, state in enumerate(SIGNS):
            before = live.status().counts.received
            sensor.send(signing(number / 30, state))
            while live.status().counts.received == before:
                time.sleep(0.0005)
            session.tick()
        return session.snapshot.gate


def main() -> int:
    """Attack; return 1 where anything is not as it should be."""
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--inputs", type=int, default=100_000)
    arguments.add_argument("--seed", type=int, default=0)
    given = arguments.parse_args()
    rng = np.random.default_rng(given.seed)
    complaints = Complaints()
    logging.getLogger("studio").addHandler(complaints)
    live, whole, done, slowest, before = LiveSource(PatientClock()), subjects(), 0, 0.0, 0.0
    with tempfile.TemporaryDirectory() as folder, Listener(live, Address("127.0.0.1", 0)) as taking:
        session = Session(Path(folder), live=live)
        session.post(commands.UseLive())
        session.post(commands.Watch())
        share = BATCH * ANSWERED
        while done < given.inputs:
            texts = [corrupted(whole[rng.integers(len(whole))], rng) for _ in range(share)]
            slowest = max(slowest, send_messages(taking.address.url, session, live, texts))
            for _ in range(share // 19):
                send_bytes(taking.address, corrupted(wire(rng, whole), rng))
            done += share + share // 19
            if not before and done >= given.inputs / 10:
                gc.collect()
                before = peak()
        growth = peak() - before
        gate = teach(taking.address.url, session, live)
        session.close()
    print("| inputs | unreadable | read | late | slowest batch | peak's growth | failures | arms |")
    print("|---|---|---|---|---|---|---|---|")
    counts = live.status().counts
    arms = gate is not None and gate.armed
    print(
        f"| {done:,} | {counts.unreadable:,} | {counts.used + counts.dropped:,} | {counts.late:,} "
        f"| {1000 * slowest:.0f} ms | {growth:.1f} MB | {len(complaints.records)} | {arms} |"
    )
    return int(bool(complaints.records) or not arms or slowest > SLOWEST or growth > GROWTH)


if __name__ == "__main__":
    sys.exit(main())
