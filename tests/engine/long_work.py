"""Tasks for the tests of work in another process, which has to find them in a module."""

import os
import time
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

from studio.engine.errors import StudioError

PATIENCE = 120.0  # [s] for a busy machine to start a process that steps back behind all others


def is_gone(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return True
    return False


@dataclass(frozen=True)
class Counting:
    """Tells the numbers up to ``size``, and then whose process it was."""

    size: int
    name = "counting"

    def points(self) -> Iterator[int]:
        yield from range(self.size - 1)
        yield os.getpid()


@dataclass(frozen=True)
class Slow:
    """A point every ``seconds``."""

    size: int
    seconds: float
    name = "waiting"

    def points(self) -> Iterator[int]:
        for number in range(self.size):
            time.sleep(self.seconds)
            yield number


@dataclass(frozen=True)
class Surroundings:
    """Tells how many threads its linear algebra may have."""

    name, size = "looking around", 1

    def points(self) -> Iterator[str]:
        yield os.environ.get("OPENBLAS_NUM_THREADS", "")


@dataclass(frozen=True)
class Endless:
    """Tells whose process it is, then computes for ever and listens to nobody."""

    name, size = "brooding", 2

    def points(self) -> Iterator[int]:
        yield os.getpid()
        for _ in count():
            sum(range(100_000))


@dataclass(frozen=True)
class Failing:
    """Fails after one point: for a reason that a person can cure, or for none."""

    curable: bool
    name, size = "failing", 2

    def points(self) -> Iterator[int]:
        yield 1
        if self.curable:
            raise StudioError("record a demonstration first")
        raise ZeroDivisionError("nothing to divide by")
