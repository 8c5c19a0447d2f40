"""Commands as messages. Written by docs/make_remote_schema.py: change it there."""

from studio.remote.files import File
from studio.remote.message import Message, Text


class CancelExport(Message, frozen=True):
    """Give up what is being written, of which nothing is kept, or else what is being opened."""


class Export(Message, frozen=True):
    """Write kinds of files from the listed demonstrations and what was learned from them."""

    kinds: tuple[Text, ...]  # of `studio.engine.export.apart.APART`
    anonymous: bool = False  # without the names of files, sources, demonstrations and bodies


class OpenSession(Message, frozen=True):
    """List what a session's archive holds, beside what is listed, and learn it again."""

    file: File
