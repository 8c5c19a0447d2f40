"""SEDS, the Stable Estimator of Dynamical Systems: what `bench_lasa.py` compares with.

Written from S. M. Khansari-Zadeh and A. Billard, "Learning stable nonlinear dynamical systems with
Gaussian mixture models", IEEE Transactions on Robotics 27(5), 943-957 (2011). A Gaussian mixture
over positions and velocities, the goal at the origin, factored as

    p(x, x') = sum_k  pi_k  N(x; mu_k, Sigma_k)  N(x'; A_k x, S_k),

answers the mean velocity at x, ``x' = sum_k h_k(x) A_k x`` with weights ``h_k = p(k | x)``. It is
stable from everywhere where every ``A_k + A_k^T < 0``, for ``||x||^2`` then falls. It maximizes
the likelihood, or minimizes the mean square error of the velocities, under that constraint; it
starts as the publication does, from EM with every A made stable.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from sklearn.mixture import GaussianMixture

from studio.rbf.trajectories import read_demonstrations
from tests.bench.seds_mixture import (
    BIAS,
    Coordinates,
    FloatArray,
    Mixture,
    negative_log_likelihood,
    squared_error,
)

SAMPLES = 100  # a demonstration
MAX_ITERATIONS = 1000  # the authors' own default

Objective = Callable[[Mixture, FloatArray, FloatArray], tuple[float, Mixture]]
Criterion = Callable[[float], float]  # of a loss


@dataclass(frozen=True, eq=False)
class Seds:
    """A field that SEDS learned; the goal is the origin."""

    mixture: Mixture  # of positions over `reach`, velocities over `speed`
    reach: float
    speed: float
    loss: float  # of the objective that it was fitted to, in scaled data
    criterion: float  # the Bayesian information criterion, the smaller the better
    seed: int  # of the EM that it began with

    @property
    def worst_eigenvalue(self) -> float:
        """The largest eigenvalue of all (A + A^T) / 2 [1 / time]: below 0, or it is not stable."""
        systems = self.mixture.systems
        largest = np.linalg.eigvalsh(0.5 * (systems + systems.transpose(0, 2, 1))).max()
        return float(largest * self.speed / self.reach)

    def velocity(self, x: FloatArray) -> FloatArray:
        """Return the velocity at points (n, d): (n, d)."""
        return self.speed * self.mixture.velocity(x / self.reach)

    def rollout(self, x0: FloatArray, dt: float, steps: int) -> FloatArray:
        """Return the paths from starts (n, d): (steps + 1, n, d).

        Far from the demonstrations one A alone may count, and be so large that Runge-Kutta's
        method with this dt blows up. The field is ``x' = A(x) x``, so the exponential midpoint
        rule fits: of second order, and ``||x||`` falls in each step, as it does in the field.
        """
        path = [np.asarray(x0, dtype=np.float64)]
        for _ in range(steps):
            x = path[-1]
            middle = propagated(self._system(x), x, 0.5 * dt)
            path.append(propagated(self._system(middle), x, dt))
        return np.stack(path)

    def _system(self, x: FloatArray) -> FloatArray:
        return self.speed / self.reach * self.mixture.system(x / self.reach)


def propagated(systems: FloatArray, x: FloatArray, dt: float) -> FloatArray:
    """Return exp(dt A) x for systems A (n, d, d) and points x (n, d): (n, d).

    By the Taylor series of a power of 2 less, squared again.
    """
    scaled = dt * systems
    largest = float(np.abs(scaled).sum(axis=2).max())
    halvings = max(0, int(np.ceil(np.log2(max(largest, 1e-300)))) + 2)
    scaled = scaled / 2.0**halvings
    found = term = np.broadcast_to(np.eye(x.shape[1]), scaled.shape)
    for order in range(1, 9):
        term = term @ scaled / order
        found = found + term
    for _ in range(halvings):
        found = found @ found
    return np.einsum("nij,nj->ni", found, x)


@dataclass(frozen=True, eq=False)
class Pair:
    """What the two objectives made of the same demonstrations."""

    likelihood: Seds
    mse: Seds


def learn(
    demonstrations: Sequence[tuple[FloatArray, FloatArray]],
    components: int,
    seeds: Sequence[int] = (0, 1, 2),
    max_iterations: int = MAX_ITERATIONS,
) -> Pair:
    """Fit both objectives to times (T,) and positions (T, d) whose goal is the origin.

    Each seed begins with another EM; the mean square error goes on from where likelihood ended, and
    of all the seeds each objective keeps the one that is best by itself.
    """
    x, v, reach, speed = scaled_samples(demonstrations)
    coordinates = Coordinates(components, x.shape[1])
    likely, exact = {}, {}
    for seed in seeds:
        start = coordinates.point(stable_start(x, v, components, seed))
        likely[seed] = descend(negative_log_likelihood, coordinates, start, x, v, max_iterations)
        exact[seed] = descend(squared_error, coordinates, likely[seed][1], x, v, max_iterations)
    penalty = float(np.log(len(x)))
    unused = components * x.shape[1] * (x.shape[1] + 1) // 2  # S is not in the mean velocity

    def best(found: dict[int, tuple[float, FloatArray]], criterion: Criterion) -> Seds:
        seed = min(found, key=lambda each: found[each][0])
        loss, point = found[seed]
        return Seds(coordinates.mixture(point), reach, speed, loss, criterion(loss), seed)

    return Pair(
        best(likely, lambda loss: 2.0 * len(x) * loss + coordinates.free * penalty),
        best(exact, lambda loss: x.size * np.log(loss) + (coordinates.free - unused) * penalty),
    )


def scaled_samples(
    demonstrations: Sequence[tuple[FloatArray, FloatArray]],
) -> tuple[FloatArray, FloatArray, float, float]:
    """Return positions and velocities (n, d) at even stamps, each with what it was divided by.

    One number divides all axes: the constraints mean the same before and after.
    """
    places, velocities = [], []
    for each in read_demonstrations(demonstrations, None):
        picked = np.linspace(0, len(each.times) - 1, min(SAMPLES, len(each.times))).round()
        places.append(each.positions[picked.astype(int)])
        velocities.append(each.velocities[picked.astype(int)])
    x, v = np.concatenate(places), np.concatenate(velocities)
    reach, speed = float(np.sqrt(np.square(x).mean())), float(np.sqrt(np.square(v).mean()))
    return x / reach, v / speed, reach, speed


def stable_start(x: FloatArray, v: FloatArray, components: int, seed: int) -> Mixture:
    """Return EM's mixture of (x, v), every A of it made stable, S refitted to that."""
    d = x.shape[1]
    both = np.hstack([x, v])
    mixture = GaussianMixture(components, reg_covar=10.0 * BIAS, random_state=seed).fit(both)
    shares = mixture.predict_proba(both)
    whiteners, systems, sharpeners = [], [], []
    for covariance, share in zip(mixture.covariances_, shares.T, strict=True):
        within = covariance[:d, :d]
        system = nearest_stable(np.linalg.solve(within, covariance[:d, d:]).T)
        error = v - x @ system.T
        spread = (share[:, np.newaxis] * error).T @ error / share.sum()
        whiteners.append(_whitener(within))
        systems.append(system)
        sharpeners.append(_whitener(spread + 10.0 * BIAS * np.eye(d)))
    return Mixture(
        np.log(mixture.weights_),
        mixture.means_[:, :d],
        np.stack(whiteners),
        np.stack(systems),
        np.stack(sharpeners),
    )


def nearest_stable(system: FloatArray, least: float = 0.05) -> FloatArray:
    """Return A (d, d) with the eigenvalues of its symmetric part at most -least of the largest."""
    values, vectors = np.linalg.eigh(0.5 * (system + system.T))
    bound = -least * max(1.0, float(np.abs(values).max()))
    symmetric = (vectors * np.minimum(values, bound)) @ vectors.T
    return symmetric + 0.5 * (system - system.T)


def _whitener(covariance: FloatArray) -> FloatArray:
    """Return the lower triangular R (d, d) with R^T R the inverse of a covariance."""
    return np.linalg.inv(np.linalg.cholesky(covariance))


def descend(
    objective: Objective,
    coordinates: Coordinates,
    start: FloatArray,
    x: FloatArray,
    v: FloatArray,
    max_iterations: int,
) -> tuple[float, FloatArray]:
    """Return the least value found from a start, and where it was, by L-BFGS."""

    def valued(point: FloatArray) -> tuple[float, FloatArray]:
        value, gradient = objective(coordinates.mixture(point), x, v)
        return value, coordinates.pulled_back(point, gradient)

    options = {"maxiter": max_iterations, "maxfun": 2 * max_iterations, "maxcor": 20}
    found = minimize(valued, start, jac=True, method="L-BFGS-B", options=options | {"ftol": 1e-7})
    return float(found.fun), found.x
