"""What was learned, as one JSON file that `studio.rbf.load_model` reads."""

from pathlib import Path

from studio.engine.errors import FileError
from studio.engine.export.kind import Job, lacks_lesson
from studio.engine.export.material import Material
from studio.engine.teaching import Lesson
from studio.rbf import NewrbRegressor, RBFRegressor, save_model

FILE = "model.json"


def lacks(material: Material) -> str:
    """Return why there is no model to write, or nothing."""
    lesson = material.lesson
    if lesson is not None and not isinstance(lesson.model, RBFRegressor | NewrbRegressor):
        return f"{lesson.settings.name} is no RBF network: there is no file for it"
    return lacks_lesson(material)


def write(material: Material, job: Job) -> tuple[Path, ...]:
    """Write the model."""
    path = job.folder / FILE
    if material.lesson is not None:
        write_model(path, material.lesson)
    job.done(1.0)
    return (path,)


def write_model(path: Path, lesson: Lesson) -> None:
    """Write a lesson's network, and how long its motion takes.

    Raises
    ------
    FileError
        Where it is no RBF network, or the file cannot be written.
    """
    if not isinstance(lesson.model, RBFRegressor | NewrbRegressor):
        raise FileError(f"{path}: {lesson.settings.name} is no RBF network: learn with one")
    try:
        save_model(path, lesson.model, time_unit="index", duration=lesson.taught.duration)
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror}") from error
