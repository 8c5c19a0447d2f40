"""Long work beside a session: in a process of its own, so that no tick waits for it.

One task at a time. `Work.start` and `Work.cancel` return at once, `Work.poll` says what has become
of it, and belongs into every tick. Python's threads share one interpreter: a fit on a thread would
take the session's turns away, a process does not. The process is started when first needed, kept
for the next task, and killed to cancel, which no computation can resist.
"""

import multiprocessing
import os
import queue
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection

from studio.engine.errors import StudioError
from studio.engine.worker import Finished, Found, Message, Task, Trouble, serve

REPORT_EVERY = 0.2  # [s]; progress is told 5 times a second at most
_THREADS = (
    *("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"),
    *("MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"),
)
_LONGEST_END = 5.0  # [s] to wait for a killed process; it takes milliseconds


@dataclass(frozen=True, eq=False)
class Progress:
    """A task has come so far."""

    handle: int
    task: Task
    points: tuple[object, ...]  # all that are there

    @property
    def share(self) -> float:
        """How much of it is done, from 0 to 1."""
        return len(self.points) / self.task.size


@dataclass(frozen=True, eq=False)
class Done:
    """A task is done."""

    handle: int
    task: Task
    points: tuple[object, ...]


@dataclass(frozen=True, eq=False)
class Failed:
    """A task came to nothing more than ``points``, for a reason in words."""

    handle: int
    task: Task
    points: tuple[object, ...]
    words: str
    details: str = ""  # the traceback, where the studio itself is at fault


Report = Progress | Done | Failed


@contextmanager
def _one_thread() -> Iterator[None]:
    """Let a process that is started meanwhile do its linear algebra on one thread.

    Its matrices are small. On a busy machine the threads of a library for large ones wait for each
    other: 22 s instead of 0.7 s for a point of the error curve, measured.
    """
    added = [name for name in _THREADS if name not in os.environ]
    os.environ.update(dict.fromkeys(added, "1"))
    try:
        yield
    finally:
        for name in added:
            os.environ.pop(name, None)


class _Worker:
    """A process, and the thread that speaks with it while there is a task."""

    def __init__(self) -> None:
        context = multiprocessing.get_context("spawn")  # it inherits no locks, worlds or sockets
        self._ours, theirs = context.Pipe()
        self._process = context.Process(
            target=serve, args=(theirs,), name="studio-worker", daemon=True
        )
        with _one_thread():
            self._process.start()
        theirs.close()  # so that the end of the process ends the connection
        self._talk: threading.Thread | None = None

    @property
    def is_alive(self) -> bool:
        # Its connection ends before the system counts it among the dead.
        return not self._ours.closed and self._process.is_alive()

    def do(self, task: Task, tell: Callable[[Message], None]) -> None:
        """Have a task done; ``tell`` hears what comes of it, on another thread."""
        self._talk = threading.Thread(
            target=_converse, args=(self._ours, task, tell), name="studio-work", daemon=True
        )
        self._talk.start()

    def kill(self) -> None:
        self._process.kill()
        self._process.join(_LONGEST_END)
        if self._talk is not None:
            self._talk.join(_LONGEST_END)
        self._ours.close()
        self._process.close()


@dataclass(eq=False)
class _Running:
    """What goes on."""

    handle: int
    task: Task
    points: list[object]
    told: int = 0  # of the points
    told_at: float = -float("inf")  # [s]


class Work:
    """See the module. One thread uses it; close it in the end, as a context manager does.

    A program that uses it starts behind ``if __name__ == "__main__":``, as with all processes that
    Python spawns.

    Parameters
    ----------
    now : callable
        The time [s], by a clock that does not run back.
    """

    has_time = True  # for what nobody waits for, see `studio.engine.workplace`

    def __init__(self, now: Callable[[], float]) -> None:
        self._now = now
        self._inbox: queue.SimpleQueue[tuple[int, Message]] = queue.SimpleQueue()
        self._worker: _Worker | None = None
        self._running: _Running | None = None
        self._handles = 0

    @property
    def task(self) -> Task | None:
        """What is being done."""
        return None if self._running is None else self._running.task

    def warm(self) -> None:
        """Start the process now, so that the first task need not wait for its imports."""
        self._ready()

    def start(self, task: Task) -> int:
        """Begin a task and return its handle, by which reports name it.

        Raises
        ------
        StudioError
            Where another one is not over.
        """
        if self._running is not None:
            raise StudioError(f"Cancel {self._running.task.name} first: one thing at a time")
        worker = self._ready()
        self._handles += 1
        handle = self._handles
        self._running = _Running(handle, task, [])
        worker.do(task, lambda message: self._inbox.put((handle, message)))
        return handle

    def poll(self) -> Report | None:
        """Return what is new about the task, or None; after Done or Failed there is none."""
        running = self._running
        while running is not None and not self._inbox.empty():
            handle, message = self._inbox.get()
            if handle != running.handle:
                continue  # of one that was canceled
            if isinstance(message, Found):
                running.points.append(message.point)
                continue
            self._running = None
            points = tuple(running.points)
            if isinstance(message, Finished):
                return Done(handle, running.task, points)
            return failed(handle, running.task, points, message)
        return None if running is None else self._progress(running)

    def cancel(self) -> None:
        """End the task at once, if there is one: nothing more is heard of it.

        Another process starts, to be there when the next task comes.
        """
        if self._running is not None:
            self._running = None
            self._discard()
            self.warm()

    def close(self) -> None:
        """End the task and the process; `start` would begin anew."""
        self._running = None
        self._discard()

    def __enter__(self) -> "Work":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _ready(self) -> _Worker:
        """Return a living process, a new one if need be."""
        if self._worker is None or not self._worker.is_alive:
            self._discard()
            self._worker = _Worker()
        return self._worker

    def _discard(self) -> None:
        if self._worker is not None:
            self._worker.kill()
            self._worker = None

    def _progress(self, running: _Running) -> Progress | None:
        now = self._now()
        if len(running.points) == running.told or now - running.told_at < REPORT_EVERY:
            return None
        running.told, running.told_at = len(running.points), now
        return Progress(running.handle, running.task, tuple(running.points))


def failed(handle: int, task: Task, points: tuple[object, ...], trouble: Trouble) -> Failed:
    """Return the report of a task that went wrong."""
    words = f"{task.name} came to nothing: {trouble.words}"
    return Failed(handle, task, points, words[0].upper() + words[1:], trouble.details)


def _converse(ours: Connection, task: Task, tell: Callable[[Message], None]) -> None:
    """Send a task to the worker and tell what comes back, to the last word."""
    try:
        ours.send(task)
        is_over = False
        while not is_over:
            message: Message = ours.recv()
            is_over = not isinstance(message, Found)
            tell(message)
    except (EOFError, OSError):
        ours.close()
        tell(Trouble("its process ended in the middle of it; start it again"))
    except Exception as error:
        tell(Trouble(f"it cannot be sent to its process: {error}"))
