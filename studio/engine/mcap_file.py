"""Recordings as MCAP: the robotics field's append-only log, which opens in Foxglove as it is.

Channels /skeleton, /gate, /command, /joint_states, /latency (of live streams, once a second) and
/world, JSON with a schema, in zstd chunks.
Every tick writes them in this order with one log time, so a tick is whole once its /world is there.
Reading never unpickles, checks every chunk's checksum, and takes from a file that a crash cut off
all that comes before the cut.
"""

import json
from collections.abc import Iterable, Iterator, Mapping
from importlib.metadata import version
from pathlib import Path
from types import TracebackType
from typing import Any

from studio.engine.arms import ARMS, driven_joints
from studio.engine.calibration import Calibration
from studio.engine.errors import FileError, StudioError
from studio.engine.gate import GATE_MODES
from studio.engine.hands import HandOptions
from studio.engine.mcap_log import LogReader, LogWriter, is_mcap
from studio.engine.mcap_messages import CHANNELS, SCHEMAS, messages_of, sample_of
from studio.engine.recording import Recording, RecordingInfo, Sample
from studio.engine.retarget import MAPPINGS
from studio.engine.scene import USUAL, Scene
from studio.engine.scene_file import scene_of, table_of
from studio.engine.sources.mcap_skeletons import HOLDS, holds_skeletons
from studio.engine.sources.strict_json import as_flag, as_numbers, as_object, as_text
from studio.engine.wrist import WRIST_MODES

SCHEMA_VERSION = "1"
MCAP_FORMAT = f"studio mcap {SCHEMA_VERSION}"
# A tick is at least 1.2 kB, so that a chunk fills, and reaches the file, at least once a second.
CHUNK_BYTES = 24 * 1024
LONGEST_TICK = 1.0  # [s] from one to the next; a wrong stamp must not keep the robot busy for years
LARGEST_FILE = 1 << 30  # [bytes] of a recording; ten hours or so
LARGEST_UNPACKED = 8 << 30  # [bytes]; ours unpack to four times their size


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
        self._joints = driven_joints(info.arms)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("xb")
        except OSError as error:
            raise FileError(f"{path}: cannot write a recording here: {error.strerror}") from error
        self._log = LogWriter(
            self._file,
            {
                "schema_version": SCHEMA_VERSION,
                "side": info.arms,  # left, right or both
                "mapping": info.mapping,
                "mirrored": json.dumps(info.mirrored),
                "calibration": json.dumps(info.calibration and info.calibration.down),
                "gripper": json.dumps(info.hands.gripper),
                "wrist": info.hands.wrist,
                "scene": json.dumps({"name": info.scene.name, **table_of(info.scene)}),
                "gate": info.gate,
                "source": info.source,
                **{name: version(name) for name in ("numpy", "pybullet", "mcap")},
            },
            {topic: SCHEMAS[topic] for topic in CHANNELS},
            CHUNK_BYTES,
        )

    def write(self, sample: Sample) -> None:
        """Append one tick."""
        stamp = round(sample.time * 1e9)
        for topic, message in messages_of(sample, self._joints):
            self._log.write(topic, stamp, message, self.samples)
        self._file.flush()  # hands whole chunks to the system, which outlives this process
        self.samples += 1

    def close(self) -> None:
        """Finish the file with its index; without samples, remove it."""
        if self._file.closed:
            return
        try:
            self._log.finish()
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


def is_recording(path: Path) -> bool:
    """Tell whether a file is MCAP, and not one that holds skeletons alone."""
    return is_mcap(path) and not holds_skeletons(path)


def read_recording(path: Path) -> Recording:
    """Return a recording, as much of it as is whole; its ``warning`` says what is missing.

    Raises
    ------
    FileError
        Where the file cannot be opened, is no recording of the studio's, or holds no whole tick.
    """
    samples: tuple[Sample, ...] = ()
    wrong: Exception | None = None
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise FileError(f"{path}: {size:,} bytes; recordings up to {LARGEST_FILE:,} are read")
        with path.open("rb") as file:
            log = LogReader(file, size, LARGEST_UNPACKED)
            try:
                samples = tuple(_samples(log))
            except (StudioError, KeyError, TypeError, ValueError) as error:
                wrong = error
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror}") from error
    info = _info(path, log.metadata)
    if wrong is not None:
        raise FileError(f"{path}: a message is not the studio's: {wrong!r}") from wrong
    if not samples:
        why = log.problem or "it is empty"
        raise FileError(f"{path}: no whole tick in it ({why}); record anew")
    driven = len(driven_joints(info.arms))
    if any(len(sample.sent) != driven for sample in samples):
        raise FileError(f"{path}: expected {driven} angles sent a tick, for its arms ({info.arms})")
    wrists = len(info.hands.wrist_joints(info.arms))
    if any(len(sample.hands.wrist) != wrists for sample in samples):
        raise FileError(f"{path}: expected {wrists} angles of wrists a tick; record anew")
    if not log.problem:
        return Recording(info, samples)
    return Recording(
        info,
        samples,
        f"{path}: the last {size - log.whole:,} of {size:,} bytes are cut off or damaged and were "
        f"not read ({log.problem}); the {len(samples):,} ticks before are whole",
    )


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
    if metadata.get("holds") == HOLDS:
        raise FileError(
            f"{path}: holds skeletons alone, without a robot; expected a recording: let the robot "
            "follow them first, as the studio and `studio teach` do with any skeleton file"
        )
    schema = metadata.get("schema_version")
    if schema != SCHEMA_VERSION:
        found = "none" if schema is None else f"version {schema!r:.20}"
        raise FileError(
            f"{path}: not a recording of this studio: expected its metadata of version "
            f"{SCHEMA_VERSION}, found {found}"
        )
    arms = next((a for a in ARMS if a == metadata.get("side")), None)
    mapping = next((m for m in MAPPINGS if m == metadata.get("mapping")), None)
    gate = next((g for g in GATE_MODES if g == metadata.get("gate")), None)
    if arms is None or mapping is None or gate is None:
        raise FileError(f"{path}: its metadata name no arm, mapping or gate that the studio knows")
    try:
        mirrored, calibration = _how_taught(metadata)
        hands, scene = _hands(metadata), _scene(metadata)
    except (StudioError, TypeError, ValueError, RecursionError) as error:
        raise FileError(
            f"{path}: its metadata's mirroring or calibration, or what they say of hands or of the "
            "scene, is broken"
        ) from error
    source = metadata.get("source", "unknown")
    return RecordingInfo(arms, mapping, gate, source, mirrored, calibration, hands, scene)


def _scene(metadata: Mapping[str, str]) -> Scene:
    """Return the scene in which it was taught; older studios had one only."""
    if "scene" not in metadata:
        return USUAL
    table = as_object(json.loads(metadata["scene"]), "the scene")
    return scene_of(table, "the scene", as_text(table.pop("name"), "the scene's name"))


def _hands(metadata: Mapping[str, str]) -> HandOptions:
    """Return what the hands did; recordings of older studios have plain ones."""
    gripper = as_flag(json.loads(metadata.get("gripper", "false")), "the gripper")
    wrist = next((mode for mode in WRIST_MODES if mode == metadata.get("wrist", "zero")), None)
    if wrist is None:
        raise StudioError("the wrist is at zero, level or following")
    return HandOptions(gripper, wrist)


def _how_taught(metadata: Mapping[str, str]) -> tuple[bool, Calibration | None]:
    """Return mirroring and calibration; recordings of older studios know neither."""
    mirrored = as_flag(json.loads(metadata.get("mirrored", "false")), "mirrored")
    down = json.loads(metadata.get("calibration", "null"))
    if down is None:
        return mirrored, None
    x, y, z = as_numbers(down, "the calibration", 3).tolist()
    return mirrored, Calibration((x, y, z))
