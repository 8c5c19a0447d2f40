"""Threads share their heaps: the kernel's map of the process says how many arenas there are."""

import platform
import subprocess
import sys
from pathlib import Path

import pytest

# Many threads that allocate at once, each more than fits what is free; then count the arenas,
# which glibc maps at multiples of 64 MB.
_COUNT = """
import sys, threading
from studio.heap import share_heaps
if sys.argv[1] == "shared":
    share_heaps()
gate = threading.Barrier(12)
def allocate():
    gate.wait()
    kept = [bytes(60_000) for _ in range(200)]
    gate.wait()
threads = [threading.Thread(target=allocate) for _ in range(12)]
for each in threads: each.start()
for each in threads: each.join()
starts = [int(line.split("-")[0], 16) for line in open("/proc/self/maps")]
print(sum(start % (64 << 20) == 0 for start in starts))
"""


def arenas(how: str) -> int:
    root = Path(__file__).resolve().parents[1]
    command = [sys.executable, "-c", _COUNT, how]
    found = subprocess.run(command, capture_output=True, text=True, check=True, cwd=root)
    return int(found.stdout)


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="another C library's heaps")
def test_threads_share_their_heaps() -> None:
    assert arenas("shared") <= 2 < arenas("own")
