"""What is evaluated: a stored model, a session's lesson, or what recordings teach."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from studio.engine.arms import Arms, in_words, learned_joints
from studio.engine.demonstration import DemonstrationSet
from studio.engine.errors import FileError, StudioError
from studio.engine.evaluate.grid import replays_of
from studio.engine.evaluate.motion import Motion, motion_of
from studio.engine.planning import Trajectory
from studio.engine.retarget import Mapping
from studio.engine.scene import Scene
from studio.engine.teaching import Lesson, model_as_trajectory
from studio.rbf import NewrbRegressor, RBFRegressor, SavedModel, load_model
from studio.rbf.storage import FORMAT

_MARK = f'"{FORMAT}"'.encode()
_BEGINNING = 200  # [bytes] in which a model's file says what it is


@dataclass(frozen=True, eq=False)
class Subject:
    """A motion, and the demonstrations' own beside it."""

    motion: Motion
    replays: tuple[Motion, ...]


def is_model(path: Path) -> bool:
    """Tell whether a file begins as a stored model does; a missing file does not."""
    try:
        with path.open("rb") as file:
            return _MARK in file.read(_BEGINNING)
    except (OSError, ValueError):
        return False


def subject_of_lesson(lesson: Lesson, scene: Scene) -> Subject:
    """Return what was learned, beside the demonstrations that it was learned from."""
    taught = lesson.taught
    motion = motion_of(
        f"{lesson.settings.name} {lesson.settings.neurons}",
        lesson.trajectory(),
        taught.duration,
        taught.arms,
        taught.mapping,
        lesson.hands,
        scene,
    )
    return Subject(motion, replays_of(taught, scene))


def subject_of_model(
    path: Path,
    arms: Arms,
    mapping: Mapping,
    scene: Scene,
    taught: DemonstrationSet | None = None,
) -> Subject:
    """Return a stored model, beside demonstrations if there are any.

    They also say what the hands do, of which a model's file tells nothing.

    Raises
    ------
    FileError
        Where it cannot be read, is no network of time, or one of another number of joints.
    StudioError
        Where the scene takes fingers, and there are no demonstrations to say what these do.
    """
    try:
        saved = load_model(path)
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        raise FileError(f"{error}; export the model anew") from error
    trajectory = _trajectory(path, saved)
    joints, found = learned_joints(arms, mapping), len(np.atleast_1d(trajectory(0.0)))
    if found != len(joints):
        raise FileError(
            f"{path}: a network of {found} joints; {in_words(arms)} with the {mapping} mapping "
            f"has {len(joints)}: say how it was taught by --arm and --mapping"
        )
    hands = None if taught is None else taught.hands
    if scene.gripper and hands is None:
        raise StudioError("give --demonstrations: a model's file says nothing of the hands")
    motion = motion_of("model", trajectory, saved.duration, arms, mapping, hands, scene)
    return Subject(motion, () if taught is None else replays_of(taught, scene))


def _trajectory(path: Path, saved: SavedModel) -> Trajectory:
    """Return a stored network's output as a function of time [s]."""
    network = saved.estimator
    if not isinstance(network, RBFRegressor | NewrbRegressor) or network.n_features_in_ != 1:
        raise FileError(f"{path}: no network of time: choose one that `studio export` has written")
    if saved.time_unit == "index":
        return model_as_trajectory(network, saved.duration)
    if saved.time_unit == "s":
        return lambda time: np.atleast_1d(network.predict(np.array([[time]]))[0])
    raise FileError(
        f"{path}: its inputs count {saved.time_unit!r:.40}; expected samples (index) or seconds (s)"
    )
