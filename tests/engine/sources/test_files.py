import gzip
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import FileError
from studio.engine.sources import content, read_skeletons
from studio.engine.sources.files import read_frames

REAL = Path(__file__).resolve().parents[4] / "shared" / "data" / "kinect"
needs_real = pytest.mark.skipif(not REAL.is_dir(), reason=f"no real recordings at {REAL}")


def test_content_tells_the_format_whatever_the_name(tmp_path, made):
    for name, data in made.sample_files().items():
        path = tmp_path / "recording.xyz"
        path.write_bytes(data)
        recording = read_skeletons(str(path))
        assert recording.format == name.removesuffix(" in gzip")
        assert recording.path == str(path)
        assert recording.frames == len(recording) == len(recording.frame_indices)
        assert [frame.time for frame in read_frames(path).frames] == [s.time for s in recording]
        for frame, skeleton in enumerate(recording):
            assert (skeleton.positions == made.standing(frame)).all()
            assert skeleton.time == recording.frame_times[frame]


def test_one_body_can_be_asked_for(tmp_path, made):
    frames = [[made.socket_body(0, 1, z=2.0), made.socket_body(0, 2, z=3.0)]] * 3
    path = tmp_path / "two.json"
    path.write_text(made.socket_text(frames))
    assert {skeleton.body_id for skeleton in read_skeletons(path)} == {"1"}
    assert {skeleton.body_id for skeleton in read_skeletons(path, body="2")} == {"2"}
    with pytest.raises(FileError, match=r"two\.json: .*not '3'; seen: 1, 2"):
        read_skeletons(path, body="3")


@pytest.fixture(scope="module")
def scratch(tmp_path_factory):
    return tmp_path_factory.mktemp("mangled") / "file"


@settings(deadline=None, derandomize=True, max_examples=150)
@given(st.data())
def test_mangled_gzip_is_a_file_error_or_a_recording(scratch, made, data):
    mangled = bytearray(made.sample_files()["kinect2-socket 0.3 in gzip"])
    mangled[data.draw(st.integers(0, len(mangled) - 1))] = data.draw(st.integers(0, 255))
    scratch.write_bytes(mangled[: data.draw(st.integers(1, len(mangled)))])
    error = None
    try:
        assert len(read_skeletons(scratch)) == 3
    except FileError as caught:
        error = caught
    assert error is None or str(scratch) in str(error)


def test_five_hundred_frames_are_read_quickly(tmp_path, made):
    path = tmp_path / "long.json.gz"
    frames = [[made.socket_body(frame)] for frame in range(500)]
    path.write_bytes(gzip.compress(made.socket_text(frames).encode()))
    start = time.process_time()
    assert len(read_skeletons(path)) == 500
    assert time.process_time() - start < 1.0  # 0.05 s on a slow laptop


def test_formats_of_lines_are_streamed(tmp_path, made, monkeypatch):
    """Line by line the cap of whole documents does not count."""
    monkeypatch.setattr(content, "MAXIMUM_BYTES", 1000)
    path = tmp_path / "a"
    for name, data in made.skeleton_files().items():
        path.write_bytes(data)
        if name.startswith("kinect"):
            with pytest.raises(FileError, match="holds more than"):
                read_skeletons(path)
        else:
            assert read_skeletons(path).format == name


@needs_real
@pytest.mark.parametrize(
    ("name", "kind", "frames", "seconds"),
    [
        ("kinect2-socket/hands_gestures.json.gz", "kinect2-socket 0.3", 535, 534 / 30),
        ("kinect2-socket/hand_flap.json.gz", "kinect2-socket 0.3", 268, 267 / 30),
        ("kinect2-socket/test_record.json", "kinect2-socket 0.1", 309, 308 / 30),
        ("kinectron/recorded_skeleton.json.gz", "kinectron", 286, 9.6),
        ("keraal/G3-Kinect-CTK-P1T1-Unknown-C-0.txt", "table 175", 197, 196 / 30),
        ("labanotation/Ges01_wavehand.csv", "table 101", 154, 5.167),
        ("labanotation/Ges05_demopoint.csv", "table 101", 190, 6.366),
        ("labanotation/joints.csv", "table 101", 371, 12.4),
    ],
)
def test_real_recordings(name, kind, frames, seconds):
    recording = read_skeletons(REAL / name)
    assert (recording.format, recording.frames, len(recording)) == (kind, frames, frames)
    assert recording.seconds == pytest.approx(seconds, abs=1e-3)
    assert recording.has_stamps == (kind in ("table 101", "kinectron"))
    spine = np.array([skeleton.positions[1] for skeleton in recording])
    assert (np.abs(spine - [0.0, 0.0, 2.2]) < [1.0, 1.0, 1.5]).all()  # a person before a sensor
