"""A clock for tests in which threads talk to each other: it waits for a machine that is busy.

It goes on by a little each time that its own thread gets its turn, never by more. Where other
processes take the processor, or the whole machine stands still, its time passes as much slower as
all that is tested: what comes late by it is late by fault, and not for want of a processor.
"""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

STEP = 0.0005  # [s]; so 0.2 s, after which a robot's state is stale, are 400 turns
PATIENCE = 120.0  # [s] of the machine's own time, for what has to come


class Unhurried:
    """See the module; called, it returns its time [s]."""

    def __init__(self) -> None:
        self._time, self._stands = 100.0, False

    def __call__(self) -> float:
        return self._time

    def sleep(self, seconds: float) -> None:
        """Wait until so much of its time has passed."""
        due = self._time + seconds
        eventually(lambda: self._time >= due)

    @contextmanager
    def standing(self) -> Iterator[None]:
        """Let no time pass, while the test's own thread has much to do."""
        self._stands = True
        try:
            yield
        finally:
            self._stands = False

    @contextmanager
    def running(self) -> Iterator[None]:
        closing = threading.Event()
        thread = threading.Thread(target=self._run, args=(closing,), daemon=True)
        thread.start()
        yield
        closing.set()
        thread.join()

    def _run(self, closing: threading.Event) -> None:
        before = time.monotonic()
        while not closing.is_set():
            time.sleep(STEP)
            now = time.monotonic()
            self._time += 0.0 if self._stands else min(now - before, STEP)
            before = now


CLOCK = Unhurried()  # runs while tests of links do: see conftest.py


def eventually(reached: Callable[[], object], words: Callable[[], str] = lambda: "") -> None:
    """Wait until something is so, however long a busy machine takes."""
    deadline = time.monotonic() + PATIENCE
    while not reached():
        assert time.monotonic() < deadline, f"it never came to that {words()}"
        time.sleep(0.001)
