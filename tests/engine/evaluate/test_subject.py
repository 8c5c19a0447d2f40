"""Stored models, sessions' lessons and recordings come to the same motion; the rest is refused."""

import json

import numpy as np
import pytest

from studio.engine.errors import FileError, StudioError
from studio.engine.evaluate.subject import is_model, subject_of_lesson, subject_of_model
from studio.engine.export.model import write_model
from studio.engine.resources import samples_folder
from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene
from studio.rbf import RBFRegressor, save_model
from tests.engine.lessons_at_hand import lesson


def test_a_stored_model_is_the_lesson_that_it_was_to_the_bit(tmp_path) -> None:
    path = tmp_path / "model.json"
    write_model(path, lesson())
    assert is_model(path)
    stored = subject_of_model(path, "left", "exact", Scene(), lesson().taught)
    kept = subject_of_lesson(lesson(), Scene())
    assert np.array_equal(stored.motion.sent, kept.motion.sent)
    assert [each.name for each in stored.replays] == [each.name for each in kept.replays]
    assert np.array_equal(stored.replays[1].sent, kept.replays[1].sent)
    assert subject_of_model(path, "left", "exact", Scene()).replays == ()


def test_a_model_in_a_scene_that_takes_fingers_needs_demonstrations(tmp_path) -> None:
    path = tmp_path / "model.json"
    write_model(path, lesson())
    with pytest.raises(StudioError, match="give --demonstrations: a model's file says nothing of"):
        subject_of_model(path, "left", "exact", read_scene("pick-and-place"))


def test_other_files_are_no_models(tmp_path) -> None:
    assert not is_model(tmp_path / "nowhere.json")
    assert not is_model(tmp_path)
    for sample in samples_folder().iterdir():
        assert not is_model(sample)


def test_a_model_of_seconds_is_asked_for_seconds(tmp_path) -> None:
    times = np.linspace(0.0, 2.0, 20)
    rows = np.linspace((0.0, -0.5, 0.0, 1.4), (0.2, -0.6, 0.1, 1.3), 20)
    network = RBFRegressor(5).fit(times[:, np.newaxis], rows)
    path = tmp_path / "model.json"
    save_model(path, network, time_unit="s", duration=2.0)
    motion = subject_of_model(path, "left", "exact", Scene()).motion
    assert motion.trajectory(1.0) == pytest.approx(network.predict(np.array([[1.0]]))[0])


def test_a_model_of_other_joints_or_other_time_is_refused_in_words(tmp_path) -> None:
    path = tmp_path / "model.json"
    write_model(path, lesson())
    with pytest.raises(FileError, match=r"model\.json: a network of 4 joints; both arms.* has 8"):
        subject_of_model(path, "both", "exact", Scene(arms="both"))
    save_model(path, lesson().model, time_unit="furlongs", duration=2.0)
    with pytest.raises(FileError, match=r"its inputs count 'furlongs'; expected samples"):
        subject_of_model(path, "left", "exact", Scene())
    document = json.loads(path.read_text())
    document["learned"]["width"] = "wide"
    path.write_text(json.dumps(document))
    with pytest.raises(FileError, match=r"model\.json: learned: width"):
        subject_of_model(path, "left", "exact", Scene())
    with pytest.raises(FileError, match="cannot be read"):
        subject_of_model(tmp_path / "nowhere.json", "left", "exact", Scene())
