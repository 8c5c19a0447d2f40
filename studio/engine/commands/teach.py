"""How people keep the list of demonstrations; each is named by its number, which stays."""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Choose:
    """Choose the demonstration that is shown as a ghost and beside the reproduction."""

    number: int


@dataclass(frozen=True)
class Include:
    """Learn from a demonstration, or leave it out."""

    number: int
    included: bool


@dataclass(frozen=True)
class Trim:
    """Keep of a demonstration what lies between two moments of it, as it was recorded."""

    number: int
    begin: float  # [s]
    end: float  # [s]


@dataclass(frozen=True)
class Rename:
    """Call a demonstration something else."""

    number: int
    name: str


@dataclass(frozen=True)
class Remove:
    """Delete a demonstration; `Restore` brings it back until the next one is deleted."""

    number: int


@dataclass(frozen=True)
class Restore:
    """Bring back what was deleted last."""


@dataclass(frozen=True)
class DeleteForGood:
    """Delete what was deleted last beyond recall, its file too."""


@dataclass(frozen=True)
class OpenRecording:
    """List the demonstrations of a file in the recordings folder."""

    name: str  # of the file


@dataclass(frozen=True)
class AddFrom:
    """List the demonstrations of a recording, of a session's archive, or of a folder of both."""

    path: Path
    name: str = ""  # as the user knows it, if the path is a copy

    @property
    def shown(self) -> str:
        """Its name for people."""
        return self.name or self.path.name


@dataclass(frozen=True)
class BeginTake:
    """Record from now on, while Baxter is watching: a take by hand."""


@dataclass(frozen=True)
class EndTake:
    """End the take that was begun by hand, list it, and go on watching."""


TakeCommand = BeginTake | EndTake
ListCommand = Choose | Include | Trim | Rename
KeepCommand = Remove | Restore | DeleteForGood | OpenRecording | AddFrom
TeachCommand = ListCommand | KeepCommand
