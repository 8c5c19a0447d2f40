"""How far long work has come, on standard error: one line that grows, or a line now and then."""

import sys
import time
from collections.abc import Callable
from typing import TextIO

from studio.console import log

WIDTH = 30  # characters of the bar
DRAWN_EVERY, SAID_EVERY = 0.1, 10.0  # [s] on a terminal, and into a file


class ProgressBar:
    """Is told how many are over, of how many; a context manager, so that its line ends."""

    def __init__(
        self, stream: TextIO | None = None, now: Callable[[], float] = time.monotonic
    ) -> None:
        self._stream = sys.stderr if stream is None else stream
        self._now = now
        self._begun: tuple[float, int] | None = None  # [s], and how many were over by then
        self._said = -float("inf")
        self._drawn = False

    def __call__(self, over: int, of: int) -> None:
        """Show it, if it was not shown a moment ago."""
        now = self._now()
        self._begun = self._begun or (now, over)
        on_terminal = self._stream.isatty()
        every = DRAWN_EVERY if on_terminal else SAID_EVERY
        if now - self._said < every and over < of:
            return
        self._said = now
        words = f"{over} of {of}{self._left(now, over, of)}"
        if on_terminal:
            done = WIDTH * over // of if of else WIDTH
            bar = "█" * done + "░" * (WIDTH - done)
            self._stream.write(f"\r\x1b[K{bar} {words}")
            self._stream.flush()
            self._drawn = True
        else:
            log(words)

    def __enter__(self) -> "ProgressBar":
        return self

    def __exit__(self, *_: object) -> None:
        if self._drawn:
            self._stream.write("\n")
            self._stream.flush()

    def _left(self, now: float, over: int, of: int) -> str:
        """Return how long it will take, as far as one can tell."""
        began, before = self._begun or (now, over)
        if over <= before or over >= of:
            return ""
        seconds = (now - began) / (over - before) * (of - over)
        return f", {seconds:.0f} s left" if seconds < 100 else f", {seconds / 60:.0f} min left"
