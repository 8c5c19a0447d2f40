"""Where long work is done: in another process (`studio.engine.work`), or here, a point a tick.

`InTicks` is for a session without a page: what it finds depends on no clock and no other process,
so that the same commands at the same ticks give the same snapshots.
"""

from collections.abc import Iterator
from typing import Protocol

from studio.engine.errors import StudioError
from studio.engine.work import Done, Progress, Report, failed
from studio.engine.worker import Task, Trouble


class Workplace(Protocol):
    """What a session asks of it: one task at a time, `poll` in every tick."""

    @property
    def has_time(self) -> bool:
        """Whether what nobody waits for may be done there, too."""
        ...

    @property
    def task(self) -> Task | None:
        """What is being done."""
        ...

    def warm(self) -> None:
        """Get ready, so that the first task need not wait."""
        ...

    def start(self, task: Task) -> int:
        """Begin a task and return its handle; raise StudioError where another one is not over."""
        ...

    def poll(self) -> Report | None:
        """Return what is new about the task, or None."""
        ...

    def cancel(self) -> None:
        """End the task at once: nothing more is heard of it."""
        ...

    def close(self) -> None:
        """End the task, and whatever does it."""
        ...


class InTicks:
    """See the module; whatever it does holds up its tick, so ``has_time`` is False by default."""

    def __init__(self, has_time: bool = False) -> None:
        self.has_time = has_time
        self._task: Task | None = None
        self._handle = 0
        self._coming: Iterator[object] = iter(())
        self._points: list[object] = []

    @property
    def task(self) -> Task | None:
        """What is being done."""
        return self._task

    def warm(self) -> None:
        """Do nothing: it is ready."""

    def start(self, task: Task) -> int:
        """Begin a task and return its handle.

        Raises
        ------
        StudioError
            Where another one is not over.
        """
        if self._task is not None:
            raise StudioError(f"Cancel {self._task.name} first: one thing at a time")
        self._task, self._coming, self._points = task, task.points(), []
        self._handle += 1
        return self._handle

    def poll(self) -> Report | None:
        """Compute the task's next point, and tell of it; nothing without a task."""
        task = self._task
        if task is None:
            return None
        try:
            self._points.append(next(self._coming))
        except StudioError as error:
            self._task = None
            return failed(self._handle, task, tuple(self._points), Trouble(str(error)))
        except Exception:
            self._task = None  # it is over, whoever hears of the fault
            raise
        points = tuple(self._points)
        if len(points) < task.size:
            return Progress(self._handle, task, points)
        self._task = None
        return Done(self._handle, task, points)

    def cancel(self) -> None:
        """End the task."""
        self._task = None

    def close(self) -> None:
        """End the task."""
        self._task = None
