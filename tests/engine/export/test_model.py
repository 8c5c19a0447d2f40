from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.engine.errors import FileError
from studio.engine.export import Job, model
from studio.engine.learners.own import SmoothingSpline
from studio.engine.teaching import INDEX_TIME
from studio.rbf import load_model
from tests.engine.export.materials import done, listed


@pytest.mark.parametrize("learner", ["rbf", "newrb"])
def test_a_model_read_again_predicts_the_same_bits(learner: str, tmp_path: Path) -> None:
    material = done(learner, 20, 4)
    (path,) = model.write(material, Job(tmp_path))
    saved = load_model(path)
    between = np.linspace(-3.0, 150.0, 777)
    assert saved.estimator.predict(INDEX_TIME).tobytes() == material.lesson.curve.tobytes()
    assert (
        saved.estimator.predict(between).tobytes()
        == material.lesson.model.predict(between).tobytes()
    )
    assert (saved.time_unit, saved.duration) == ("index", material.taught.duration)


def test_what_is_missing_is_said() -> None:
    assert "Train first" in model.lacks(listed())
    assert not model.lacks(done())
    assert "no longer listed" in model.lacks(replace(done(), takes=done().takes[:2]))


def test_other_learners_have_no_such_file(tmp_path: Path) -> None:
    lesson = replace(done().lesson, model=SmoothingSpline(None))
    assert "no RBF network" in model.lacks(replace(done(), lesson=lesson))
    with pytest.raises(FileError, match="no RBF network"):
        model.write_model(tmp_path / "model.json", lesson)
    with pytest.raises(FileError, match=r"nowhere/model\.json"):
        model.write_model(tmp_path / "nowhere" / "model.json", done().lesson)
