"""The learners that one would pick instead: the paper's own further work. Extra "compare".

Each is made to fit the studio's interface and nothing more; what it does is its own package's.
"""

import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studio.engine.learners.kind import LearnerKind, grid, part
from studio.engine.skeleton import FloatArray
from studio.engine.teaching import Model

_LEAST = 1e-6  # variance of a component to begin with, where outputs are of variance 1
FINER = 4  # steps of a rolled-out primitive between two stamps


@dataclass(eq=False)
class Standardized:
    """Gives a learner inputs and outputs of mean 0 and standard deviation 1, as all of them want.

    Outputs that never change are left at 0.
    """

    learner: Any
    _scales: list[FloatArray] = field(default_factory=list, init=False, repr=False)

    def fit(self, X: FloatArray, Y: FloatArray) -> "Standardized":
        """Learn rows (n, D) at stamps (n,) or (n, 1)."""
        X = X.reshape(len(X), 1)
        spread = Y.std(axis=0)
        self._scales = [X.mean(axis=0), X.std(axis=0), Y.mean(axis=0), spread]
        steady = np.where(spread > 0.0, spread, 1.0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that an optimizer stopped early is seen in the error
            self.learner.fit((X - self._scales[0]) / self._scales[1], (Y - Y.mean(axis=0)) / steady)
        return self

    def predict(self, X: FloatArray) -> FloatArray:
        """Return rows (n, D) at stamps (n,) or (n, 1)."""
        middle, unit, mean, spread = self._scales
        found = np.asarray(self.learner.predict((X.reshape(len(X), 1) - middle) / unit))
        answer: FloatArray = found.reshape(len(X), -1) * spread + mean
        return answer


@dataclass(eq=False)
class MixtureRegression:
    """Gaussian mixture regression (Calinon, Guenter and Billard 2007) by the package gmr."""

    components: int

    def fit(self, X: FloatArray, Y: FloatArray) -> "MixtureRegression":
        """Learn the joint density of inputs (n, 1) and outputs (n, D) by EM.

        EM begins with an even share of the time for each component, as is usual for motions: from
        a random start it ends in far worse densities.
        """
        samples = np.hstack([X, Y])
        shares = np.array_split(samples[np.argsort(X.ravel(), kind="stable")], self.components)
        start = {
            "priors": np.full(self.components, 1.0 / self.components),
            "means": np.array([share.mean(axis=0) for share in shares]),
            "covariances": np.array(
                [np.cov(share.T) + _LEAST * np.eye(1 + Y.shape[1]) for share in shares]
            ),
        }
        mixture = part("gmr", "GMM")(self.components, random_state=0, **start)
        self._mixture = mixture.from_samples(samples)
        return self

    def predict(self, X: FloatArray) -> FloatArray:
        """Return the mean outputs (n, D) given inputs (n, 1)."""
        return np.asarray(self._mixture.predict(np.array([0]), X))


@dataclass(eq=False)
class MovementPrimitive:
    """A dynamical movement primitive (Ijspeert et al. 2013) of the mean demonstration.

    By the package movement-primitives. It is rolled out once, `FINER` than the stamps; in between
    runs a cubic spline.
    """

    weights: int

    def fit(self, X: FloatArray, Y: FloatArray) -> "MovementPrimitive":
        """Imitate the mean row of each stamp."""
        stamps, demonstrations = unstacked(X, Y)
        duration = stamps[-1] - stamps[0]
        step = duration / (FINER * (len(stamps) - 1))
        primitive = part("movement_primitives.dmp", "DMP")(
            Y.shape[1], execution_time=duration, dt=step, n_weights_per_dim=self.weights
        )
        primitive.imitate(stamps - stamps[0], demonstrations.mean(axis=0))
        times, path = primitive.open_loop(run_t=duration, step_function="rk4")
        self._motion = CubicSpline(times + stamps[0], path)
        return self

    def predict(self, X: FloatArray) -> FloatArray:
        """Return the roll-out (n, D) at stamps (n,) or (n, 1)."""
        return np.asarray(self._motion(X.ravel()))


@dataclass(eq=False)
class ProbabilisticPrimitive:
    """The mean of a probabilistic movement primitive (Paraschos et al. 2013).

    By the package movement-primitives.
    """

    weights: int

    def fit(self, X: FloatArray, Y: FloatArray) -> "ProbabilisticPrimitive":
        """Imitate all demonstrations."""
        stamps, demonstrations = unstacked(X, Y)
        self._start, self._duration = stamps[0], stamps[-1] - stamps[0]
        times = np.tile((stamps - self._start) / self._duration, (len(demonstrations), 1))
        self._primitive = part("movement_primitives.promp", "ProMP")(Y.shape[1], self.weights)
        self._primitive.imitate(times, demonstrations)
        return self

    def predict(self, X: FloatArray) -> FloatArray:
        """Return the mean trajectory (n, D) at stamps (n,) or (n, 1)."""
        phase = (X.ravel() - self._start) / self._duration
        # It wants times that rise, and takes the last one for the end of the motion.
        order = np.argsort(phase, kind="stable")
        asked = np.append(phase[order], 1.0)
        answer = np.empty((len(phase), self._primitive.n_dims))
        answer[order] = self._primitive.mean_trajectory(asked)[:-1]
        return answer


def unstacked(X: FloatArray, Y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the shared stamps (T,) and the demonstrations (K, T, D) of stacked samples."""
    stamps = np.unique(X.ravel())
    count = len(X) // len(stamps)
    return stamps, Y.reshape(count, len(stamps), -1)


def _gaussian_process(smoothness: float, length: float, noise: float) -> Model:
    kernel = part("sklearn.gaussian_process.kernels", "Matern")(length, nu=smoothness)
    regressor = part("sklearn.gaussian_process", "GaussianProcessRegressor")
    return Standardized(regressor(kernel, alpha=noise, optimizer=None))


def _kernel_ridge(length: float, ridge: float) -> Model:
    regressor = part("sklearn.kernel_ridge", "KernelRidge")
    return Standardized(regressor(kernel="rbf", gamma=0.5 / length**2, alpha=ridge))


def _perceptron(layers: tuple[int, ...], penalty: float) -> Model:
    regressor = part("sklearn.neural_network", "MLPRegressor")
    settings = {"activation": "tanh", "solver": "lbfgs", "max_iter": 500, "random_state": 0}
    return Standardized(regressor(hidden_layer_sizes=layers, alpha=penalty, **settings))


def _mixture(components: int) -> Model:
    return Standardized(MixtureRegression(components))


_SKLEARN = ("sklearn",)
_PRIMITIVES = ("movement_primitives", "pytransform3d")
RIVALS = (
    LearnerKind(
        "gp",
        "Gaussian process (scikit-learn)",
        _gaussian_process,
        grid(smoothness=(1.5, 2.5), length=(0.3, 1.0, 3.0), noise=(0.03, 0.3)),
        needs=_SKLEARN,
    ),
    LearnerKind(
        "kernel-ridge",
        "kernel ridge (scikit-learn)",
        _kernel_ridge,
        grid(length=(0.1, 0.2, 0.4, 0.8), ridge=(0.001, 0.03, 1.0)),
        needs=_SKLEARN,
    ),
    LearnerKind(
        "mlp",
        "multilayer perceptron (scikit-learn)",
        _perceptron,
        grid(layers=((10,), (30,), (100,), (30, 30)), penalty=(1e-4, 1e-2, 1.0)),
        needs=_SKLEARN,
    ),
    LearnerKind(
        "gmr",
        "Gaussian mixture regression (gmr)",
        _mixture,
        grid(components=(3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 17, 20)),
        needs=("gmr",),
    ),
    LearnerKind(
        "dmp",
        "dynamical movement primitive",
        MovementPrimitive,
        grid(weights=(5, 8, 10, 12, 15, 20, 25, 30, 40, 50, 75, 100)),
        needs=_PRIMITIVES,
    ),
    LearnerKind(
        "promp",
        "probabilistic movement primitive",
        ProbabilisticPrimitive,
        grid(weights=(5, 8, 10, 12, 15, 20, 25, 30, 35, 40, 50, 60)),
        needs=_PRIMITIVES,
    ),
)
