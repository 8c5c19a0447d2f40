"""Files are read in a process of their own, one after the other, while the session goes on.

What was read comes over in small parts: to take in a long recording at once would hold up a tick.
"""

from collections import deque
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass, replace
from pathlib import Path

from studio.engine.commands.source import UseFile
from studio.engine.errors import FileError
from studio.engine.mcap_file import is_recording, read_recording
from studio.engine.recording import Recording, Sample
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.skeleton import Skeleton
from studio.engine.sources import SkeletonRecording, read_skeletons
from studio.engine.work import Done, Failed, Work

_PART = 100  # skeletons or samples; some 5 ms to take in
_TELL_EVERY = 0.2  # [s]


@dataclass(frozen=True)
class Share:
    """So much of a file has been read, 0 to 1."""

    share: float


@dataclass(frozen=True, eq=False)
class Part:
    """The next of what a file holds."""

    items: tuple[Skeleton | Sample, ...]


Content = SkeletonRecording | Recording


@dataclass(frozen=True)
class ReadFile:
    """The task: a `Share` now and then, the `Part` s, and the rest of what the file is."""

    file: UseFile
    size = 1  # nobody knows how many points there will be

    @property
    def name(self) -> str:
        """What it is about."""
        return f"reading {self.file.shown}"

    def points(self) -> Iterator[Share | Part | Content]:
        """Read; raise FileError, whose place is in the file of `name`, where it is of no use."""
        heard = [0.0]
        with ThreadPoolExecutor(1) as thread:  # so that there is somebody to tell how far it is
            result = thread.submit(self._read, heard)
            while not wait((result,), _TELL_EVERY).done:
                yield Share(heard[-1])
        yield Share(1.0)
        content = result.result()
        items = content.skeletons if isinstance(content, SkeletonRecording) else content.samples
        for start in range(0, len(items), _PART):
            yield Part(tuple(items[start : start + _PART]))
        yield _emptied(content)

    def _read(self, heard: list[float]) -> Content:
        path, name = self.file.path, self.file.shown
        try:
            if is_recording(path):
                return read_recording(path)
            return replace(read_skeletons(path, self.file.body, heard.append), path=name)
        except FileError as error:  # names the copy; the task's name says the user's own
            words = str(error).removeprefix(f"{path}: ").replace(str(path), name)
            raise FileError(words) from None


def whole(points: tuple[object, ...]) -> Content:
    """Return what a file holds, from all points of its `ReadFile`."""
    items = [item for point in points if isinstance(point, Part) for item in point.items]
    content = points[-1]
    if isinstance(content, SkeletonRecording):
        return replace(content, skeletons=tuple(i for i in items if isinstance(i, Skeleton)))
    if isinstance(content, Recording):
        return replace(content, samples=tuple(i for i in items if isinstance(i, Sample)))
    raise TypeError(f"a file that was read ends with its content, not with {content!r}")


@dataclass(frozen=True)
class ReadingStatus:
    """What is being read."""

    name: str  # as people know the file
    share: float | None  # that has been read; None while nobody can tell how long it takes
    waiting: int  # files after this one


@dataclass(frozen=True, eq=False)
class Found:
    """A file that was read."""

    file: UseFile
    content: Content
    number: int  # that came with the wish to read it


class Reading:
    """See the module. One thread uses it; `poll` belongs into every tick."""

    def __init__(self) -> None:
        self._time = 0.0  # [s] of ticks
        self._work = Work(lambda: self._time)
        self._waiting: deque[tuple[UseFile, int]] = deque()
        self._file: UseFile | None = None  # that is being read
        self._number = 0
        self._share: float | None = None

    def read(self, file: UseFile, number: int = 0) -> None:
        """Read a file as soon as those before it are read; it comes back with its ``number``."""
        self._waiting.append((file, number))

    def poll(self) -> Found | None:
        """Let a tick pass; return a file that has been read.

        Raises
        ------
        FileError
            Where it is of no use; the next one is read nevertheless.
        """
        self._time += CONTROL_PERIOD
        if self._file is None:
            self._begin()
            return None
        file, report = self._file, self._work.poll()
        if isinstance(report, Done):
            self._file = None
            return Found(file, whole(report.points), self._number)
        if isinstance(report, Failed):
            self._file = None
            raise FileError(report.words)
        if report is not None:
            shares = [point.share for point in report.points if isinstance(point, Share)]
            self._share = shares[-1] if shares and shares[-1] < 1.0 else None
        return None

    def cancel(self) -> str:
        """Give up all files, and return in words what became of them."""
        self._waiting.clear()
        if self._file is None:
            return ""
        given_up, self._file = self._file, None
        self._work.cancel()
        return f"Gave up reading {given_up.shown}."

    @property
    def status(self) -> ReadingStatus | None:
        """What is being read; None where nothing is."""
        if self._file is None:
            return None
        return ReadingStatus(self._file.shown, self._share, len(self._waiting))

    @property
    def files(self) -> frozenset[Path]:
        """Files that are being read, or wait for it."""
        waiting = frozenset(file.path for file, _ in self._waiting)
        return waiting if self._file is None else waiting | {self._file.path}

    def close(self) -> None:
        """Give up whatever is being read."""
        self._work.close()

    def _begin(self) -> None:
        if self._waiting:
            self._file, self._number = self._waiting.popleft()
            self._share = None
            self._work.start(ReadFile(self._file))


def _emptied(content: Content) -> Content:
    if isinstance(content, SkeletonRecording):
        return replace(content, skeletons=())
    return replace(content, samples=())
