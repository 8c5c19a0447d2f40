"""Recordings: written and read back they are the same, and damage costs only what it touched."""

import io
import os
import signal
import subprocess
import sys
import textwrap
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from studio.engine import mcap_file, mcap_log
from studio.engine.arms import driven_joints
from studio.engine.calibration import Calibration
from studio.engine.errors import FileError
from studio.engine.follow import follow
from studio.engine.live.latency import LatencyChain, Spread
from studio.engine.mcap_file import read_recording, write_recording
from studio.engine.mcap_log import is_mcap
from studio.engine.mcap_messages import CHANNELS, messages_of
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording
from studio.engine.resources import samples_folder
from studio.engine.robot import load_robot
from studio.engine.sources.demonstrator import demonstrate


@pytest.fixture(scope="module")
def recording() -> Recording:
    full = follow(demonstrate(0, 1), Pipeline.for_robot(load_robot(), "left"))
    return Recording(full.info, full.samples[100:220])


@pytest.fixture(scope="module")
def content(recording, tmp_path_factory) -> bytes:
    path = tmp_path_factory.mktemp("whole") / "whole.mcap"
    write_recording(path, recording)
    return path.read_bytes()


def same(a, b) -> bool:
    """Compare two values field by field, arrays to the last bit."""
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and a.tobytes() == b.tobytes()
    if hasattr(a, "__dataclass_fields__"):
        return type(a) is type(b) and all(
            same(getattr(a, name), getattr(b, name)) for name in a.__dataclass_fields__
        )
    return a == b


def test_write_then_read_is_identity(recording, tmp_path: Path) -> None:
    path = tmp_path / "new" / "a.mcap"
    write_recording(path, recording)
    again = read_recording(path)
    assert again.info == recording.info
    assert again.warning == ""
    assert len(again.samples) == len(recording.samples)
    for a, b in zip(recording.samples, again.samples, strict=True):
        assert same(a, b)


def test_both_arms_mirrored_and_calibrated_come_back_too(tmp_path: Path) -> None:
    calibration = Calibration((0.1, -0.05, -0.9))
    line = Pipeline.for_robot(load_robot(), "both", "paper", "open", True, calibration)
    full = follow(demonstrate(0, 1), line)
    recording = Recording(full.info, full.samples[:40])
    write_recording(tmp_path / "both.mcap", recording)
    again = read_recording(tmp_path / "both.mcap")
    assert again.info == recording.info
    assert (again.info.mirrored, again.info.calibration) == (True, calibration)
    assert all(same(a, b) for a, b in zip(recording.samples, again.samples, strict=True))
    assert len(again.samples[-1].sent) == len(again.samples[-1].wanted) == 8


@pytest.mark.parametrize(
    ("known", "what"),
    [
        ({"arms": "both"}, "expected 8 angles"),
        ({"mirrored": "perhaps"}, "mirroring or calibration"),
        ({"calibration": Calibration((0.0, 0.0, -1.0)), "down": (1.0, 0.0, 0.0)}, "calibration"),
    ],
)
def test_metadata_that_do_not_fit_are_refused(recording, tmp_path: Path, known, what) -> None:
    if "down" in known:  # past its own check, as a damaged file may have it
        object.__setattr__(known["calibration"], "down", known.pop("down"))
    path = tmp_path / "bent.mcap"
    write_recording(path, Recording(replace(recording.info, **known), recording.samples))
    with pytest.raises(FileError, match=what):
        read_recording(path)


def test_the_latency_of_a_live_run_comes_back(recording, tmp_path: Path) -> None:
    chain = LatencyChain(waiting=Spread(0.001, 0.004), total=Spread(0.002, 0.03))
    samples = list(recording.samples)
    samples[29] = replace(samples[29], latency=chain)
    write_recording(tmp_path / "live.mcap", Recording(recording.info, tuple(samples)))
    again = [sample.latency for sample in read_recording(tmp_path / "live.mcap").samples]
    assert again == [sample.latency for sample in samples]


def test_recordings_from_before_mirroring_and_calibration_still_read() -> None:
    for path in sorted(samples_folder().glob("*.mcap")):
        info = read_recording(path).info
        assert (info.arms, info.mirrored, info.calibration) == ("left", False, None)


def test_the_same_recording_gives_the_same_bytes(recording, content, tmp_path: Path) -> None:
    write_recording(tmp_path / "b.mcap", recording)
    assert (tmp_path / "b.mcap").read_bytes() == content


def test_the_files_own_library_reads_it_with_schemas(content, tmp_path: Path) -> None:
    (tmp_path / "a.mcap").write_bytes(content)
    with (tmp_path / "a.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert {channel.topic for channel in summary.channels.values()} == set(CHANNELS)
    assert {schema.encoding for schema in summary.schemas.values()} == {"jsonschema"}


def test_nothing_recorded_is_overwritten(recording, tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    path.write_text("precious")
    with pytest.raises(FileError, match=r"a\.mcap"):
        write_recording(path, recording)
    assert path.read_text() == "precious"


def test_a_chunk_holds_a_second_at_most(content) -> None:
    stamps = [c.message_end_time - c.message_start_time for c in _chunk_indexes(content)]
    assert max(stamps) < 1e9


def test_a_cut_anywhere_keeps_all_whole_chunks(recording, tmp_path: Path, monkeypatch) -> None:
    """Every byte offset of the second chunk, and some of everywhere."""
    monkeypatch.setattr(mcap_file, "CHUNK_BYTES", 8192)  # small, so that every offset is quick
    path = tmp_path / "cut.mcap"
    write_recording(path, Recording(recording.info, recording.samples[:8]))
    content = path.read_bytes()
    chunks = [c.chunk_start_offset for c in _chunk_indexes(content)]
    offsets = {*range(chunks[1], chunks[2]), *range(0, len(content), 97)}
    kept_at = []
    for offset in sorted(offsets):
        path.write_bytes(content[:offset])
        read = _read_or_refuse(path)
        if read is None:
            assert offset <= chunks[1]
            continue
        kept_at.append((offset, len(read.samples)))
        assert "bytes are cut off or damaged" in read.warning
        assert same(read.samples[-1], recording.samples[len(read.samples) - 1])
    counts = [count for _, count in kept_at]
    assert counts == sorted(counts)
    assert max(counts) == 8


def _read_or_refuse(path: Path) -> Recording | None:
    """Return what is read, or None where the file is refused by name."""
    try:
        return read_recording(path)
    except FileError as error:
        if str(path) not in str(error):
            raise
        return None


def _chunk_indexes(content: bytes):
    return make_reader(io.BytesIO(content)).get_summary().chunk_indexes


def test_flipped_bytes_never_give_a_traceback(recording, content, tmp_path: Path) -> None:
    rng = np.random.default_rng(8)
    path = tmp_path / "bent.mcap"
    for _ in range(150):
        bent = bytearray(content)
        for position in rng.integers(0, len(bent), rng.integers(1, 4)):
            bent[position] ^= int(rng.integers(1, 256))
        path.write_bytes(bent)
        read = _read_or_refuse(path)
        samples = () if read is None else read.samples
        assert all(same(a, b) for a, b in zip(recording.samples, samples, strict=False))


def test_what_is_no_recording_is_refused_by_name(tmp_path: Path) -> None:
    for name, bad in {"text": b"hello", "empty": b"", "magic": mcap_log.MAGIC}.items():
        (tmp_path / name).write_bytes(bad)
        with pytest.raises(FileError, match=name):
            read_recording(tmp_path / name)
    assert not is_mcap(tmp_path / "missing")
    with pytest.raises(FileError, match="missing"):
        read_recording(tmp_path / "missing")


@pytest.mark.parametrize(
    "change",
    [
        lambda sample: {"sent": sample.sent + 100.0},
        lambda sample: {"wanted": (1e300, 0.0, 0.0, 0.0)},
        lambda sample: {"time": 1e6 * sample.time},
        lambda sample: {"time": 1.0},
    ],
    ids=["degrees", "huge", "years", "still"],
)
def test_a_whole_file_of_impossible_numbers_is_refused(recording, tmp_path: Path, change) -> None:
    samples = [replace(sample, **change(sample)) for sample in recording.samples[:3]]
    write_recording(tmp_path / "bad.mcap", Recording(recording.info, tuple(samples)))
    with pytest.raises(FileError, match=r"bad\.mcap"):
        read_recording(tmp_path / "bad.mcap")


HUGE = 10**400  # a whole number that JSON may hold, and no float


@pytest.mark.parametrize("value", [HUGE, [HUGE] * 7, {}, [], "1", True, None, "\ud800", [[1.0]]])
def test_any_value_at_any_place_is_read_or_refused(recording, tmp_path, monkeypatch, value) -> None:
    """Each key of each channel in turn; what is read is of the right kind."""
    sample = replace(recording.samples[0], latency=LatencyChain(total=Spread(0.1, 0.2)))
    joints = driven_joints("left")
    places = [(topic, key) for topic, told in messages_of(sample, joints) for key in told]
    read = []
    for number, (topic, key) in enumerate(places):
        told = dict(messages_of(sample, joints))
        told[topic] = {**told[topic], key: value}
        monkeypatch.setattr(mcap_file, "messages_of", lambda *_, told=told: told.items())
        path = tmp_path / f"{number}.mcap"
        write_recording(path, Recording(recording.info, (sample,)))
        monkeypatch.undo()
        found = _read_or_refuse(path)
        if found is not None:
            read.append(key)
            _check_kinds(sample, found.samples[0])
    assert len(read) < len(places) / 2


def _check_kinds(a, b) -> None:
    for name in a.__dataclass_fields__:
        one, other = getattr(a, name), getattr(b, name)
        if hasattr(one, "__dataclass_fields__") and other is not None:
            _check_kinds(one, other)
        elif isinstance(one, bool | str):
            assert type(one) is type(other), name
        elif isinstance(one, np.ndarray):
            assert other.dtype == one.dtype, name


@pytest.mark.parametrize(
    ("key", "value"),
    [
        *[("calibration", text) for text in (f"[{HUGE}, 0, -1]", "[1, 2]", '"x"', "{}", "NaN")],
        *[(key, text) for key in ("mirrored", "gripper") for text in ("1", "null", "9" * 5000)],
        *[("calibration", "[" * 100_000), ("wrist", "bent")],
    ],
)
def test_any_metadata_are_read_or_refused(recording, tmp_path, monkeypatch, key, value) -> None:
    class Bent(mcap_log.LogWriter):
        def __init__(self, file, metadata, *rest) -> None:
            super().__init__(file, {**metadata, key: value}, *rest)

    monkeypatch.setattr(mcap_file, "LogWriter", Bent)
    write_recording(tmp_path / "bent.mcap", Recording(recording.info, recording.samples[:2]))
    with pytest.raises(FileError, match=r"bent\.mcap: its metadata"):
        read_recording(tmp_path / "bent.mcap")


def test_kill_while_recording_loses_a_second_at_most(tmp_path: Path) -> None:
    """A process that is killed with SIGKILL: what it had recorded is on disk."""
    program = textwrap.dedent(
        """
        import sys
        from pathlib import Path
        from studio.engine.commands import Record, UseDemonstrator
        from studio.engine.session import Session
        session = Session(Path(sys.argv[1]))
        session.post(UseDemonstrator())
        session.post(Record())
        while True:
            print(session.tick().recorded, flush=True)
            if session.snapshot.recorded >= 200:
                import time
                time.sleep(60)
        """
    )
    process = subprocess.Popen(
        [sys.executable, "-c", program, str(tmp_path)],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
    )
    recorded = 0
    while recorded < 200:
        recorded = int(process.stdout.readline())
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()
    read = read_recording(tmp_path / "demonstration-001.mcap")
    assert recorded - 30 <= len(read.samples) <= recorded
    assert "cut off" in read.warning
