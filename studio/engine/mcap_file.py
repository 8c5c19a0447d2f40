"""Recordings as MCAP: the robotics field's append-only log, which opens in Foxglove as it is.

Channels /skeleton, /gate, /command, /joint_states and /world, JSON with a schema, in zstd chunks.
Every tick writes them in this order with one log time, so a tick is whole once its /world is there.
Reading never unpickles, checks every chunk's checksum, and takes from a file that a crash cut off
all that comes before the cut.
"""

import io
import json
import struct
from collections.abc import Iterable, Iterator, Mapping
from importlib.metadata import version
from pathlib import Path
from types import TracebackType
from typing import Any, Final

import zstandard
from mcap.exceptions import McapError
from mcap.records import Channel, Chunk, Message, Metadata
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import CompressionType, Writer

import studio
from studio.engine.errors import FileError, StudioError
from studio.engine.gate import GATE_MODES
from studio.engine.mcap_messages import CHANNELS, SCHEMAS, messages_of, sample_of
from studio.engine.recording import Recording, RecordingInfo, Sample
from studio.engine.retarget import MAPPINGS
from studio.engine.skeleton import SIDES

MAGIC: Final = b"\x89MCAP0\r\n"
SCHEMA_VERSION = "1"
MCAP_FORMAT = f"studio mcap {SCHEMA_VERSION}"
# A tick is at least 1.2 kB, so that a chunk fills, and reaches the file, at least once a second.
CHUNK_BYTES = 24 * 1024
LONGEST_TICK = 1.0  # [s] from one to the next; a wrong stamp must not keep the robot busy for years
LARGEST_FILE = 1 << 30  # [bytes] of a recording; ten hours or so
LARGEST_CHUNK = 64 << 20  # [bytes] unpacked: ours are a thousandth of it


class RecordingWriter:
    """Writes a recording tick by tick; what is written survives a crash of the writer.

    A context manager; a recording of nothing leaves no file.

    Raises
    ------
    FileError
        Where the file exists already (nothing recorded is ever overwritten) or can't be written.
    """

    def __init__(self, path: Path, info: RecordingInfo) -> None:
        self.path = path
        self.samples = 0
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("xb")
        except OSError as error:
            raise FileError(f"{path}: cannot write a recording here: {error.strerror}") from error
        self._writer = Writer(self._file, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
        self._writer.start(profile="", library="teaching-studio")
        self._writer.add_metadata(
            "studio",
            {
                "schema_version": SCHEMA_VERSION,
                "side": info.side,
                "mapping": info.mapping,
                "gate": info.gate,
                "source": info.source,
                "studio": studio.__version__,
                **{name: version(name) for name in ("numpy", "pybullet", "mcap")},
            },
        )
        self._channels = {
            topic: self._writer.register_channel(
                topic,
                "json",
                self._writer.register_schema(
                    topic.strip("/"), "jsonschema", json.dumps(SCHEMAS[topic]).encode()
                ),
            )
            for topic in CHANNELS
        }

    def write(self, sample: Sample) -> None:
        """Append one tick."""
        stamp = round(sample.time * 1e9)
        for topic, message in messages_of(sample):
            data = json.dumps(message, allow_nan=False, separators=(",", ":")).encode()
            self._writer.add_message(self._channels[topic], stamp, data, stamp, self.samples)
        self._file.flush()  # hands whole chunks to the system, which outlives this process
        self.samples += 1

    def close(self) -> None:
        """Finish the file with its index; without samples, remove it."""
        if self._file.closed:
            return
        try:
            self._writer.finish()  # type: ignore[no-untyped-call]
        finally:
            self._file.close()
        if not self.samples:
            self.path.unlink()

    def __enter__(self) -> "RecordingWriter":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()


def write_recording(path: Path, recording: Recording) -> None:
    """Write a whole recording; see `RecordingWriter` for the errors."""
    with RecordingWriter(path, recording.info) as writer:
        for sample in recording.samples:
            writer.write(sample)


def is_mcap(path: Path) -> bool:
    """Tell whether a file begins as MCAP does; a missing file does not."""
    try:
        with path.open("rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except OSError:
        return False


def read_recording(path: Path) -> Recording:
    """Return a recording, as much of it as is whole; its ``warning`` says what is missing.

    Raises
    ------
    FileError
        Where the file cannot be opened, is no recording of the studio's, or holds no whole tick.
    """
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise FileError(f"{path}: {size:,} bytes; recordings up to {LARGEST_FILE:,} are read")
        content = path.read_bytes()
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror}") from error
    stream = io.BytesIO(content)
    messages = _Messages()
    whole, problem = 0, ""
    reader = StreamReader(stream, emit_chunks=True, record_size_limit=max(size, 1))
    try:
        for record in reader.records:
            messages.take(record)
            whole = stream.tell()
    except _BROKEN as error:
        problem = str(error) or type(error).__name__
    info = _info(path, messages.metadata)
    try:
        samples = tuple(_samples(messages.messages))
    except (StudioError, KeyError, TypeError, ValueError) as error:
        raise FileError(f"{path}: a message is not the studio's: {error!r}") from error
    if not samples:
        raise FileError(f"{path}: no whole tick in it ({problem or 'it is empty'}); record anew")
    if not problem:
        return Recording(info, samples)
    return Recording(
        info,
        samples,
        f"{path}: the last {size - whole:,} of {size:,} bytes are cut off or damaged and were not "
        f"read ({problem}); the {len(samples):,} ticks before are whole",
    )


# What the reader and the decompressor raise on damage; all of it means "stop here".
_BROKEN = (
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


class _Messages:
    """Messages in the order of the file, with their channels' names."""

    def __init__(self) -> None:
        self.metadata: dict[str, str] = {}
        self.messages: list[tuple[str, Any]] = []
        self._topics: dict[int, str] = {}

    def take(self, record: object) -> None:
        """Take a record from outside the chunks; a chunk is taken whole or not at all."""
        if isinstance(record, Metadata) and record.name == "studio":
            self.metadata = record.metadata
        if not isinstance(record, Chunk):
            return
        if record.uncompressed_size > LARGEST_CHUNK:
            raise StudioError(f"a chunk of {record.uncompressed_size:,} bytes is not the studio's")
        found: list[tuple[str, Any]] = []
        for inner in breakup_chunk(record, validate_crc=True):
            if isinstance(inner, Channel):
                self._topics[inner.id] = inner.topic
            elif isinstance(inner, Message):
                found.append((self._topics[inner.channel_id], json.loads(inner.data)))
        self.messages += found


def _samples(messages: Iterable[tuple[str, Any]]) -> Iterator[Sample]:
    tick: dict[str, Any] = {}
    before: float | None = None
    for topic, message in messages:
        tick[topic] = message
        if topic == CHANNELS[-1]:
            sample = sample_of(tick)
            if before is not None and not 0.0 < sample.time - before <= LONGEST_TICK:
                raise StudioError(f"a tick at {sample.time:g} s follows one at {before:g} s")
            yield sample
            before, tick = sample.time, {}


def _info(path: Path, metadata: Mapping[str, str]) -> RecordingInfo:
    schema = metadata.get("schema_version")
    if schema != SCHEMA_VERSION:
        found = "none" if schema is None else f"version {schema!r:.20}"
        raise FileError(
            f"{path}: not a recording of this studio: expected its metadata of version "
            f"{SCHEMA_VERSION}, found {found}"
        )
    side = next((s for s in SIDES if s == metadata.get("side")), None)
    mapping = next((m for m in MAPPINGS if m == metadata.get("mapping")), None)
    gate = next((g for g in GATE_MODES if g == metadata.get("gate")), None)
    if side is None or mapping is None or gate is None:
        raise FileError(f"{path}: its metadata name no arm, mapping or gate that the studio knows")
    return RecordingInfo(side, mapping, gate, metadata.get("source", "unknown"))
