"""Every reader against damaged files: nothing but a recording or a FileError may come out.

Run it by ``python tests/bench/bench_fuzz_readers.py [--inputs 100000] [--seed 0]``; a hundred
thousand take three minutes. It prints a row a format and fails where anything else is raised,
an input takes longer than `SLOWEST`, or memory grows by more than `GROWTH`.
"""

import argparse
import gc
import gzip
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from studio.engine.conversion import read_any
from studio.engine.errors import FileError
from studio.engine.resources import samples_folder
from studio.engine.sources import mcap_skeletons
from studio.engine.sources.family import ParsedFile
from studio.engine.sources.jsonl import frames_to_lines
from studio.engine.sources.registry import parse
from tests.engine.corruption import corrupted
from tests.engine.skeleton_files import landmark_files, skeleton_files

SLOWEST = 5.0  # [s] for files of some kilobytes; this machine may be busy with other things
GROWTH = 64.0  # [MB] of the peak after the first tenth of the inputs
Reader = Callable[[bytes], ParsedFile]


@dataclass
class Row:
    """What became of one format's inputs."""

    name: str
    inputs: int = 0
    accepted: int = 0
    slowest: float = 0.0  # [s]
    growth: float = 0.0  # [MB] that the process's peak grew by

    def __str__(self) -> str:
        refused = self.inputs - self.accepted
        return (
            f"| {self.name} | {self.inputs:,} | {self.accepted:,} | {refused:,} "
            f"| {1000 * self.slowest:.0f} ms | {self.growth:.1f} MB |"
        )


def subjects(folder: Path) -> dict[str, tuple[bytes, Reader]]:
    """Return a whole file of each format, and what reads it."""
    scratch = folder / "scratch"

    def from_disk(data: bytes) -> ParsedFile:
        scratch.write_bytes(data)
        return read_any(scratch)[0]

    def from_memory(data: bytes) -> ParsedFile:
        return parse("mangled", data)

    texts = {**skeleton_files(), **{f"landmarks, {k}": v for k, v in landmark_files().items()}}
    found: dict[str, tuple[bytes, Reader]] = {
        name: (data, from_memory) for name, data in texts.items()
    }
    found["gzip"] = (gzip.compress(texts["ntu rgb+d"], mtime=0), from_disk)
    mcap_skeletons.write(folder / "skeletons.mcap", parse("x", texts["studio jsonl 1"]))
    found["mcap, skeletons"] = ((folder / "skeletons.mcap").read_bytes(), from_disk)
    recording = (samples_folder() / "demonstration-1.mcap").read_bytes()
    found["mcap, a recording"] = (recording[:60_000], from_disk)  # cut off: the rest is the same
    return found


def attack(name: str, whole: bytes, reader: Reader, inputs: int, rng: np.random.Generator) -> Row:
    """Read damaged copies of a file; raise what is no FileError, with the input kept."""
    row, before = Row(name), peak()
    for number in range(inputs):
        data = corrupted(whole, rng)
        start = time.perf_counter()
        try:
            for _ in frames_to_lines(reader(data).frames):
                pass  # what was read can be written
            row.accepted += 1
        except FileError as error:
            if not str(error).isprintable():
                raise AssertionError(
                    f"{name}: a message that is not one line: {error!r}"
                ) from error
        except BaseException:
            Path("crash.bin").write_bytes(data)
            print(f"{name}: input {number} is kept in crash.bin", file=sys.stderr)
            raise
        row.slowest = max(row.slowest, time.perf_counter() - start)
        row.inputs += 1
        if number == inputs // 10:
            gc.collect()
            before = peak()
    row.growth = peak() - before
    return row


def peak() -> float:
    """Return the most memory that the process has held so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main() -> int:
    """Attack every format; return 1 where one is too slow or keeps memory."""
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--inputs", type=int, default=100_000)
    arguments.add_argument("--seed", type=int, default=0)
    given = arguments.parse_args()
    print("| format | inputs | accepted | refused | slowest | peak's growth |")
    print("|---|---|---|---|---|---|")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        files = subjects(Path(folder))
        for number, (name, (whole, reader)) in enumerate(files.items()):
            rng = np.random.default_rng([given.seed, number])
            rows.append(attack(name, whole, reader, given.inputs // len(files) + 1, rng))
            print(rows[-1], flush=True)
    total = Row("all", sum(row.inputs for row in rows), sum(row.accepted for row in rows))
    total.slowest = max(row.slowest for row in rows)
    total.growth = sum(row.growth for row in rows)
    print(total)
    return int(total.slowest > SLOWEST or total.growth > GROWTH)


if __name__ == "__main__":
    sys.exit(main())
