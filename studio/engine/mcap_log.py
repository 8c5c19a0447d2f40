"""MCAP files of JSON messages, whatever they tell: written chunk by chunk, read up to any damage.

Reading never unpickles, checks every chunk's checksum, and takes a chunk whole or not at all.
"""

import json
import struct
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO, Final

import zstandard
from mcap.exceptions import McapError
from mcap.records import Channel, Chunk, Message, Metadata
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import CompressionType, Writer

import studio
from studio.engine.errors import StudioError

MAGIC: Final = b"\x89MCAP0\r\n"
LARGEST_CHUNK = 64 << 20  # [bytes] unpacked: ours are a thousandth of it
_METADATA = "studio"  # the name of the record that says what a file is


class LogWriter:
    """Writes JSON messages to an open file, which it does not close."""

    def __init__(
        self,
        file: BinaryIO,
        metadata: Mapping[str, str],
        schemas: Mapping[str, Mapping[str, Any]],
        chunk_bytes: int,
    ) -> None:
        self._writer = Writer(file, chunk_size=chunk_bytes, compression=CompressionType.ZSTD)
        self._writer.start(profile="", library="teaching-studio")
        self._writer.add_metadata(_METADATA, {**metadata, "studio": studio.__version__})
        self._channels = {
            topic: self._writer.register_channel(
                topic,
                "json",
                self._writer.register_schema(
                    topic.strip("/"), "jsonschema", json.dumps(schema).encode()
                ),
            )
            for topic, schema in schemas.items()
        }

    def write(self, topic: str, stamp: int, message: Mapping[str, Any], number: int) -> None:
        """Append a message at a stamp [ns]; messages that belong together share a number."""
        data = json.dumps(message, allow_nan=False, separators=(",", ":")).encode()
        self._writer.add_message(self._channels[topic], stamp, data, stamp, number)

    def finish(self) -> None:
        """Write the index."""
        self._writer.finish()  # type: ignore[no-untyped-call]


class LogReader:
    """The messages of a file as (topic, value), in their order, as far as the file is whole.

    To be gone through once; only then do ``problem`` and ``whole`` tell what is missing.
    ``metadata`` are there from the first message on. Files that unpack to more than ``most`` bytes
    are broken off there.
    """

    def __init__(self, file: BinaryIO, size: int, most: int) -> None:
        self.metadata: dict[str, str] = {}
        self.problem = ""  # why reading stopped before the end, if it did
        self.whole = 0  # [bytes] that were read without complaint
        self._file, self._left = file, most
        self._records = StreamReader(file, emit_chunks=True, record_size_limit=max(size, 1)).records
        self._topics: dict[int, str] = {}

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        while messages := self._next_messages():
            yield from messages

    def _next_messages(self) -> list[tuple[str, Any]]:
        """Return the next chunk's messages, none at the end or where the file is broken."""
        try:
            for record in self._records:
                found = self._messages_in(record)
                self.whole = self._file.tell()
                if found:
                    return found
        except BROKEN as error:
            self.problem = ascii(str(error))[1:-1] or type(error).__name__
        return []

    def _messages_in(self, record: object) -> list[tuple[str, Any]]:
        if isinstance(record, Metadata) and record.name == _METADATA:
            self.metadata = record.metadata
        if not isinstance(record, Chunk):
            return []
        self._check_size(record)
        found: list[tuple[str, Any]] = []
        for inner in breakup_chunk(record, validate_crc=True):
            if isinstance(inner, Channel):
                self._topics[inner.id] = inner.topic
            elif isinstance(inner, Message):
                found.append((self._topics[inner.channel_id], json.loads(inner.data)))
        return found

    def _check_size(self, chunk: Chunk) -> None:
        """Raise StudioError before a chunk is unpacked that says, or is, larger than it may be."""
        size = chunk.uncompressed_size
        if chunk.compression != "zstd" or size > LARGEST_CHUNK:
            raise StudioError(f"a chunk of {size:,} {chunk.compression} bytes is not the studio's")
        if zstandard.frame_content_size(chunk.data) not in (-1, size):
            raise StudioError("a chunk tells two sizes")
        self._left -= size
        if self._left < 0:
            raise StudioError("the file unpacks to more than is read; cut it")


def is_mcap(path: Path) -> bool:
    """Tell whether a file begins as MCAP does; a missing file does not, nor a pipe or a device."""
    try:
        if not path.is_file():  # to open a pipe would wait for whoever writes into it
            return False
        with path.open("rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except (OSError, ValueError):  # ValueError: a name with a zero byte in it
        return False


# What the reader and the decompressor raise on damage; all of it means "stop here".
BROKEN = (
    McapError,
    StudioError,
    EOFError,
    ValueError,
    KeyError,
    TypeError,
    OverflowError,
    MemoryError,
    RecursionError,
    struct.error,
    zstandard.ZstdError,
)
