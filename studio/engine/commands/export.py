"""How people take their work out of the studio, and bring it in again."""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Export:
    """Write kinds of files from the listed demonstrations and what was learned from them."""

    kinds: tuple[str, ...]  # of `studio.engine.export.apart.APART`
    anonymous: bool = False  # without the names of files, sources, demonstrations and bodies


@dataclass(frozen=True)
class CancelExport:
    """Give up what is being written, of which nothing is kept, or else what is being opened."""


@dataclass(frozen=True)
class OpenSession:
    """List what a session's archive holds, beside what is listed, and learn it again."""

    path: Path
    name: str = ""  # as the user knows the file, if the path is a copy

    @property
    def shown(self) -> str:
        """The file's name for people."""
        return self.name or self.path.name


ExportCommand = Export | CancelExport | OpenSession
