from pathlib import Path

from studio.engine.demonstration import demonstrations_of
from studio.engine.export import Job, recordings
from studio.engine.mcap_file import read_recording
from tests.engine.export.materials import listed


def test_recordings_come_back_with_their_demonstrations(tmp_path: Path) -> None:
    material = listed()
    written = recordings.write(material, Job(tmp_path))
    assert [path.name for path in written] == [f"recording-{n:03d}.mcap" for n in (1, 2, 3, 4)]
    for path, take in zip(written, material.takes, strict=True):
        found = read_recording(path)
        assert found.info == take.recording.info
        (demonstration,) = demonstrations_of(found, "again")
        assert demonstration.sent.tobytes() == take.demonstration.sent.tobytes()
        assert demonstration.times.tobytes() == take.demonstration.times.tobytes()


def test_an_older_export_is_replaced(tmp_path: Path) -> None:
    take = listed().takes[0]
    path = tmp_path / "a.mcap"
    path.write_text("older")
    recordings.write_whole(path, take.recording)
    assert read_recording(path).info == take.recording.info
    assert [each.name for each in tmp_path.iterdir()] == ["a.mcap"]


def test_a_stretch_is_a_recording_of_its_demonstration_alone(tmp_path: Path) -> None:
    take = listed().takes[1]
    whole = take.demonstration
    stretch = recordings.stretch_of(take.recording, whole)
    assert len(stretch.samples) == whole.last_sample - whole.first_sample + 1
    recordings.write_whole(tmp_path / "cut.mcap", stretch)
    (found,) = demonstrations_of(read_recording(tmp_path / "cut.mcap"), whole.name)
    assert found.sent.tobytes() == whole.sent.tobytes()
    assert found.times.tobytes() == whole.times.tobytes()
    assert stretch.samples[0].time == 0.0
