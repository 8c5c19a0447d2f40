"""What arrives is kept, and can be read again whatever the stamps did."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import FileError
from studio.engine.live.recorder import FrameRecorder
from studio.engine.sources import read_skeletons
from studio.engine.sources.family import Frame
from tests.engine.people import person

stamps = st.floats(-1e12, 1e12)


@settings(deadline=None, derandomize=True, max_examples=50)
@given(st.lists(st.tuples(st.integers(1, 2), stamps, st.booleans()), min_size=1, max_size=20))
def test_any_stamps_give_a_file_that_can_be_followed(tmp_path_factory, frames) -> None:
    path = tmp_path_factory.mktemp("kept") / "kept.jsonl"
    with FrameRecorder(path) as recorder:
        for number, (stream, stamp, is_seen) in enumerate(frames):
            bodies = (person(stamp),) if is_seen else ()
            recorder.record(stream, Frame(stamp, bodies), 50.0 + number / 30)
    if any(is_seen for _, _, is_seen in frames):
        read = read_skeletons(path)
        assert len(read) == sum(is_seen for _, _, is_seen in frames)
        assert 0.0 <= read.frame_times[0] <= read.frame_times[-1] <= len(frames) / 30 + 1.0


def test_an_honest_sensors_intervals_are_kept(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    with FrameRecorder(tmp_path / "kept.jsonl") as recorder:
        for n in range(60):
            arrival = 50.0 + n / 30 + rng.uniform(0, 0.02)
            recorder.record(1, Frame(1e6 + n / 30, (person(n / 30),)), arrival)
    times = read_skeletons(tmp_path / "kept.jsonl").frame_times
    assert np.allclose(np.diff(times), 1 / 30, atol=1e-6)
    assert times[0] == 0.0


def test_several_people_are_kept(tmp_path: Path) -> None:
    two = (person(0.0, body_id="a"), person(0.0, body_id="b"))
    with FrameRecorder(tmp_path / "kept.jsonl") as recorder:
        recorder.record(1, Frame(0.0, two), 1.0)
    assert set(read_skeletons(tmp_path / "kept.jsonl").bodies) == {"a", "b"}


def test_nothing_is_overwritten_and_nothing_leaves_no_file(tmp_path: Path) -> None:
    path = tmp_path / "kept.jsonl"
    with FrameRecorder(path), pytest.raises(FileError, match=r"kept\.jsonl"):
        FrameRecorder(path)
    assert not path.exists()


def test_a_full_disk_ends_the_recording_not_the_stream(tmp_path: Path) -> None:
    with FrameRecorder(tmp_path / "kept.jsonl") as recorder:
        recorder.record(1, Frame(0.0), 1.0)
        real, recorder._file = recorder._file, open("/dev/full", "w", buffering=1)  # noqa: SIM115
        recorder.record(1, Frame(0.1), 1.1)
        recorder.record(1, Frame(0.2), 1.2)
        assert "cannot be written" in recorder.failure
        real.close()
