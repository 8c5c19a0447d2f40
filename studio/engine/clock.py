"""The live loop: the only place in the engine that reads a clock."""

import threading
import time
from collections.abc import Callable

from studio.engine.errors import StudioError
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.session import Session

BADLY_LATE = 5 * CONTROL_PERIOD  # [s]; behind by more, the loop skips ahead instead of racing


class LiveLoop:
    """Ticks a session at 30 Hz on a thread of its own, which alone builds and owns it.

    Drift-free: each tick is due one period after the last one was *due*. ``skipped`` counts the
    ticks that were given up because the machine was badly late. ``speed`` makes the session's time
    pass faster than the clock's. A context manager.
    """

    def __init__(self, build: Callable[[], Session], speed: float = 1.0) -> None:
        self.skipped = 0
        self._period = CONTROL_PERIOD / speed  # [s] of the clock
        self._build = build
        self._built: Session | None = None
        self._failure: BaseException | None = None
        self._ready, self._stopping = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run, name="engine")

    @property
    def session(self) -> Session:
        """The session, of which other threads may use ``post`` and ``snapshot``.

        Raises
        ------
        StudioError
            Where the loop is not running; the cause says why it ended.
        """
        if self._built is None or self._failure is not None:
            raise StudioError("the engine is not running") from self._failure
        return self._built

    def __enter__(self) -> "LiveLoop":
        self._thread.start()
        self._ready.wait()
        if self._failure is not None:
            raise self._failure
        return self

    def __exit__(self, *_: object) -> None:
        self._stopping.set()
        self._thread.join()

    def _run(self) -> None:
        try:
            self._built = self._build()
            self._ready.set()
            try:
                self._tick_until_stopped(self._built)
            finally:
                self._built.close()
        except BaseException as failure:
            self._failure = failure
            raise
        finally:
            self._ready.set()

    def _tick_until_stopped(self, session: Session) -> None:
        due = time.monotonic()
        while not self._stopping.wait(max(0.0, due - time.monotonic())):
            session.tick()
            due += self._period
            late = time.monotonic() - due
            if late > BADLY_LATE:
                missed = int(late / self._period)
                self.skipped += missed
                due += missed * self._period
