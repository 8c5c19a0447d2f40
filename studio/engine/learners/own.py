"""The studio's own learners: the paper's networks, and a smoothing spline to hold them against."""

import numpy as np
from scipy.interpolate import make_smoothing_spline

from studio.engine.field_motion import PushAndReturn
from studio.engine.learners.kind import BUDGET, LearnerKind, grid
from studio.engine.skeleton import FloatArray
from studio.engine.teaching import Model
from studio.rbf import NewrbRegressor, RBFRegressor


class SmoothingSpline:
    """A cubic smoothing spline through the mean at each stamp (Craven and Wahba 1979).

    ``penalty`` is that of the squared second derivative; None chooses it by GCV.
    """

    def __init__(self, penalty: float | None) -> None:
        self.penalty = penalty

    def fit(self, X: FloatArray, Y: FloatArray) -> "SmoothingSpline":
        """Learn rows (n, D) at stamps (n,) or (n, 1), of which some repeat."""
        stamps, group, counts = np.unique(X.ravel(), return_inverse=True, return_counts=True)
        sums = np.zeros((len(stamps), Y.shape[1]))
        np.add.at(sums, group.ravel(), Y)
        weights = counts.astype(float)
        self._splines = [
            make_smoothing_spline(stamps, column, weights, self.penalty)
            for column in (sums / weights[:, np.newaxis]).T
        ]
        return self

    def predict(self, X: FloatArray) -> FloatArray:
        """Return the spline (n, D) at stamps (n,) or (n, 1)."""
        return np.column_stack([spline(X.ravel()) for spline in self._splines])


def _paper_network(neurons: int) -> Model:
    return RBFRegressor(neurons, centers="grid", width="dmax", solver="svd")


def _gcv_network(neurons: int) -> Model:
    return RBFRegressor(neurons)


def _greedy_network(neurons: int) -> Model:
    return RBFRegressor(neurons, centers="ols")


def _newrb(neurons: int, spread: float = 1.0) -> Model:
    return NewrbRegressor(spread=spread, max_neurons=neurons, duplicates="matlab")


_COUNTS = grid(neurons=(5, 8, 10, 12, 15, 20, 25, 30, 50, 75, 100, 142))
OWN = (
    LearnerKind(
        "newrb",
        "newrb, as MATLAB has it",
        _newrb,
        grid(neurons=(15, 30, 60, 120), spread=(1.0, 5.0, 20.0)),
        network=True,
    ),
    LearnerKind("rbf", "RBF by Eq. 13 and 14", _paper_network, _COUNTS, network=True),
    LearnerKind("gcv", "RBF, width and ridge by GCV", _gcv_network, _COUNTS, network=True),
    LearnerKind("ols", "RBF, greedy centers, GCV", _greedy_network, _COUNTS, network=True),
    LearnerKind(
        "field",
        "Eq. 5: two stable fields, so many Gaussians each",
        PushAndReturn,
        grid(neurons=(5, 8, 10, 15, 20, 30), bound=(0.5, 0.8)),
        network=True,
    ),
    LearnerKind(
        "spline",
        "smoothing spline",
        SmoothingSpline,
        grid(penalty=(None, *np.geomspace(0.1, 1e5, BUDGET - 1).tolist())),
    ),
)
