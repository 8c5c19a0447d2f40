"""Ticking a session whose files are read in another process."""

import time

from studio.engine import commands
from studio.engine.commands import Command
from studio.engine.session import Session
from studio.engine.snapshot import Snapshot

PATIENCE = 60.0  # [s] for a busy machine to start a process
_PAUSE = 0.01  # [s] between ticks at first, so that the other process gets its turn
_LONGEST_PAUSE = 0.25  # [s] so that what goes on in the session does not end before a busy machine


def do(session: Session, *orders: Command) -> Snapshot:
    for order in orders:
        session.post(order)
    return session.tick()


def read(session: Session, file: commands.UseFile | commands.FollowBody) -> Snapshot:
    """Have a file read to its end."""
    do(session, file)
    return until_read(session)


def until_read(session: Session) -> Snapshot:
    """Tick until no file is being read any more."""
    end = time.monotonic() + PATIENCE
    pause = _PAUSE
    session.tick()  # after which a file that was asked for is being read
    while (now := session.tick()).who.reading is not None:
        assert time.monotonic() < end, "still reading"
        time.sleep(pause)
        pause = min(1.05 * pause, _LONGEST_PAUSE)
    return now
