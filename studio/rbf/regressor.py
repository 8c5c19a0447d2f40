"""The Gaussian network fitted in one linear solve: the paper's Section III-B, made safe."""

from dataclasses import dataclass
from typing import Any, Literal, Self, get_args, overload

import numpy as np
from numpy.typing import ArrayLike

from studio.rbf.aggregation import DistinctInputs, distinct_inputs
from studio.rbf.basis import (
    FloatArray,
    largest_distance_width,
    nearest_center_width,
    network_output,
)
from studio.rbf.centers import (
    CenterRule,
    RandomState,
    greedy_centers,
    grid_centers,
    place_centers,
)
from studio.rbf.contract import change_settings, get_settings, regressor_tags, require_fitted
from studio.rbf.derivatives import network_derivative
from studio.rbf.gcv import Choice, choose, mean_target, width_candidates
from studio.rbf.linear import effective_dof, ridge_weights
from studio.rbf.score import r_squared
from studio.rbf.uncertainty import covariance_root, noise_of, predictive_std
from studio.rbf.validation import (
    as_inputs,
    as_inputs_like,
    as_targets,
    as_taught,
    number_above,
    one_of,
    whole_number,
)

WidthRule = Literal["dmax", "nearest", "gcv"]
SolverRule = Literal["svd", "gcv"]


@dataclass(eq=False)
class RBFRegressor:
    """A network of Gaussians (Eq. 6 to 9) whose output weights come from least squares (Eq. 14).

    It learns ``f(x) = bias + sum_j weights_j exp(-||x - centers_j||^2 / (2 width^2))``. The bias
    is the mean target, so that far from all centers the network answers the mean; the weights fit
    the rest. Repeated inputs are drawn together exactly. The unit of the inputs changes nothing:
    every choice made here is relative to their extent.

    Parameters
    ----------
    n_neurons : int, default 50
        How many Gaussians. More than there are distinct inputs teach nothing new: `rank_` says
        how many directions the samples could tell apart.
    centers : {"grid", "kmeans", "random", "ols"} or array (m,) or (m, d), default "grid"
        "grid" divides the sorted inputs evenly (in more than one dimension: inputs spread out by
        maximin), "kmeans" takes cluster means, "random" draws inputs. "ols" takes inputs greedily
        by orthogonal least squares, anew for every width that is tried, and may end with fewer
        than `n_neurons` where Gaussians so wide have no more to add. An array, in the unit of the
        inputs, is taken as it is, and `n_neurons` then says nothing.
    width : {"dmax", "nearest", "gcv"} or positive number, default "gcv"
        One sigma for all Gaussians: "dmax" by Eq. 13, "nearest" the mean distance from a center
        to the next, "gcv" the best of 10 by generalized cross-validation, or a number in the unit
        of the inputs. Greedy centers come after their width: there, the rules look at a grid.
    solver : {"svd", "gcv"} or number >= 0, default "gcv"
        "svd" is Eq. 14 through a truncated singular value decomposition, "gcv" adds a ridge chosen
        by generalized cross-validation over the distinct inputs, a number is that ridge itself:
        the weights minimize the summed squared error of all samples plus ridge times their own.
    rcond : number from 0 to below 1, default 1e-10
        Singular values below this share of the largest are dropped.
    random_state : int, numpy Generator or None, default None
        Seed of "kmeans" and "random".

    Attributes
    ----------
    centers_ : (m, d), in the unit of the inputs
    width_ : float, in the unit of the inputs
    weights_ : (m,) or (m, k), as y was
    bias_ : float or (k,)
    ridge_ : float
    rank_ : int
        Directions that were kept.
    condition_ : float
        Condition of the matrix of Eq. 14 before the cut, its rows weighted by the square roots of
        their counts; may be infinite.
    effective_dof_ : float
        Trace of the matrix that takes the targets to the fit, the bias included.
    noise_ : float, (k,) or None
        Standard deviation of the samples about the network, ``sqrt(RSS / (n - effective_dof_))``;
        None where less than one degree of freedom is left to judge it by.
    covariance_root_ : (m + 1, rank_ + 1)
        A root of the covariance of bias and weights, for noise 1; see `predict`.
    n_features_in_ : int

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(1.0, 143.0)
    >>> q = np.column_stack([np.sin(t / 30.0), np.cos(t / 30.0)])
    >>> model = RBFRegressor(n_neurons=20).fit(t, q)
    >>> model.predict([15.0]).round(3)
    array([[0.479, 0.878]])
    >>> bool(abs(model.predict(t) - q).max() < 1e-4)
    True
    >>> model.derivative([15.0]).round(4)  # d/dt of sin(t / 30) and cos(t / 30)
    array([[ 0.0293, -0.016 ]])

    """

    n_neurons: int = 50
    centers: CenterRule | ArrayLike = "grid"
    width: WidthRule | float = "gcv"
    solver: SolverRule | float = "gcv"
    rcond: float = 1e-10
    random_state: RandomState = None

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Learn targets (n,) or (n, k) at inputs (n,) or (n, d).

        Raises
        ------
        ValueError
            Where a setting or the samples cannot be used; the message says why.
        TypeError
            Where a setting is of the wrong type.

        """
        count = whole_number(self.n_neurons, "n_neurons")
        rcond = number_above(self.rcond, "rcond", 0.0, inclusive=True)
        if rcond >= 1.0:
            raise ValueError(f"rcond is below 1, not {self.rcond!r}")
        ridge = self._given_ridge()
        inputs = as_inputs(X)
        targets = as_targets(y, len(inputs))
        data = distinct_inputs(inputs, targets.reshape(len(inputs), -1))
        centers, choice = self._network(data, count, ridge, rcond)
        root_counts = data.root_counts
        bias = mean_target(data)
        residual = root_counts[:, np.newaxis] * (data.means - bias)
        weights = ridge_weights(choice.svd, residual, choice.ridge) * data.target_units
        # One layout always, or a model read from a file might round its sums otherwise.
        self.weights_ = np.ascontiguousarray(weights.reshape(-1, *targets.shape[1:]))
        self.bias_ = as_taught(bias * data.target_units, targets)
        self.centers_ = np.ascontiguousarray(centers * data.input_unit)
        self.width_ = choice.width * data.input_unit
        self.ridge_ = choice.ridge
        self.rank_ = choice.svd.rank
        self.condition_ = choice.svd.condition
        self.effective_dof_ = effective_dof(choice.svd, root_counts, choice.ridge)
        noise = noise_of(data, residual, choice, self.effective_dof_)
        self.noise_ = None if noise is None else as_taught(noise * data.target_units, targets)
        self.covariance_root_ = covariance_root(choice, len(inputs))
        self.n_features_in_ = inputs.shape[1]
        return self

    @overload
    def predict(self, X: ArrayLike, return_std: Literal[False] = False) -> FloatArray: ...

    @overload
    def predict(self, X: ArrayLike, return_std: Literal[True]) -> tuple[FloatArray, FloatArray]: ...

    def predict(
        self, X: ArrayLike, return_std: bool = False
    ) -> FloatArray | tuple[FloatArray, FloatArray]:
        """Return what the network answers to inputs (n,) or (n, d): (n,) or (n, k), as y was.

        With ``return_std`` also the standard deviation of one new sample at each input, in the
        same shape: the noise of `noise_`, and what the samples left uncertain about bias and
        weights,

            std(x)^2 = noise^2 (1 + 1/n + phi(x)^T (Phi^T Phi + ridge I)^-1 phi(x)).

        Without a ridge it is the prediction interval of least squares, with one the posterior of
        Bayesian linear regression (Bishop 2006, Eq. 3.59; for the noise, Wahba 1983). It takes the
        noise as equal everywhere, and the samples as independent: a person's repetitions are not
        along time, so the second part is too small for them. Far from all centers only the noise
        is left: it does not warn of extrapolation.

        Raises
        ------
        NotFittedError
            Before `fit`.
        ValueError
            Where the inputs cannot be used; with ``return_std`` also where the samples left less
            than one degree of freedom to tell noise from curve.

        """
        require_fitted(self)
        inputs = as_inputs_like(X, self.n_features_in_, self)
        network = (self.centers_, self.width_)
        answer = network_output(inputs, *network, self.weights_, self.bias_)
        if not return_std:
            return answer
        if self.noise_ is None:
            raise ValueError(
                "the network fits the samples to less than one degree of freedom, so they do not "
                "tell noise from curve: use fewer neurons, or more samples"
            )
        return answer, predictive_std(inputs, *network, self.covariance_root_, self.noise_)

    def derivative(self, X: ArrayLike, order: int = 1) -> FloatArray:
        """Return a derivative of the network's answer by its input, exact and not by differences.

        Parameters
        ----------
        X : (n,) or (n, d)
        order : int from 1 up, default 1
            1 the velocity, 2 the acceleration, ... in units of the outputs by the unit of the
            inputs to this power. With more than one feature only 1, the Jacobian.

        Returns
        -------
        As `predict` for one feature, (n,) or (n, k); for d features (n, d) or (n, k, d).

        Raises
        ------
        NotFittedError
            Before `fit`.
        ValueError, TypeError
            Where the inputs or the order cannot be used, or float64 does not hold the answer.

        """
        require_fitted(self)
        inputs = as_inputs_like(X, self.n_features_in_, self)
        order = whole_number(order, "order")
        return network_derivative(inputs, self.centers_, self.width_, self.weights_, order)

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

    def _network(
        self, data: DistinctInputs, count: int, ridge: float | None, rcond: float
    ) -> tuple[FloatArray, Choice]:
        """Return the centers (m, d), in the unit that the data are scaled to, and the rest."""
        if not isinstance(self.centers, str) or self.centers != "ols":
            centers = place_centers(self.centers, data, count, self.random_state)
            return centers, choose(data, centers, self._widths(centers, data), ridge, rcond)
        widths = self._widths(grid_centers(data.inputs, count), data)
        picked = [greedy_centers(data, count, float(width)) for width in widths]
        choices = [
            (centers, choose(data, centers, [width], ridge, rcond))
            for centers, width in zip(picked, widths, strict=True)
        ]
        return min(choices, key=lambda each: each[1].score)

    def _given_ridge(self) -> float | None:
        """Return the ridge that the setting names, or None where it is to be searched."""
        if not isinstance(self.solver, str):
            return number_above(self.solver, "a ridge as solver", 0.0, inclusive=True)
        one_of(self.solver, "solver", get_args(SolverRule), " or a ridge, a number from 0 up")
        return None if self.solver == "gcv" else 0.0

    def _widths(self, centers: FloatArray, data: DistinctInputs) -> FloatArray:
        """Return the widths (w,) to choose from, in the unit that the data are scaled to."""
        if not isinstance(self.width, str):
            width = number_above(self.width, "width", 0.0, inclusive=False)
            return np.array([width / data.input_unit])
        one_of(self.width, "width", get_args(WidthRule), " or a positive number")
        if self.width == "gcv":
            return width_candidates(centers, data.inputs)
        rule = largest_distance_width if self.width == "dmax" else nearest_center_width
        return np.array([rule(centers, data.inputs)])
