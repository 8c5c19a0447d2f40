"""Memory that stays flat: glibc's allocator, told to let the threads share their heaps.

By default every thread gets an arena of its own, up to eight a core, and each keeps what it once
needed. In a soak a dozen of them held 140 MB of which little was in use, and grew for a quarter
of an hour (`tests/bench/bench_soak.py`).
"""

import ctypes
from contextlib import suppress

_M_ARENA_MAX = -8  # of malloc.h
ARENAS = 2


def share_heaps() -> None:
    """Let this process's threads share their heaps, where the C library is glibc."""
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).mallopt(_M_ARENA_MAX, ARENAS)
