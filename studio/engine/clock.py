"""The live loop: the only place in the engine that reads a clock."""

import threading
import time
from collections import deque
from collections.abc import Callable

from studio.engine.errors import StudioError
from studio.engine.pace import Pace
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.session import Session
from studio.engine.snapshot import Snapshot
from studio.engine.stepping import Steps

now = time.monotonic  # [s], for whoever is given a clock
BADLY_LATE = 5 * CONTROL_PERIOD  # [s]; behind by more, the loop skips ahead instead of racing
_LATELY = 3 * CONTROL_RATE  # ticks


def wait_until(due: float, stopping: threading.Event) -> bool:
    """Wait until ``due`` [s] by `now`; return whether to go on, False where ``stopping`` is set.

    Whoever plans the next moment from the last one planned, not from when it woke, does not drift.
    """
    return not stopping.wait(max(0.0, due - now()))


class LiveLoop:
    """Ticks a session at 30 Hz on a thread of its own, which alone builds and owns it.

    Drift-free: each tick is due one period after the last one was *due*. A live frame that the
    session awaits brings its tick forward, within its own period, so that frames hardly wait and
    ticks are still 30 a second. ``pace`` says how well it keeps up. ``speed`` makes the session's
    time pass faster than the clock's. Where a program has the clock (``steps``), ticks come as it
    asks for them. A context manager.
    """

    def __init__(self, build: Callable[[], Session], speed: float = 1.0) -> None:
        self.pace, self.steps = Pace(), Steps(now)
        self._watchers: tuple[Callable[[Snapshot], None], ...] = ()
        self._due: deque[int] = deque([0], _LATELY)  # for each tick of late: how many were due
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

    def watch(self, watcher: Callable[[Snapshot], None]) -> None:
        """Tell ``watcher`` every tick's snapshot, on the loop's thread: it must be quick."""
        self._watchers = (*self._watchers, watcher)

    def __enter__(self) -> "LiveLoop":
        self._thread.start()
        self._ready.wait()
        if self._failure is not None:
            self._thread.join()
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
            if self._ready.is_set():  # else whoever starts the loop raises it
                raise
        finally:
            self._ready.set()

    def _tick_until_stopped(self, session: Session) -> None:
        due = now()
        while self._wait_for_tick(session, due):
            self._tell(session.tick())
            if self.steps.is_due:
                self.steps.run(session, self._stopping, self._tell)
                due = now()
            due += self._period
            late = now() - due
            missed = int(late / self._period) if late > BADLY_LATE else 0
            due += missed * self._period
            self._note(missed)

    def _tell(self, snapshot: Snapshot) -> None:
        for watcher in self._watchers:
            watcher(snapshot)

    def _note(self, missed: int) -> None:
        """Take note of a tick, and of those that were given up after it."""
        skipped = self.pace.skipped + missed
        self._due.append(self._due[-1] + 1 + missed)
        self.pace = Pace((len(self._due) - 1) / (self._due[-1] - self._due[0]), skipped)

    def _wait_for_tick(self, session: Session, due: float) -> bool:
        """Wait until a tick is due, or a frame has come within the period before that."""
        awaited = session.awaited
        if awaited is not None and wait_until(due - self._period, self._stopping):
            awaited.wait(max(0.0, due - now()))
            due = now()
        return wait_until(due, self._stopping)
