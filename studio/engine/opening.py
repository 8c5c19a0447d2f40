"""Sessions' archives are opened in a process of their own, while the session goes on.

What is in one comes over in small parts: to take in long recordings at once would hold up a tick.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from studio.engine.commands.export import OpenSession
from studio.engine.errors import FileError
from studio.engine.export.material import Material, Take
from studio.engine.export.session_reader import open_session
from studio.engine.recording import Recording, Sample
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.work import Done, Failed, Work

_PART = 100  # samples; some 5 ms to take in


@dataclass(frozen=True, eq=False)
class Part:
    """The next samples of a recording."""

    samples: tuple[Sample, ...]


@dataclass(frozen=True, eq=False)
class Bare:
    """All of a session but the samples, and which recording each take is of."""

    material: Material
    places: tuple[int, ...]


@dataclass(frozen=True)
class ReadSession:
    """The task: the `Part` s of every recording, each ended by what else it is, then a `Bare`."""

    command: OpenSession
    size = 1  # nobody knows how many points there will be

    @property
    def name(self) -> str:
        """What it is about."""
        return f"opening {self.command.shown}"

    def points(self) -> Iterator[Part | Recording | Bare]:
        """Read; raise FileError, which knows the file as the user does, where it is of no use."""
        path, shown = self.command.path, self.command.shown
        try:
            material = open_session(path)
        except FileError as error:  # names the copy; the user knows the file by its own name
            raise FileError(str(error).replace(str(path), shown)) from None
        for recording in material.recordings:
            for start in range(0, len(recording.samples), _PART):
                yield Part(recording.samples[start : start + _PART])
            yield replace(recording, samples=())
        yield _bare(material)


def whole(points: tuple[object, ...]) -> Material:
    """Return what an archive holds, from all points of its `ReadSession`."""
    recordings: list[Recording] = []
    samples: list[Sample] = []
    for point in points:
        if isinstance(point, Part):
            samples += point.samples
        elif isinstance(point, Recording):
            recordings.append(replace(point, samples=tuple(samples)))
            samples = []
        elif isinstance(point, Bare):
            takes = tuple(
                replace(take, recording=recordings[place])
                for take, place in zip(point.material.takes, point.places, strict=True)
            )
            return replace(point.material, takes=takes)
    raise TypeError("a session that was read ends with all but its samples")


@dataclass(frozen=True, eq=False)
class Opened:
    """An archive that was read."""

    name: str  # as people know it
    material: Material


class Opening:
    """See the module. One thread uses it; `poll` belongs into every tick."""

    def __init__(self) -> None:
        self._time = 0.0  # [s] of ticks
        self._work = Work(lambda: self._time)
        self._command: OpenSession | None = None  # whose archive is being read

    def open(self, command: OpenSession) -> str:
        """Begin to open an archive; raise StudioError where another one is not through."""
        self._work.start(ReadSession(command))
        self._command = command
        return f"Opening {command.shown}."

    @property
    def name(self) -> str:
        """The archive that is being read, as people know it; nothing where none is."""
        return "" if self._command is None else self._command.shown

    @property
    def path(self) -> Path | None:
        """Where that archive lies."""
        return None if self._command is None else self._command.path

    def poll(self) -> Opened | None:
        """Let a tick pass; return an archive once it has been read.

        Raises
        ------
        FileError
            Where it is of no use.
        """
        if self._command is None:
            return None
        self._time += CONTROL_PERIOD
        report, name = self._work.poll(), self._command.shown
        if isinstance(report, Done):
            self._command = None
            return Opened(name, whole(report.points))
        if isinstance(report, Failed):
            self._command = None
            raise FileError(report.words)
        return None

    def cancel(self) -> str:
        """Give up the archive that is being read, and return in words which."""
        given_up, self._command = self.name, None
        if not given_up:
            return ""
        self._work.cancel()
        return f"Gave up opening {given_up}."

    def close(self) -> None:
        """Give up whatever is being read."""
        self._work.close()


def _bare(material: Material) -> Bare:
    place = {id(recording): i for i, recording in enumerate(material.recordings)}
    bare = [replace(recording, samples=()) for recording in material.recordings]
    places = tuple(place[id(take.recording)] for take in material.takes)
    takes = tuple(
        Take(take.demonstration, bare[at], take.included)
        for take, at in zip(material.takes, places, strict=True)
    )
    return Bare(replace(material, takes=takes), places)
