"""Commands as messages. Written by docs/make_remote_schema.py: change it there."""

from typing import Literal

from studio.remote.files import File
from studio.remote.message import Message, Text


class CancelReading(Message, frozen=True):
    """Give up the files that are being read or wait for it."""


class DragElbow(Message, frozen=True):
    """Drag the puppet's elbow to a point [m] of camera space."""

    side: Literal["left", "right"]
    point: tuple[float, float, float]


class DragHand(Message, frozen=True):
    """Drag the puppet's hand to a point [m] of camera space."""

    side: Literal["left", "right"]
    point: tuple[float, float, float]


class FollowBody(Message, frozen=True):
    """Follow another body of the chosen file or stream, by its id; None: whoever is nearest."""

    body: Text | None


class PuppetHome(Message, frozen=True):
    """Let the puppet hold both hands before it again, and sign nothing."""


class ReleaseElbow(Message, frozen=True):
    """Let the puppet's elbow hang easily again."""

    side: Literal["left", "right"]


class Sign(Message, frozen=True):
    """Let the puppet's hand show a sign until the next one; Unknown is none."""

    side: Literal["left", "right"]
    state: Literal["unknown", "not_tracked", "open", "closed", "lasso"]


class UseDemonstrator(Message, frozen=True):
    """Take the built-in demonstrator's next take as the source."""


class UseFile(Message, frozen=True):
    """Take a skeleton file as the source, or add an MCAP recording's demonstrations.

    It is read in another process; the session goes on meanwhile.
    """

    file: File
    body: Text | None = None  # whom to follow in it; None: whoever is nearest


class UseLive(Message, frozen=True):
    """Take whoever sends a live stream as the source."""


class UsePuppet(Message, frozen=True):
    """Take the puppet as the source."""
