"""How people choose who teaches, and how they drag the puppet."""

from dataclasses import dataclass
from pathlib import Path

from studio.engine.skeleton import HandState, Side
from studio.engine.vectors import Vector


@dataclass(frozen=True)
class UseDemonstrator:
    """Take the built-in demonstrator's next take as the source."""


@dataclass(frozen=True)
class UseFile:
    """Take a skeleton file as the source, or add an MCAP recording's demonstrations.

    It is read in another process; the session goes on meanwhile.
    """

    path: Path
    name: str = ""  # as the user knows the file, if the path is a copy
    body: str | None = None  # whom to follow in it; None: whoever is nearest

    @property
    def shown(self) -> str:
        """The file's name for people."""
        return self.name or self.path.name


@dataclass(frozen=True)
class FollowBody:
    """Follow another body of the chosen file or stream, by its id; None: whoever is nearest."""

    body: str | None


@dataclass(frozen=True)
class CancelReading:
    """Give up the files that are being read or wait for it."""


@dataclass(frozen=True)
class UseLive:
    """Take whoever sends a live stream as the source."""


@dataclass(frozen=True)
class UsePuppet:
    """Take the puppet as the source."""


@dataclass(frozen=True)
class DragHand:
    """Drag the puppet's hand to a point [m] of camera space."""

    side: Side
    point: Vector


@dataclass(frozen=True)
class DragElbow:
    """Drag the puppet's elbow to a point [m] of camera space."""

    side: Side
    point: Vector


@dataclass(frozen=True)
class ReleaseElbow:
    """Let the puppet's elbow hang easily again."""

    side: Side


@dataclass(frozen=True)
class Sign:
    """Let the puppet's hand show a sign until the next one; Unknown is none."""

    side: Side
    state: HandState


@dataclass(frozen=True)
class PuppetHome:
    """Let the puppet hold both hands before it again, and sign nothing."""


PuppetCommand = DragHand | DragElbow | ReleaseElbow | Sign | PuppetHome
FileCommand = UseFile | FollowBody | CancelReading
SourceCommand = UseDemonstrator | FileCommand | UseLive | UsePuppet | PuppetCommand
