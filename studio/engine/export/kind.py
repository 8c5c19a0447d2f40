"""What every kind of export is: a name, what it lacks, and how it is written."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from studio.engine.errors import StudioError
from studio.engine.export.material import Material

Progress = Callable[[float], bool]  # is told the share that is done, and answers whether to go on
Timer = Callable[[], float]  # [s], rising


class StoppedError(StudioError):
    """Whoever asked for an export stopped it; nothing of it is left behind."""


def _always_on(_: float) -> bool:
    return True


def _no_time() -> float:
    return 0.0


@dataclass(frozen=True)
class Job:
    """Where to write, and whom to tell how far it is."""

    folder: Path
    progress: Progress = _always_on
    timer: Timer = _no_time  # the engine reads no clock; without one, the report tells no times

    def done(self, share: float) -> None:
        """Tell that a share of the work, 0 to 1, is done; raise StoppedError if it is to stop."""
        if not self.progress(share):
            raise StoppedError("the export was stopped; nothing of it was kept")

    def part(self, begin: float, end: float) -> "Job":
        """Return the job of doing what lies between two shares of this one."""
        return replace(self, progress=lambda share: self.progress(begin + (end - begin) * share))


@dataclass(frozen=True)
class Kind:
    """One kind of export."""

    name: str
    words: str  # what one gets, for people
    files: tuple[str, ...]  # the names of what is written, as patterns
    lacks: Callable[[Material], str]  # what is missing before it can be written, or nothing
    write: Callable[[Material, Job], tuple[Path, ...]]  # -> the files that were written


# What a studio writes before anything is learned; all other kinds tell of what was.
WITHOUT_LESSON = frozenset({"mcap", "html", "zip"})


def lacks_nothing(_: Material) -> str:
    """Return nothing: a kind that can always be written."""
    return ""


def lacks_lesson(material: Material) -> str:
    """Return why there is nothing learned to export, or nothing."""
    if material.lesson is None:
        return "Train first: there is nothing learned yet"
    if material.learned_from is None:
        return "Train again: a demonstration that this was learned from is no longer listed"
    return ""


def lacks_reproduction(material: Material) -> str:
    """Return why there is no reproduction to export, or nothing."""
    if material.reproduction is None:
        return lacks_lesson(material) or "Let Baxter do it alone first"
    return lacks_lesson(material)
