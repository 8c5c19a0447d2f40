"""The other side of `studio.engine.work`: a process that does one task after another.

It steps back behind everybody else on the machine, lives as long as its studio, and tells what it
finds through a pipe; nothing of that touches a disk.
"""

import os
import signal
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Protocol

from studio.engine.errors import StudioError

# Of 19, so that the studio's own 30 Hz come first; with more, a page that is drawn without a
# graphics card leaves so little that a trial takes longer than people wait.
_NICENESS = 5


class Task(Protocol):
    """What can be done: plain data that pickles, of a class at the top of a module."""

    @property
    def name(self) -> str:
        """What it is about, in words: "the error curve"."""
        ...

    @property
    def size(self) -> int:
        """How many points there will be."""
        ...

    def points(self) -> Iterator[object]:
        """Compute and yield its points, each of them plain data."""
        ...


@dataclass(frozen=True, eq=False)
class Found:
    """A point."""

    point: object


@dataclass(frozen=True)
class Finished:
    """All points have been told."""


@dataclass(frozen=True)
class Trouble:
    """It went wrong, in words; ``details`` is for whoever mends the studio."""

    words: str
    details: str = ""


Message = Found | Finished | Trouble


def serve(connection: Connection) -> None:
    """Do what comes through a connection until it ends: with `Work.close`, or with the studio."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the studio's, which ends this one too
    if hasattr(os, "nice"):
        os.nice(_NICENESS)
    try:
        while True:
            for message in _messages(connection):
                connection.send(message)
    except (EOFError, OSError):
        return


def _messages(connection: Connection) -> Iterator[Message]:
    """Take the next task and yield what becomes of it."""
    try:
        task: Task = connection.recv()
    except (EOFError, OSError):
        raise  # the studio is gone
    except Exception as error:
        yield _fault(error)
        return
    try:
        for point in task.points():
            yield Found(point)
        yield Finished()
    except StudioError as error:
        yield Trouble(str(error))
    except Exception as error:
        yield _fault(error)


def _fault(error: Exception) -> Trouble:
    words = f"a fault of the studio's own, {type(error).__name__}: {error}"
    return Trouble(words, traceback.format_exc())
