"""Trials that are over, in a file that is only ever appended to, so that none is done twice.

    {"format": "teaching-studio evaluation", "schema": 2, "versions": {...}, "scene": {...},
     "seed": 0, "widths": {"block": 0.03, ...}, "motions": {"model": "9f3c..."}}
    {"motion": "model", "trial": 0, "done": true, "why": ""}
    {"motion": "model", "trial": 1, "done": false, "why": "the block still stands"}

The first line says what the trials are of. A folder with another first line is refused, so that
no table is ever made of two things; how many trials are asked for is not in it, for more of the
same go on where the others ended. A process that is killed leaves at most a torn last line, which
is dropped: that trial is done once more, with the same outcome. A power cut costs the trials of a
second at most, for so often the file is brought to the disk. One process at a time has the file.
"""

import contextlib
import hashlib
import json
import math
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from importlib.metadata import version
from io import FileIO
from pathlib import Path
from typing import Any, Self

from numpy.typing import NDArray

import studio
from studio.engine.errors import FileError, StudioError
from studio.engine.evaluate.motion import Motion
from studio.engine.evaluate.trial import Outcome
from studio.engine.evaluate.variation import Variations, widths_of
from studio.engine.scene import Scene
from studio.engine.sources.strict_json import as_object, parse_json

if sys.platform != "win32":
    import fcntl

FILE = "trials.jsonl"
FORMAT, SCHEMA = "teaching-studio evaluation", 2  # 1 drew and judged otherwise
_LIBRARIES = ("numpy", "pybullet")  # what outcomes depend on
_SYNC_EVERY = 1.0  # [s]
_LARGEST = 1 << 30  # [bytes] of a file that is read; a trial takes some 80
_IN_WORDS = {
    "versions": "another version of the studio or its libraries",
    "scene": "another scene",
    "seed": "another seed",
    "widths": "other variations",
    "motions": "another model, or other demonstrations or networks",
}
Key = tuple[str, int]  # a motion's name, and the trial's number


def header_of(
    motions: Sequence[Motion], scene: Scene, widths: Variations, seed: int
) -> dict[str, Any]:
    """Return the first line of a file of such trials."""
    return {
        "format": FORMAT,
        "schema": SCHEMA,
        "versions": {"studio": studio.__version__, **{n: version(n) for n in _LIBRARIES}},
        "scene": json.loads(json.dumps(asdict(scene))),  # tuples as JSON has them
        "seed": seed,
        "widths": widths_of(widths),
        "motions": {motion.name: digest_of(motion) for motion in motions},
    }


def digest_of(motion: Motion) -> str:
    """Return a digest of all that makes up a motion, to the bit."""
    digest = hashlib.sha256(repr((motion.arms, motion.mapping, motion.duration)).encode())
    arrays: list[NDArray[Any]] = [motion.wanted, motion.sent]
    if motion.hands is not None:
        digest.update(repr(motion.hands.options).encode())
        arrays += [motion.hands.times, motion.hands.wrist, motion.hands.closed]
    for array in arrays:
        digest.update(repr((array.shape, array.dtype.str)).encode())
        digest.update(array.tobytes())
    return digest.hexdigest()


class Journal:
    """The trials of one evaluation; a context manager.

    Parameters
    ----------
    folder
        Where its file is, or will be; made if it is not there.
    header
        What the trials are of, see `header_of`.
    now
        The time [s]: what is kept is brought to the disk once a second. Without a clock that is
        done for each trial, which takes some milliseconds.

    Raises
    ------
    FileError
        Where the folder or its file cannot be used, or holds trials of something else.
    """

    def __init__(
        self, folder: Path, header: Mapping[str, Any], now: Callable[[], float] | None = None
    ) -> None:
        self._now, self._synced = now, -math.inf  # [s]
        self.path = folder / FILE
        self.known: dict[Key, Outcome] = {}
        self._header = dict(header)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._file: FileIO = self.path.open("ab", buffering=0)
        except OSError as error:
            raise FileError(f"{self.path}: cannot be used: {error.strerror}") from error
        try:
            self._begin()
        except OSError as error:
            self._file.close()
            raise FileError(f"{self.path}: cannot be used: {error.strerror}") from error
        except FileError:
            self._file.close()
            raise

    def add(self, key: Key, outcome: Outcome) -> None:
        """Keep a trial that is over; a kill from here on loses nothing of it.

        Nothing of a line that cannot be written whole stays in the file.

        Raises
        ------
        FileError
            Where it cannot be written.
        """
        name, trial = key
        try:
            self._write({"motion": name, "trial": trial, **asdict(outcome)})
        except OSError as error:
            raise FileError(f"{self.path}: cannot be written: {error.strerror}") from error
        self.known[key] = outcome

    def close(self) -> None:
        """Bring what is kept to the disk, and close the file.

        Raises
        ------
        FileError
            Where the disk cannot keep it.
        """
        with self._file:
            try:
                os.fsync(self._file.fileno())
            except OSError as error:
                raise FileError(f"{self.path}: cannot be written: {error.strerror}") from error

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _begin(self) -> None:
        """Take the file for this process alone, and take in what it holds."""
        try:
            _claim(self._file)
        except BlockingIOError as error:
            raise FileError(
                f"{self.path}: another evaluation is at work there; wait for its end, or choose "
                "another folder for --out"
            ) from error
        whole = self._read()
        self._whole = whole
        self._trim()  # a torn last line
        if whole == 0:
            self._write(self._header)
            _sync_folder(self.path.parent)  # or a power cut may take the file's name

    def _write(self, line: Mapping[str, Any]) -> None:
        """Append a line: all of it, or nothing and an OSError."""
        self._trim()  # where nothing could be done about the last one
        text = (json.dumps(line, allow_nan=False) + "\n").encode()
        rest = memoryview(text)
        try:
            while rest:  # where a disk is nearly full, a part of it is written at first
                rest = rest[self._file.write(rest) :]
        except OSError:
            with contextlib.suppress(OSError):
                self._trim()
            raise
        self._whole += len(text)
        now = math.inf if self._now is None else self._now()
        if now - self._synced >= _SYNC_EVERY:
            os.fsync(self._file.fileno())
            self._synced = -math.inf if self._now is None else now

    def _trim(self) -> None:
        """Cut off what lies behind the last whole line."""
        if os.fstat(self._file.fileno()).st_size > self._whole:
            self._file.truncate(self._whole)

    def _read(self) -> int:
        """Take in what is there, and return how many bytes of it are whole lines."""
        if self.path.stat().st_size > _LARGEST:
            raise FileError(f"{self.path}: larger than {_LARGEST:,} bytes; choose another folder")
        content = self.path.read_bytes()
        whole = content.rfind(b"\n") + 1
        for number, line in enumerate(content[:whole].splitlines(), start=1):
            try:
                table = as_object(parse_json(line.decode()), "a line")
                if number > 1:
                    self.known.update([_trial(table)])
            except (StudioError, UnicodeDecodeError) as error:
                raise FileError(
                    f"{self.path}: line {number}: {error}; choose another folder for --out, or "
                    "delete the file"
                ) from error
            if number == 1:
                self._check(table)
        return whole

    def _check(self, found: Mapping[str, object]) -> None:
        """Raise FileError where the trials that are there are of something else."""
        if found.get("format") != FORMAT or found.get("schema") != SCHEMA:
            raise FileError(f"{self.path}: holds no trials as this studio keeps them; {_CURE}")
        for key, words in _IN_WORDS.items():
            if found.get(key) != self._header[key]:
                raise FileError(f"{self.path}: holds trials of {words}; {_CURE}")


_CURE = "choose another folder for --out, or ask for the same as before"


def _claim(file: FileIO) -> None:
    """Keep others out until it is closed, or raise BlockingIOError; Windows has no such locks."""
    if sys.platform != "win32":
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _sync_folder(folder: Path) -> None:
    """Bring a folder's list of files to the disk; Windows does that by itself."""
    if sys.platform != "win32":
        opened = os.open(folder, os.O_RDONLY)
        with contextlib.suppress(OSError):  # a file system of a network may know no such thing
            os.fsync(opened)
        os.close(opened)


def _trial(table: Mapping[str, object]) -> tuple[Key, Outcome]:
    """Return what a line tells; raise StudioError where it is no trial."""
    match dict(table):
        case {"motion": str(name), "trial": int(trial), "done": bool(done), "why": str(why)}:
            return (name, trial), Outcome(done, why)
    raise StudioError("expected motion, trial, done and why")
