"""How a program names files: its own, which it uploads, and those that the studio has."""

from studio.remote.message import Message, Text


class Uploaded(Message, frozen=True):
    """A file that this connection has uploaded."""

    upload: Text  # as the answer to its last part named it


class Recorded(Message, frozen=True):
    """A file in the studio's recordings folder."""

    name: Text


class Sample(Message, frozen=True):
    """A recording that comes with the studio."""

    name: Text


class OnStudio(Message, frozen=True):
    """A recording, a session or a folder of both, on the machine that runs the studio."""

    path: Text


File = Uploaded | Recorded | Sample
Place = Uploaded | Recorded | Sample | OnStudio
