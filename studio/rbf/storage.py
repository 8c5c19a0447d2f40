"""Trained models in one JSON file each, exact in float64.

Python writes a float64 with as many digits as bring the same number back, so a model read from its
file predicts the same bits. The file is data only; nothing in it is ever executed.

    {"format": "teaching-studio rbf model", "schema": 2, "learner": "RBFRegressor",
     "time": {"unit": "index", "duration_s": 4.7},
     "settings": {"n_neurons": 50, ...},
     "learned": {"centers": [[1.0], ...], "width": 12.5, "weights": [[...], ...], ...}}

Time has a unit because a spread or a width means nothing without one, and a duration because an
input that counts samples does not say how long the motion takes.
"""

import json
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from studio.rbf.contract import get_settings, require_fitted
from studio.rbf.newrb import NewrbRegressor
from studio.rbf.plain_field import PlainField
from studio.rbf.regressor import RBFRegressor
from studio.rbf.stable_field import StableField
from studio.rbf.storage_fields import plain_field_from, stable_field_from
from studio.rbf.storage_reader import Table, newrb_from, rbf_from
from studio.rbf.validation import number_above

FORMAT = "teaching-studio rbf model"
SCHEMA = 2  # raise it whenever a file of the old form would be misread
Saved = RBFRegressor | NewrbRegressor | StableField | PlainField
_READERS: dict[str, Callable[[Table, Table], Saved]] = {
    "RBFRegressor": rbf_from,
    "NewrbRegressor": newrb_from,
    "StableField": stable_field_from,
    "PlainField": plain_field_from,
}


@dataclass(frozen=True, eq=False)
class SavedModel:
    """A trained network and the time it speaks of.

    Examples
    --------
    >>> from studio.rbf import RBFRegressor
    >>> model = RBFRegressor(n_neurons=2).fit([0.0, 1.0], [0.0, 1.0])
    >>> SavedModel(model, time_unit="s", duration=1.0).duration
    1.0

    """

    estimator: Saved
    time_unit: str  # of the inputs: "index", "s", ...
    duration: float  # [s], how long the motion takes


def save_model(
    path: str | Path,
    estimator: Saved,
    *,
    time_unit: str,
    duration: float,
) -> None:
    """Write a trained network into a JSON file; an older file is replaced only by a whole one.

    A Generator as `random_state` is not written, for its state is not a setting: None is.

    Parameters
    ----------
    path : where to
    estimator : a fitted RBFRegressor, NewrbRegressor, StableField or PlainField
    time_unit : unit of the inputs, such as "index" (the number of a sample) or "s"
    duration : how long the motion takes [s]

    Raises
    ------
    NotFittedError
        Before `fit`.
    ValueError, TypeError
        Where the unit is empty or the duration is no positive number.
    OSError
        Where the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from studio.rbf import RBFRegressor
    >>> model = RBFRegressor(n_neurons=3).fit([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 4.0, 9.0])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_model(f"{folder}/model.json", model, time_unit="s", duration=3.0)
    ...     saved = load_model(f"{folder}/model.json")
    >>> saved.time_unit, bool(saved.estimator.predict([1.5]) == model.predict([1.5]))
    ('s', True)

    """
    require_fitted(estimator)
    if not isinstance(time_unit, str) or not time_unit.strip():
        raise ValueError('a model names the unit of its inputs, such as "index" or "s"')
    document = {
        "format": FORMAT,
        "schema": SCHEMA,
        "learner": type(estimator).__name__,
        "time": {
            "unit": time_unit,
            "duration_s": number_above(duration, "duration", 0.0, inclusive=False),
        },
        **_contents(estimator),
    }
    path = Path(path)
    unfinished = path.with_name(path.name + ".part")
    unfinished.write_text(json.dumps(document, allow_nan=False, indent=1) + "\n", "utf-8")
    unfinished.replace(path)


def load_model(path: str | Path) -> SavedModel:
    """Read a trained network from a file that `save_model` wrote.

    Raises
    ------
    ValueError
        Where the file is no such model, is mangled or of a newer schema; the message names the
        file, the place in it, and what was expected.
    OSError
        Where the file cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> from studio.rbf import RBFRegressor
    >>> model = RBFRegressor(n_neurons=3).fit([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 4.0, 9.0])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_model(f"{folder}/push.json", model, time_unit="s", duration=3.0)
    ...     saved = load_model(f"{folder}/push.json")
    >>> saved.time_unit, bool(saved.estimator.predict([1.5]) == model.predict([1.5]))
    ('s', True)

    """
    table = Table(_document(Path(path)), str(path))
    table.expect("format", FORMAT)
    table.expect("schema", SCHEMA)
    learner = table.text("learner")
    if learner not in _READERS:
        raise table.fault("learner", " or ".join(f'"{name}"' for name in _READERS))
    time = table.table("time")
    return SavedModel(
        estimator=_READERS[learner](table.table("settings"), table.table("learned")),
        time_unit=time.text("unit"),
        duration=time.number("duration_s", positive=True),
    )


def _contents(estimator: Any) -> dict[str, Any]:
    """Return settings and learned values of a learner, or of one that another one is made of."""
    learned = {name: value for name, value in vars(estimator).items() if name.endswith("_")}
    return {
        "settings": {name: _plain(value) for name, value in get_settings(estimator).items()},
        "learned": {name.removesuffix("_"): _plain(value) for name, value in learned.items()},
    }


def _document(path: Path) -> Any:
    content = path.read_bytes()
    try:
        return json.loads(content.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path}: not a JSON file as save_model writes it: {error}") from error


def _plain(value: Any) -> Any:
    """Return a setting or learned value as JSON knows it; an infinite number becomes null."""
    if isinstance(value, np.random.Generator):
        return None
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, RBFRegressor):
        return _contents(value)
    if is_dataclass(value):
        return {field.name: _plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
