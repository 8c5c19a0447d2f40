"""What comes over in parts from another process is what is read at once."""

import gzip
import time
from pathlib import Path

import numpy as np
import pytest

from studio.engine.commands import UseFile
from studio.engine.errors import FileError
from studio.engine.mcap_file import read_recording
from studio.engine.reading import Found, Part, ReadFile, Reading, Share, whole
from studio.engine.sources import read_skeletons
from tests.engine.sessions import PATIENCE

SAMPLES = Path(__file__).resolve().parents[2] / "recordings" / "samples"
STREAM, RECORDING = SAMPLES / "teaches-the-push.jsonl", SAMPLES / "demonstration-1.mcap"


def found(reading: Reading) -> Found:
    end = time.monotonic() + PATIENCE
    while (ended := reading.poll()) is None:
        assert time.monotonic() < end, "still reading"
        time.sleep(0.01)
    return ended


def test_skeletons_come_whole() -> None:
    """Two roads: as parts of a task, and read at once."""
    points = tuple(ReadFile(UseFile(STREAM, "mine")).points())
    parts = [point for point in points if isinstance(point, Part)]
    came, expected = whole(points), read_skeletons(STREAM)
    assert len(parts) > 1
    assert len(came) == len(expected)
    assert came.path == "mine"
    assert all(a.time == b.time for a, b in zip(came, expected, strict=True))
    assert np.array_equal(came[-1].positions, expected[-1].positions)
    assert np.array_equal(came.frame_indices, expected.frame_indices)
    assert [point for point in points if isinstance(point, Share)][-1].share == 1.0


def test_recordings_come_whole_through_a_process() -> None:
    reading = Reading()
    reading.read(UseFile(RECORDING))
    try:
        came, expected = found(reading).content, read_recording(RECORDING)
    finally:
        reading.close()
    assert came.info == expected.info
    assert len(came.samples) == len(expected.samples)
    for a, b in zip(came.samples, expected.samples, strict=True):
        assert np.array_equal(a.sent, b.sent)
        assert a.gate == b.gate


def test_files_are_read_one_after_the_other_and_a_broken_one_holds_up_none(tmp_path: Path) -> None:
    broken = tmp_path / "x1"
    broken.write_text("{")
    reading = Reading()
    try:
        for file in (UseFile(broken, "my take.json"), UseFile(STREAM)):
            reading.read(file)
        assert reading.status is None
        assert reading.poll() is None
        assert (reading.status.name, reading.status.waiting) == ("my take.json", 1)
        with pytest.raises(FileError, match=r"my take\.json") as refused:
            found(reading)
        assert str(tmp_path) not in str(refused.value)
        assert str(refused.value).count("my take.json") == 1
        assert found(reading).file == UseFile(STREAM)
        assert reading.status is None
    finally:
        reading.close()


@pytest.mark.parametrize("packed", [False, True])
def test_the_share_that_has_been_read_rises_to_the_whole(tmp_path: Path, packed: bool) -> None:
    """By bytes of the file, packed or not; a stream of frames is read bit by bit."""
    lines = STREAM.read_bytes() * 1
    path = tmp_path / "take.jsonl"
    path.write_bytes(gzip.compress(lines) if packed else lines)
    heard: list[float] = []
    assert len(read_skeletons(path, told=heard.append)) == len(read_skeletons(STREAM))
    assert heard == sorted(heard)
    assert (heard[0] < heard[-1]) or packed
    assert heard[-1] == 1.0
