"""Converting loses nothing that the new format can carry, and overwrites nothing unasked."""

import gzip
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from studio.engine.conversion import convert, read_any
from studio.engine.errors import FileError
from studio.engine.follow import follow
from studio.engine.inspection import inspect_file
from studio.engine.mcap_file import is_recording, read_recording, write_recording
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording
from studio.engine.robot import load_robot
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.files import read_frames
from studio.engine.sources.jsonl import frames_to_lines
from tests.engine.skeleton_files import landmark_files, sample_files, socket_body, socket_text

REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "kinect"
FILES = {**sample_files(), **landmark_files()}
SUFFIXES = (".jsonl", ".jsonl.gz", ".mcap")


def lines(path: Path) -> list[str]:
    return list(frames_to_lines(read_frames(path).frames))


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("name", FILES)
def test_reading_back_gives_the_same_frames(tmp_path, name, suffix):
    source, target = tmp_path / "source", tmp_path / f"target{suffix}"
    source.write_bytes(FILES[name])
    done = convert(source, target)
    assert lines(target) == lines(source)
    before, after = read_frames(source), read_frames(target)
    assert (done.frames, done.bodies, done.format) == (
        3 + ("table" in name),
        done.frames,
        before.format,
    )
    assert after.has_hand_states == before.has_hand_states
    assert after.tells == before.tells
    untold = {
        "30 frames a second": "stamps",
        "every joint as tracked": "tracking",
        "hands as unknown": "hand_states",
    }
    for words, what in untold.items():
        assert any(words in note for note in done.notes) == (what not in before.tells)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_frames_with_nobody_and_hands_that_were_looked_for_in_vain_come_over(tmp_path, suffix):
    """A sensor that looks for hands and finds none tells something else than one that doesn't."""
    unseen = [[socket_body(frame, states=("unknown", "unknown"))] for frame in range(3)]
    source, target = tmp_path / "source", tmp_path / f"target{suffix}"
    source.write_text(socket_text([unseen[0], [], *unseen[1:], []]))
    before = read_frames(source)
    assert before.tells == ("hand_states",)
    convert(source, target)
    after = read_frames(target)
    assert after.tells == before.tells
    assert [len(frame.bodies) for frame in after.frames] == [1, 0, 1, 1, 0]
    assert lines(target) == lines(source)


def test_formats_are_converted_into_each_other_without_loss(tmp_path):
    source = tmp_path / "a.jsonl"
    source.write_bytes(FILES["studio jsonl 1"])
    steps = [source, *(tmp_path / name for name in ("b.mcap", "c.jsonl.gz", "d.mcap", "e.jsonl"))]
    for before, after in pairwise(steps):
        convert(before, after)
    assert steps[-1].read_bytes() == source.read_bytes()
    assert steps[1].read_bytes() == steps[3].read_bytes()
    assert gzip.decompress(steps[2].read_bytes()) == source.read_bytes()


def test_a_recordings_skeletons_are_what_is_converted(tmp_path):
    full = follow(demonstrate(0, 1), Pipeline.for_robot(load_robot(), "left"))
    recording = Recording(full.info, full.samples[:40])
    write_recording(tmp_path / "robot.mcap", recording)
    done = convert(tmp_path / "robot.mcap", tmp_path / "people.mcap")
    notes = " ".join(done.notes)
    assert "without gate, commands, joints and blocks" in notes
    assert "does not keep if its source told them" in notes
    assert "no frames for 1 of 40 ticks" in notes  # the demonstrator's own, of a dropped frame
    assert is_recording(tmp_path / "robot.mcap")
    assert not is_recording(tmp_path / "people.mcap")
    seen = [sample.skeleton for sample in recording.samples if sample.skeleton is not None]
    found = [
        body for frame in read_frames(tmp_path / "people.mcap").frames for body in frame.bodies
    ]
    assert len(found) == len(seen) > 30
    for a, b in zip(seen, found, strict=True):
        assert a.time == b.time
        assert np.array_equal(a.positions, b.positions)
        assert a.left_hand == b.left_hand
    with pytest.raises(FileError, match=r"people\.mcap: holds skeletons alone.*studio teach"):
        read_recording(tmp_path / "people.mcap")
    assert inspect_file(tmp_path / "people.mcap").frames == len(found)


def test_ticks_that_showed_nobody_new_are_not_dropped_silently(tmp_path):
    full = follow(demonstrate(0, 1), Pipeline.for_robot(load_robot(), "left"))
    samples = [
        replace(sample, skeleton=None) if 10 <= i < 25 else sample
        for i, sample in enumerate(full.samples[:40])
    ]
    unseen = sum(sample.skeleton is None for sample in samples)
    assert unseen >= 15
    write_recording(tmp_path / "robot.mcap", Recording(full.info, tuple(samples)))
    done = convert(tmp_path / "robot.mcap", tmp_path / "people.jsonl")
    assert done.frames == 40 - unseen
    assert any(note.startswith(f"no frames for {unseen} of 40 ticks") for note in done.notes)


def test_nothing_is_overwritten_unless_asked(tmp_path):
    source, target = tmp_path / "a", tmp_path / "a.jsonl"
    source.write_bytes(FILES["table 75"])
    target.write_text("precious")
    with pytest.raises(FileError, match=r"a\.jsonl: exists; .*--force"):
        convert(source, target)
    assert target.read_text() == "precious"
    convert(source, target, force=True)
    assert lines(target) == lines(source)
    convert(target, target, force=True)  # onto itself
    assert lines(target) == lines(source)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a", "a.jsonl"]


@pytest.mark.parametrize("name", ["a", "a.json", "a.csv", "a.gz", "a.mcap.gz", ".jsonl", "jsonl"])
def test_other_names_are_refused_before_anything_is_read(tmp_path, name):
    with pytest.raises(
        FileError, match=r"expected a name that ends in \.jsonl, \.jsonl\.gz, \.mcap"
    ):
        convert(tmp_path / "missing", tmp_path / name)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_cannot_be_read_or_written_is_named(tmp_path, suffix):
    (tmp_path / "bad").write_text("hello")
    with pytest.raises(FileError, match="bad: line 1: expected a recording of skeletons"):
        convert(tmp_path / "bad", tmp_path / f"a{suffix}")
    with pytest.raises(FileError, match="missing: there is no such file"):
        convert(tmp_path / "missing", tmp_path / f"a{suffix}")
    (tmp_path / "good").write_bytes(FILES["table 75"])
    with pytest.raises(FileError, match=r"a\S+: cannot be written: No such file"):
        convert(tmp_path / "good", tmp_path / "nowhere" / f"a{suffix}")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["bad", "good"]


@pytest.mark.skipif(not REAL.is_dir(), reason=f"needs real recordings at {REAL}")
def test_real_files_come_back(tmp_path):
    for path in sorted(REAL.glob("*/*")):
        target = tmp_path / f"{path.name}.mcap"
        done = convert(path, target)
        assert done.frames == len(read_any(path)[0].frames) > 100
        assert lines(target) == lines(path)
