"""Reading a stored model with suspicion: every value is checked before it becomes a network."""

import math
from dataclasses import fields
from typing import Any, cast, get_args

import numpy as np

from studio.rbf.basis import FloatArray
from studio.rbf.newrb import GrowthStep, NewrbRegressor, StopReason
from studio.rbf.regressor import RBFRegressor

MOST_FEATURES = 1_000_000  # far beyond any motion; a larger number is a mangled one


class Table:
    """A JSON object, and where it stands, so that a fault can name its place.

    All methods raise ValueError in words where the value is missing or not what they return.
    """

    def __init__(self, values: Any, place: str) -> None:
        self.place = place
        if not isinstance(values, dict):
            raise ValueError(f"{place}: expected a JSON object, found {_shown(values)}")  # noqa: TRY004 the file is wrong, not the caller
        self.values = values

    def fault(self, key: str, expected: str) -> ValueError:
        """Return the error for one value."""
        found = _shown(self.values[key]) if key in self.values else "nothing"
        return ValueError(f"{self.place}: {key}: expected {expected}, found {found}")

    def expect(self, key: str, value: object) -> None:
        """Return if the value is this one."""
        found = self.values.get(key)
        if type(found) is not type(value) or found != value:  # to Python, true is 1
            raise self.fault(key, repr(value))

    def table(self, key: str) -> "Table":
        """Return an object."""
        if key not in self.values:
            raise self.fault(key, "a JSON object")
        return Table(self.values[key], f"{self.place}: {key}")

    def text(self, key: str) -> str:
        """Return text that is not empty."""
        value = self.values.get(key)
        if not isinstance(value, str) or not value:
            raise self.fault(key, "text")
        return value

    def count(self, key: str, most: int) -> int:
        """Return a whole number from zero up to a limit."""
        value = self.values.get(key)
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= most:
            raise self.fault(key, f"a whole number from 0 to {most}")
        return value

    def number(self, key: str, *, positive: bool = False) -> float:
        """Return a finite number."""
        value = self.values.get(key)
        expected = "a positive finite number" if positive else "a finite number"
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.fault(key, expected)
        try:
            number = float(value)
        except OverflowError:
            raise self.fault(key, expected) from None
        if not math.isfinite(number) or (positive and number <= 0.0):
            raise self.fault(key, expected)
        return number

    def array(self, key: str, shape: tuple[int | None, ...]) -> FloatArray:
        """Return finite numbers of a shape in which None stands for any length from 1 up."""
        expected = f"finite numbers of shape {shape}".replace("None", "any")
        value = self.values.get(key)
        if not _only_numbers(value):
            raise self.fault(key, expected)
        try:
            array = np.array(value, dtype=np.float64)
        except (ValueError, OverflowError):  # rows of different lengths, or a number too large
            raise self.fault(key, expected) from None
        fits = len(array.shape) == len(shape) and all(
            found > 0 and wanted in (None, found)
            for found, wanted in zip(array.shape, shape, strict=True)
        )
        if not fits or not np.isfinite(array).all():
            raise self.fault(key, expected)
        return array


def _only_numbers(value: Any) -> bool:
    """Return whether a value is numbers and lists of them; text or true would pass as numbers."""
    if isinstance(value, list):
        return all(_only_numbers(entry) for entry in value)
    return isinstance(value, int | float) and not isinstance(value, bool)


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def rbf_from(settings: Table, learned: Table) -> RBFRegressor:
    """Return the RBFRegressor of a model's settings and learned values."""
    estimator = RBFRegressor(**settings_of(settings, RBFRegressor))
    if isinstance(estimator.centers, list):
        estimator.centers = np.asarray(estimator.centers, dtype=np.float64)
    _read_network(learned, estimator)
    estimator.ridge_ = learned.number("ridge")
    estimator.rank_ = learned.count("rank", len(estimator.centers_))
    infinite = learned.values.get("condition", 0) is None  # JSON has no infinity
    estimator.condition_ = math.inf if infinite else learned.number("condition")
    estimator.effective_dof_ = learned.number("effective_dof")
    estimator.noise_ = _noise(learned, estimator)
    estimator.covariance_root_ = learned.array(
        "covariance_root", (len(estimator.centers_) + 1, estimator.rank_ + 1)
    )
    return estimator


def _noise(learned: Table, estimator: RBFRegressor) -> FloatArray | float | None:
    if learned.values.get("noise", 0) is None:
        return None
    one = isinstance(estimator.bias_, float)
    noise = learned.number("noise") if one else learned.array("noise", np.shape(estimator.bias_))
    if np.any(np.less(noise, 0.0)):
        raise learned.fault("noise", "no negative number")
    return noise


def newrb_from(settings: Table, learned: Table) -> NewrbRegressor:
    """Return the NewrbRegressor of a model's settings and learned values."""
    estimator = NewrbRegressor(**settings_of(settings, NewrbRegressor))
    _read_network(learned, estimator)
    outputs = estimator.weights_.reshape(len(estimator.centers_), -1).shape[1]
    count = len(estimator.centers_)
    steps = learned.values.get("history")
    if not isinstance(steps, list) or len(steps) != count:
        raise learned.fault("history", f"a list of {count}, one a neuron")
    estimator.history_ = tuple(
        _step(Table(step, f"{learned.place}: history[{place}]"), place + 1, outputs)
        for place, step in enumerate(steps)
    )
    reason = learned.text("stop_reason")
    if reason not in get_args(StopReason):
        raise learned.fault("stop_reason", " or ".join(get_args(StopReason)))
    estimator.stop_reason_ = cast(StopReason, reason)
    has_floor = learned.values.get("floor", 0) is not None
    estimator.floor_ = learned.array("floor", (outputs,)) if has_floor else None
    return estimator


def _step(step: Table, neurons: int, outputs: int) -> GrowthStep:
    has_ratio = step.values.get("floor_ratio", 0) is not None
    step.expect("neurons", neurons)
    return GrowthStep(
        neurons=neurons,
        mse=step.array("mse", (outputs,)),
        floor_ratio=step.number("floor_ratio") if has_ratio else None,
        distinct_centers=step.count("distinct_centers", neurons),
    )


def settings_of(settings: Table, learner: type[Any]) -> dict[str, Any]:
    """Return a learner's settings; raise ValueError where they are not those that it has."""
    names = {field.name for field in fields(learner)}
    if set(settings.values) != names:
        raise ValueError(
            f"{settings.place}: expected {', '.join(sorted(names))}; "
            f"found {', '.join(sorted(settings.values)) or 'nothing'}"
        )
    return settings.values


def _read_network(learned: Table, estimator: RBFRegressor | NewrbRegressor) -> None:
    """Read what `predict` needs."""
    features = learned.count("n_features_in", MOST_FEATURES)
    estimator.n_features_in_ = features
    estimator.centers_ = learned.array("centers", (None, features))
    estimator.width_ = learned.number("width", positive=True)
    count = len(estimator.centers_)
    if isinstance(learned.values.get("bias"), list):
        estimator.bias_ = learned.array("bias", (None,))
        estimator.weights_ = learned.array("weights", (count, len(estimator.bias_)))
    else:
        estimator.bias_ = learned.number("bias")
        estimator.weights_ = learned.array("weights", (count,))
