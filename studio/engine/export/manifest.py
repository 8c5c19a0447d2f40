"""What a session's archive says of itself: settings, seed, versions, and what is in it.

    {"format": "teaching-studio session", "schema": 1,
     "versions": {"studio": "1.0", "numpy": "2.1.0", ...},
     "settings": {"arms": "left", "mapping": "exact", ..., "seed": 0},
     "recordings": ["recordings/001.mcap", ...],
     "demonstrations": [{"name": "push", "recording": 0, "first": 61, "last": 233,
                         "included": true}, ...],
     "learned": {"model": "model.json", "learner": "rbf", "neurons": 50, "from": [0, 1, 2, 3]}}

A demonstration is the samples ``first`` to ``last`` of a recording, as it was trimmed. ``learned``
is null where nothing was.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, TypeVar, get_args

import studio
from studio.engine.arms import ARMS
from studio.engine.demonstration import Interpolation
from studio.engine.errors import StudioError
from studio.engine.experiment import Setup
from studio.engine.export.material import Material
from studio.engine.gate import GATE_MODES
from studio.engine.hands import HandOptions
from studio.engine.retarget import MAPPINGS
from studio.engine.scene import USUAL, Scene
from studio.engine.scene_file import scene_of, table_of
from studio.engine.sources.strict_json import as_list, as_object, as_text
from studio.engine.teaching import LEARNERS, LearnerSettings
from studio.engine.wrist import WRIST_MODES

FORMAT = "teaching-studio session"
SCHEMA = 1  # raise it whenever an archive of the old form would be misread
MANIFEST, MODEL = "manifest.json", "model.json"
MOST_RECORDINGS, MOST_DEMONSTRATIONS = 500, 2000
LONGEST_NAME = 500  # characters
LIBRARIES = ("numpy", "scipy", "pybullet", "mcap")
_Name = TypeVar("_Name", bound=str)


@dataclass(frozen=True)
class Stretch:
    """A demonstration, as samples of a recording."""

    name: str
    recording: int
    first: int
    last: int
    included: bool


@dataclass(frozen=True)
class Manifest:
    """What an archive holds."""

    setup: Setup
    recordings: int
    stretches: tuple[Stretch, ...]
    learner: LearnerSettings | None  # of what was learned, if anything was
    learned_from: tuple[int, ...]  # indices of stretches


def recording_name(index: int) -> str:
    """Return where a recording is in the archive."""
    return f"recordings/{index + 1:03d}.mcap"


def manifest_of(material: Material) -> dict[str, Any]:
    """Return the manifest of some material, as JSON has it."""
    place = {id(recording): i for i, recording in enumerate(material.recordings)}
    lesson, learned_from = material.lesson, material.learned_from
    learned = None
    if lesson is not None and learned_from is not None:
        learned = {
            "model": MODEL,
            "learner": lesson.settings.name,
            "neurons": lesson.settings.neurons,
            "from": list(learned_from),
        }
    return {
        "format": FORMAT,
        "schema": SCHEMA,
        "versions": {"studio": studio.__version__, **{name: version(name) for name in LIBRARIES}},
        "settings": _settings(material.setup),
        "recordings": [recording_name(index) for index in range(len(material.recordings))],
        "demonstrations": [
            {
                "name": take.demonstration.name,
                "recording": place[id(take.recording)],
                "first": take.demonstration.first_sample,
                "last": take.demonstration.last_sample,
                "included": take.included,
            }
            for take in material.takes
        ],
        "learned": learned,
    }


def read_manifest(value: object) -> Manifest:
    """Return what a manifest says.

    Raises
    ------
    StudioError
        Where it is none, or of a newer studio, or says what cannot be; the message names the place.
    """
    table = as_object(value, "the manifest")
    for key, expected in (("format", FORMAT), ("schema", SCHEMA)):
        if table.get(key) != expected:
            raise StudioError(
                f"{key}: expected {expected!r}, found {table.get(key)!r:.60}; a newer studio may "
                "read it"
            )
    recordings = as_list(table.get("recordings"), "recordings")
    if recordings != [recording_name(i) for i in range(len(recordings))]:
        raise StudioError("recordings: expected recordings/001.mcap and so on")
    entries = as_list(table.get("demonstrations"), "demonstrations")
    if len(recordings) > MOST_RECORDINGS or len(entries) > MOST_DEMONSTRATIONS:
        raise StudioError(
            f"at most {MOST_RECORDINGS} recordings and {MOST_DEMONSTRATIONS} demonstrations are "
            f"read, found {len(recordings)} and {len(entries)}"
        )
    stretches = tuple(_stretch(i, entry, len(recordings)) for i, entry in enumerate(entries))
    learner, learned_from = _learned(table.get("learned"), len(stretches))
    return Manifest(
        _setup(table.get("settings")), len(recordings), stretches, learner, learned_from
    )


def _settings(setup: Setup) -> dict[str, Any]:
    return {
        "arms": setup.arms,
        "mapping": setup.mapping,
        "gate": setup.gate,
        "mirrored": setup.mirrored,
        "gripper": setup.hands.gripper,
        "wrist": setup.hands.wrist,
        "scene": {"name": setup.scene.name, **table_of(setup.scene)},
        "learner": setup.learner.name,
        "neurons": setup.learner.neurons,
        "interpolation": setup.interpolation,
        "seed": setup.seed,
    }


def _setup(value: object) -> Setup:
    table = as_object(value, "settings")
    interpolations: tuple[Interpolation, ...] = get_args(Interpolation)
    hands = HandOptions(
        _flag(table, "gripper", "settings"), _one_of(table, "wrist", WRIST_MODES, "settings")
    )
    return Setup(
        arms=_one_of(table, "arms", ARMS, "settings"),
        mapping=_one_of(table, "mapping", MAPPINGS, "settings"),
        gate=_one_of(table, "gate", GATE_MODES, "settings"),
        learner=_learner(table, "settings"),
        interpolation=_one_of(table, "interpolation", interpolations, "settings"),
        seed=_count(table, "seed", 1 << 63, "settings"),
        mirrored=_flag(table, "mirrored", "settings"),
        hands=hands,
        scene=_scene(table),
    )


def _scene(table: dict[str, object]) -> Scene:
    """Return the scene; archives of older studios know one only."""
    if "scene" not in table:
        return USUAL
    told = dict(as_object(table["scene"], "settings: scene"))
    return scene_of(told, "settings: scene", as_text(told.pop("name", None), "the scene's name"))


def _learner(table: dict[str, object], place: str) -> LearnerSettings:
    name = _one_of(table, "learner", tuple(LEARNERS), place)
    return LearnerSettings(name, _count(table, "neurons", 1 << 31, place))


def _stretch(index: int, value: object, recordings: int) -> Stretch:
    place = f"demonstrations[{index}]"
    table = as_object(value, place)
    name = table.get("name")
    if not isinstance(name, str) or not name.isprintable() or not 0 < len(name) <= LONGEST_NAME:
        raise StudioError(f"{place}: expected a name in a line, found {name!r:.60}")
    return Stretch(
        name,
        _count(table, "recording", recordings, place),
        _count(table, "first", 1 << 31, place),
        _count(table, "last", 1 << 31, place),
        _flag(table, "included", place),
    )


def _learned(value: object, stretches: int) -> tuple[LearnerSettings | None, tuple[int, ...]]:
    if value is None:
        return None, ()
    table = as_object(value, "learned")
    chosen = as_list(table.get("from"), "learned: from")
    if not chosen or not all(type(i) is int and 0 <= i < stretches for i in chosen):
        raise StudioError(
            f"learned: from: expected numbers of demonstrations, found {chosen!r:.60}"
        )
    if table.get("model") != MODEL:
        raise StudioError(f"learned: model: expected {MODEL}, found {table.get('model')!r:.60}")
    return _learner(table, "learned"), tuple(i for i in chosen if isinstance(i, int))


def _count(table: dict[str, object], key: str, below: int, place: str) -> int:
    value = table.get(key)
    if type(value) is not int or not 0 <= value < below:
        raise StudioError(
            f"{place}: {key}: expected a whole number from 0, below {below}, found {value!r:.60}"
        )
    return value


def _flag(table: dict[str, object], key: str, place: str) -> bool:
    value = table.get(key)
    if not isinstance(value, bool):
        raise StudioError(f"{place}: {key}: expected true or false, found {value!r:.60}")
    return value


def _one_of(table: dict[str, object], key: str, known: Sequence[_Name], place: str) -> _Name:
    for name in known:
        if name == table.get(key):
            return name
    raise StudioError(
        f"{place}: {key}: expected one of {', '.join(map(str, known))}, "
        f"found {table.get(key)!r:.60}"
    )
