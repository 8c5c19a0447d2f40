"""MATLAB's newrb, which the paper trains with, by its documented behavior."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any, Literal, Self, get_args

import numpy as np
from numpy.typing import ArrayLike

from studio.rbf.aggregation import DistinctInputs, distinct_inputs
from studio.rbf.basis import FloatArray, gaussian_design, network_output, spread_to_width
from studio.rbf.contract import change_settings, get_settings, regressor_tags, require_fitted
from studio.rbf.leastsquares import GrowingLeastSquares
from studio.rbf.score import r_squared
from studio.rbf.selection import deflated_picks, independent_picks
from studio.rbf.validation import (
    as_inputs,
    as_inputs_like,
    as_targets,
    as_taught,
    number_above,
    one_of,
    whole_number,
)

Duplicates = Literal["mask", "matlab"]
LARGEST_ROOT = 1e150  # its square is still a number
StopReason = Literal["goal", "max_neurons", "exhausted"]


@dataclass(frozen=True, eq=False)
class GrowthStep:
    """The network after one more neuron.

    Examples
    --------
    >>> import numpy as np
    >>> index = np.arange(1.0, 11.0)
    >>> step = NewrbRegressor(max_neurons=3).fit(index, np.sin(index)).history_[-1]
    >>> step.neurons, step.distinct_centers
    (3, 3)

    """

    neurons: int
    mse: FloatArray  # (k,), over all samples
    floor_ratio: float | None  # mean MSE over mean floor; None where no input repeats
    distinct_centers: int


@dataclass(eq=False)
class NewrbRegressor:
    """A network of Gaussians grown one neuron at a time, as MATLAB's newrb grows it.

    Each new center is the sample that orthogonal least squares scores highest (see
    `studio.rbf.selection`); then weights and a bias are solved anew for all neurons.

    Unlike `RBFRegressor` it keeps the unit of the inputs, for its spread is defined in it: spread
    1 means one sample where the input is a sample's number, and one second where it is seconds.

    Parameters
    ----------
    goal : number >= 0, default 0.0
        Growth stops once the mean square error over samples and outputs is below it.
    spread : positive number, default 1.0
        Distance at which a neuron answers one half, in the unit of the inputs.
    max_neurons : int or None, default None
        Growth stops at this many; None means as many as there are samples.
    duplicates : {"mask", "matlab"}, default "mask"
        "mask" never picks what the chosen centers already span. "matlab" leaves repeated samples
        in the race as MATLAB does: deflated to rounding noise they still win, a network of 250
        neurons on 142 distinct stamps becomes possible, and its error still falls past 142.
        Which noise wins differs between machines, as it does in MATLAB.

    Attributes
    ----------
    centers_ : (m, d), in the order in which they were picked
    width_ : float
        The spread as a sigma, in the unit of the inputs.
    weights_ : (m,) or (m, k), as y was
        Zero for a center that those before it span.
    bias_ : float or (k,)
    history_ : tuple of GrowthStep, one a neuron
    stop_reason_ : {"goal", "max_neurons", "exhausted"}
        "exhausted" where no candidate was left.
    floor_ : (k,) or None
        Mean square that no function of the input can undercut; None where no input repeats.
    n_features_in_ : int

    Examples
    --------
    >>> import numpy as np
    >>> index = np.arange(1.0, 143.0)
    >>> model = NewrbRegressor(spread=10.0, goal=1e-4).fit(index, np.sin(index / 20.0))
    >>> model.stop_reason_, len(model.history_) == len(model.centers_)
    ('goal', True)
    >>> bool(model.history_[-1].mse < 1e-4)
    True

    """

    goal: float = 0.0
    spread: float = 1.0
    max_neurons: int | None = None
    duplicates: Duplicates = "mask"

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Learn targets (n,) or (n, k) at inputs (n,) or (n, d).

        Raises
        ------
        ValueError
            Where a setting or the samples cannot be used; the message says why.
        TypeError
            Where a setting is of the wrong type.

        """
        goal = number_above(self.goal, "goal", 0.0, inclusive=True)
        spread = number_above(self.spread, "spread", 0.0, inclusive=False)
        limit = None if self.max_neurons is None else whole_number(self.max_neurons, "max_neurons")
        one_of(self.duplicates, "duplicates", get_args(Duplicates))
        inputs = as_inputs(X)
        targets = as_targets(y, len(inputs))
        data = distinct_inputs(inputs, targets.reshape(len(inputs), -1)).by_first_appearance()
        if data.target_units.max() > LARGEST_ROOT:
            raise ValueError("the squares of the targets overflow float64: use another unit")
        width = spread_to_width(spread / data.input_unit)
        design = data.root_counts[:, np.newaxis] * gaussian_design(data.inputs, data.inputs, width)
        growth = _grow(design, data, islice(_picks(design, data, self.duplicates), limit), goal)
        # One layout always, or a model read from a file might round its sums otherwise.
        self.weights_ = np.ascontiguousarray(growth.weights.reshape(-1, *targets.shape[1:]))
        self.bias_ = as_taught(growth.bias, targets)
        self.centers_ = np.ascontiguousarray(data.inputs[growth.chosen] * data.input_unit)
        self.width_ = width * data.input_unit
        if not 0.0 < self.width_ < np.inf:
            raise ValueError("X spans so little that no width is a float64: use another unit")
        self.history_ = growth.history
        self.stop_reason_ = _stop_reason(growth, limit)
        self.floor_ = data.floor
        self.n_features_in_ = inputs.shape[1]
        return self

    def predict(self, X: ArrayLike) -> FloatArray:
        """Return what the network answers to inputs (n,) or (n, d): (n,) or (n, k), as y was.

        Raises
        ------
        NotFittedError
            Before `fit`.
        ValueError
            Where the inputs cannot be used.

        """
        require_fitted(self)
        inputs = as_inputs_like(X, self.n_features_in_, self)
        return network_output(inputs, self.centers_, self.width_, self.weights_, self.bias_)

    def score(self, X: ArrayLike, y: ArrayLike) -> float:
        """Return R^2, the mean over outputs, as scikit-learn defines it."""
        return r_squared(y, self.predict(X))

    def get_params(self, deep: bool = True) -> dict[str, Any]:  # noqa: ARG002 scikit-learn's name
        """Return the settings by name."""
        return get_settings(self)

    def set_params(self, **params: Any) -> Self:
        """Change settings by name; raise ValueError for a name that is none."""
        change_settings(self, params)
        return self

    def __sklearn_tags__(self) -> Any:
        return regressor_tags()


@dataclass(frozen=True, eq=False)
class _Growth:
    chosen: list[int]
    bias: FloatArray  # (k,)
    weights: FloatArray  # (m, k)
    history: tuple[GrowthStep, ...]
    goal_met: bool


def _picks(design: FloatArray, data: DistinctInputs, duplicates: Duplicates) -> Iterator[int]:
    energies = data.counts.sum() * data.mean_square
    root_counts = data.root_counts[:, np.newaxis]
    if duplicates == "mask":
        return independent_picks(design, root_counts * data.means, energies)
    # Rounding decides there, so every sample keeps a row of its own, as it does in MATLAB.
    answers = (design / root_counts)[data.group]
    return deflated_picks(answers, data.means[data.group], energies, data.counts)


def _grow(design: FloatArray, data: DistinctInputs, picks: Iterator[int], goal: float) -> _Growth:
    """Add the picks until the goal is met or they end; weights and bias are always the best."""
    fit = GrowingLeastSquares(data.root_counts, data.root_counts[:, np.newaxis] * data.means)
    samples, floor = float(data.counts.sum()), data.floor
    squared_units = np.square(data.target_units)
    floor_sum = 0.0 if floor is None else float(floor.sum())
    distinct: set[int] = set()
    chosen: list[int] = []
    history: list[GrowthStep] = []
    goal_met = False
    for pick in picks:
        fit.add(design[:, pick])
        chosen.append(pick)
        distinct.add(pick)
        missed = np.add.reduce(fit.residual * fit.residual, axis=0)
        mse = (data.within + missed / samples) * squared_units
        total = float(np.add.reduce(mse))
        ratio = total / floor_sum if floor_sum > 0.0 else None
        history.append(GrowthStep(len(chosen), mse, ratio, len(distinct)))
        goal_met = total < goal * len(mse)
        if goal_met:
            break
    bias, weights = fit.solution()
    units = data.target_units
    return _Growth(chosen, bias * units, weights * units, tuple(history), goal_met)


def _stop_reason(growth: _Growth, limit: int | None) -> StopReason:
    if growth.goal_met:
        return "goal"
    return "max_neurons" if len(growth.chosen) == limit else "exhausted"
