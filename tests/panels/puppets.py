"""Snapshots of somebody with the puppet, as a real session gives them."""

from collections.abc import Iterator
from pathlib import Path

from studio.engine import commands
from studio.engine.session import Session
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Snapshot
from tests.engine.sessions import do


def lived_through(folder: Path) -> Iterator[tuple[str, Snapshot]]:
    """Yield what goes on and the snapshot of it."""
    session = Session(folder)
    try:
        yield "taken", do(session, commands.UsePuppet())
        yield "watched", do(session, commands.Watch())
        yield "signing", do(session, commands.Sign("left", HandState.LASSO))
        for sign in (HandState.LASSO, HandState.OPEN, HandState.CLOSED):
            session.post(commands.Sign("left", sign))
            for _ in range(12):
                now = session.tick()
            yield sign.value, now
        while session.snapshot.held:
            session.tick()
        yield "followed", session.snapshot
        do(session, commands.Stop())
        session.post(commands.Record())
        yield "recording", session.tick()
    finally:
        session.close()
