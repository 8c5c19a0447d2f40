"""Skeletons alone as MCAP: the channel /skeleton of a recording, with all bodies, and no robot.

Each message is a frame object of our JSONL (`studio.engine.sources.jsonl`); its log time is in ns
since the first one. The file's metadata say ``holds: skeletons``, what was read and what that told.
"""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from studio.engine.errors import FileError, StudioError
from studio.engine.mcap_log import LogReader, LogWriter
from studio.engine.skeleton import Skeleton
from studio.engine.sources.content import MAXIMUM_STREAM_BYTES
from studio.engine.sources.family import TELLS, ParsedFile, check_body_id, check_time, gather
from studio.engine.sources.jsonl import frame_from_message, nobody_to_dict, skeleton_to_dict

FORMAT = "studio mcap skeletons 1"
HOLDS = "skeletons"  # what the metadata's "holds" says
TOPIC = "/skeleton"
_CHUNK_BYTES = 1024 * 1024
_LATEST_STAMP = 2**63 - 1  # [ns]; a stamp beyond is of no use to any viewer
_NUMBERS = {"type": "array", "items": {"type": "number"}}
_HAND = {
    "type": "object",
    "properties": {"state": {"type": "string"}, "confidence": {"type": "number"}},
    "required": ["state"],
}
SKELETON_SCHEMA: dict[str, Any] = {
    "type": "object",
    "properties": {
        "skeleton": {"type": "integer"},
        "time": {"type": "number", "description": "s, the sensor's own"},
        "body": {"type": "string"},
        "positions": {"type": "array", "items": _NUMBERS, "description": "25 x 3, m"},
        "tracking": {"type": "array", "items": {"type": "integer"}},
        "left_hand": _HAND,
        "right_hand": _HAND,
    },
    "required": ["time"],
}


def write(path: Path, parsed: ParsedFile) -> None:
    """Write all bodies of all frames to a new file.

    Raises
    ------
    StudioError
        Where time runs backwards, or a body's id could not be read again.
    OSError
        Where the file cannot be written.
    """
    metadata = {
        "schema_version": "1",
        "holds": HOLDS,
        "source": parsed.format,
        "tells": " ".join(parsed.tells),
    }
    with path.open("wb") as file:
        log = LogWriter(file, metadata, {TOPIC: SKELETON_SCHEMA}, _CHUNK_BYTES)
        previous: float | None = None
        first = parsed.frames[0].time if parsed.frames else 0.0
        for number, frame in enumerate(parsed.frames):
            check_time(frame.time, previous)
            previous = frame.time
            stamp = min(round((frame.time - first) * 1e9), _LATEST_STAMP)
            for message in _messages(frame.time, frame.bodies):
                log.write(TOPIC, stamp, message, number)
        log.finish()


def read(path: Path) -> ParsedFile:
    """Return all frames of a file with all their bodies.

    Raises
    ------
    FileError
        Where the file cannot be opened, is damaged or larger than any skeleton file may be, or
        holds something else.
    """
    try:
        size = path.stat().st_size
        with path.open("rb") as file:
            log = LogReader(file, size, MAXIMUM_STREAM_BYTES)
            frames = gather(_entries(log))
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror}") from error
    except StudioError as error:
        raise FileError(f"{path}: {error} (read as {FORMAT})") from None
    if log.problem:
        raise FileError(
            f"{path}: after {log.whole:,} of {size:,} bytes: expected MCAP to its end, found it "
            f"damaged or cut off ({log.problem}); fetch or convert the file again"
        )
    tells = log.metadata.get("tells", "").split()
    hands, tracking, stamps = (name in tells for name in TELLS)
    return ParsedFile(FORMAT, frames, hands, tracking, stamps)


def holds_skeletons(path: Path) -> bool:
    """Tell whether an MCAP file says that it holds skeletons and nothing else."""
    try:
        with path.open("rb") as file:
            log = LogReader(file, path.stat().st_size, MAXIMUM_STREAM_BYTES)
            next(iter(log), None)
    except OSError:
        return False
    return log.metadata.get("holds") == HOLDS


def _messages(time: float, bodies: Iterable[Skeleton]) -> Iterator[dict[str, object]]:
    bodies = tuple(bodies)
    for body in bodies:
        check_body_id(body.body_id)
        yield skeleton_to_dict(body)
    if not bodies:
        yield nobody_to_dict(time)


def _entries(log: LogReader) -> Iterator[tuple[float, Skeleton | None]]:
    previous: float | None = None
    for number, (topic, message) in enumerate(log):
        if topic != TOPIC:
            raise StudioError(f"expected messages of {TOPIC} only, found one of {topic!r:.40}")
        try:
            frame = frame_from_message(message)
            check_time(frame.time, previous)
        except StudioError as error:
            raise StudioError(f"message {number}: {error}") from None
        previous = frame.time
        for body in frame.bodies or (None,):
            yield frame.time, body
