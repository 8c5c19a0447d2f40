"""The scene of commands that teach: what is asked for, or else that of the first recording."""

from pathlib import Path

import pytest

from studio.cli import main
from studio.engine.follow import follow
from studio.engine.mcap_file import read_recording, write_recording
from studio.engine.pipeline import Pipeline
from studio.engine.resources import samples_folder
from studio.engine.robot import load_robot
from studio.engine.scene import USUAL
from studio.engine.scene_file import read_scene
from studio.engine.sources.demonstrator import demonstrate
from studio.scene_option import taught_scene

ZONE = read_scene("push-into-zone")


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a recording that was made in the scene of the zone."""
    path = tmp_path_factory.mktemp("zone") / "zone.mcap"
    pipeline = Pipeline.for_robot(load_robot(), "left", scene=ZONE)
    write_recording(path, follow(demonstrate(0, 1, scene=ZONE), pipeline, ZONE))
    return path


def test_what_is_asked_for_goes_before_the_first_recordings(recording: Path) -> None:
    (sample, *_) = sorted(samples_folder().glob("*.mcap"))
    skeletons = Path("people.jsonl")
    assert taught_scene(None, [skeletons, recording, sample]) == ZONE
    assert taught_scene(None, [sample, recording]) == USUAL
    assert taught_scene(None, [skeletons]) == taught_scene(None, []) == USUAL
    assert taught_scene("two-in-order", [recording]) == read_scene("two-in-order")


def test_a_recording_is_exported_as_it_was_made(recording: Path, tmp_path: Path) -> None:
    with pytest.raises(SystemExit) as done:
        main(["export", str(recording), "--to", str(tmp_path / "out"), "--kinds", "mcap"])
    assert done.value.code == 0
    (written,) = (tmp_path / "out").glob("recording-*.mcap")
    assert read_recording(written).info.scene == ZONE


@pytest.mark.parametrize("command", ["teach", "sweep"])
def test_other_commands_take_its_scene_too(
    command: str, recording: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def stop(_inputs: object, setup: object, *_: object, **__: object) -> None:
        asked.append(setup)
        raise KeyboardInterrupt

    monkeypatch.setattr("studio.cli.run_experiment", stop)
    monkeypatch.setattr("studio.sweep_command.teach", stop)
    with pytest.raises(SystemExit):
        main([command, str(recording)])
    assert [setup.scene for setup in asked] == [ZONE]
