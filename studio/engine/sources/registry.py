"""All formats in one place; a file's content tells which is its own, never its name."""

from studio.engine.errors import FileError, StudioError
from studio.engine.sources import jsonl, kinect2_socket, landmarks, node_kinect2, ntu, tables
from studio.engine.sources.content import Content, content_of
from studio.engine.sources.family import Family, ParsedFile, shown

FAMILIES: tuple[Family, ...] = (
    jsonl.FAMILY,
    kinect2_socket.FAMILY,
    node_kinect2.FAMILY,
    node_kinect2.RECORDING_FAMILY,
    landmarks.FAMILY,
    landmarks.LIST_FAMILY,
    ntu.FAMILY,
    tables.FAMILY,
)
SUPPORTED = "; ".join(family.name for family in FAMILIES) + "; each plain or gzip"


def parse(name: str, data: bytes) -> ParsedFile:
    """Return the frames of a file that is at hand; its name is for messages."""
    return parse_content(content_of(name, data))


def parse_content(content: Content) -> ParsedFile:
    """Return the frames that a file's content amounts to.

    Raises
    ------
    FileError
        Where the content is of no supported format, or not what its format asks for.
    """
    head = content.head.decode("utf-8-sig", errors="replace")
    family = _identify(content.name, head)
    try:
        return family.read(content)
    except FileError:
        raise  # of the content, which names the file already
    except StudioError as error:
        raise FileError(
            f"{content.name}: {error} (read as {family.name}; supported: {SUPPORTED})"
        ) from None


def _identify(name: str, head: str) -> Family:
    for family in FAMILIES:
        if family.recognizes(head):
            return family
    raise FileError(
        f"{name}: line 1: expected a recording of skeletons, found {shown(head[:40])}; "
        f"supported: {SUPPORTED}"
    )
