"""Commands as messages. Written by docs/make_remote_schema.py: change it there."""

from studio.remote.files import Place
from studio.remote.message import Message, Text


class AddFrom(Message, frozen=True):
    """List the demonstrations of a recording, of a session's archive, or of a folder of both."""

    file: Place


class BeginTake(Message, frozen=True):
    """Record from now on, while Baxter is watching: a take by hand."""


class Choose(Message, frozen=True):
    """Choose the demonstration that is shown as a ghost and beside the reproduction."""

    number: int


class DeleteForGood(Message, frozen=True):
    """Delete what was deleted last beyond recall, its file too."""


class EndTake(Message, frozen=True):
    """End the take that was begun by hand, list it, and go on watching."""


class Include(Message, frozen=True):
    """Learn from a demonstration, or leave it out."""

    number: int
    included: bool


class OpenRecording(Message, frozen=True):
    """List the demonstrations of a file in the recordings folder."""

    name: Text  # of the file


class Remove(Message, frozen=True):
    """Delete a demonstration; `Restore` brings it back until the next one is deleted."""

    number: int


class Rename(Message, frozen=True):
    """Call a demonstration something else."""

    number: int
    name: Text


class Restore(Message, frozen=True):
    """Bring back what was deleted last."""


class Trim(Message, frozen=True):
    """Keep of a demonstration what lies between two moments of it, as it was recorded."""

    number: int
    begin: float  # [s]
    end: float  # [s]
