"""All formats in one place; a file's content tells which is its own, never its name."""

from studio.engine.errors import FileError, StudioError
from studio.engine.sources import jsonl, kinect2_socket, tables
from studio.engine.sources.content import decode
from studio.engine.sources.family import Family, ParsedFile, shown
from studio.engine.sources.unsupported import KNOWN_FORMATS

FAMILIES: tuple[Family, ...] = (jsonl.FAMILY, kinect2_socket.FAMILY, tables.FAMILY)
SUPPORTED = "; ".join(family.name for family in FAMILIES) + "; each plain or gzip"
_HEAD_BYTES = 64 * 1024  # enough to tell a format by


def parse(name: str, data: bytes) -> ParsedFile:
    """Return the frames of a file of that name (for messages) and content.

    Raises
    ------
    FileError
        Where the content is of no supported format, or not what its format asks for.
    """
    head = data[:_HEAD_BYTES].decode("utf-8-sig", errors="replace")
    family = _identify(name, head)
    text = decode(name, data)
    try:
        return family.read(text)
    except StudioError as error:
        raise FileError(
            f"{name}: {error} (read as {family.name}; supported: {SUPPORTED})"
        ) from None


def _identify(name: str, head: str) -> Family:
    for known in KNOWN_FORMATS:
        if known.recognizes(head):
            raise FileError(
                f"{name}: this is {known.name}, which this version does not read yet; "
                f"supported: {SUPPORTED}"
            )
    for family in FAMILIES:
        if family.recognizes(head):
            return family
    raise FileError(
        f"{name}: line 1: expected a recording of skeletons, found {shown(head[:40])}; "
        f"supported: {SUPPORTED}"
    )
