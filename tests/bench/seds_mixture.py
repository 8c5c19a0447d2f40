"""The mixtures that SEDS chooses among, its two objectives, and their exact gradients.

See `seds.py`. The factors (Sigma, A, S) of a Gaussian over (x, x') hold the same as its joint
covariance, and the publication's conditions ``b_k = -A_k goal`` and ``A_k + A_k^T < 0`` as they
stand. They come out of free numbers by ``A = -B B^T - margin I + (C - C^T)``, which yields every A
with ``A + A^T <= -2 margin I`` and no other.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

MARGIN = 1e-3  # [1 / unit of time] of stability, in scaled data
BIAS = 1e-6  # of variances, in scaled data: no Gaussian collapses on the goal, where samples repeat
LARGEST_LOG = 40.0  # of the diagonals of R and Q: a long step of the optimizer must not overflow


@dataclass(frozen=True, eq=False)
class Mixture:
    """A mixture of K Gaussians over x and x', or the gradient of a number by it."""

    logits: FloatArray  # (K,), logarithms of pi, up to a constant
    means: FloatArray  # (K, d), mu
    whiteners: FloatArray  # (K, d, d) lower triangular, R^T R = Sigma^-1
    systems: FloatArray  # (K, d, d), A
    sharpeners: FloatArray  # (K, d, d) lower triangular, Q^T Q = S^-1

    @property
    def log_priors(self) -> FloatArray:
        """Logarithms of pi (K,)."""
        return self.logits - log_sum(self.logits)

    def log_shares(self, x: FloatArray) -> FloatArray:
        """Return log pi_k N(x; mu_k, Sigma_k) at x (n, d): (K, n)."""
        white = (x - self.means[:, np.newaxis]) @ self.whiteners.transpose(0, 2, 1)
        return self.log_priors[:, np.newaxis] + _log_normal(white, self.whiteners)

    def system(self, x: FloatArray) -> FloatArray:
        """Return A(x) at x (n, d): (n, d, d), every A_k with its weight h_k."""
        shares = self.log_shares(x)
        weights = np.exp(shares - log_sum(shares))
        return np.einsum("kn,kij->nij", weights, self.systems)

    def velocity(self, x: FloatArray) -> FloatArray:
        """Return the mean velocity at x (n, d): (n, d)."""
        return np.einsum("nij,nj->ni", self.system(x), x)


def negative_log_likelihood(
    mixture: Mixture, x: FloatArray, v: FloatArray, bias: float = BIAS
) -> tuple[float, Mixture]:
    """Return the mean of -log p(x, v) over samples (n, d), with what the bias adds; its gradient.

    The bias counts as if every Gaussian had seen that much variance more.
    """
    error = v - x @ mixture.systems.transpose(0, 2, 1)
    sharp = error @ mixture.sharpeners.transpose(0, 2, 1)
    joint = mixture.log_shares(x) + _log_normal(sharp, mixture.sharpeners)
    total = log_sum(joint)
    weights = -np.exp(joint - total) / len(x)  # of the value by each logarithm
    weighted = -weights[..., np.newaxis] * sharp
    by_system = -(weighted @ mixture.sharpeners).transpose(0, 2, 1) @ x
    by_sharpener = weighted.transpose(0, 2, 1) @ error
    by_sharpener += _by_log_diagonal(mixture.sharpeners, weights.sum(axis=1))
    logits, means, whiteners = _by_shares(mixture, x, weights)
    value = -total.mean() + 0.5 * bias * float(
        np.square(mixture.whiteners).sum() + np.square(mixture.sharpeners).sum()
    )
    whiteners += bias * mixture.whiteners
    by_sharpener += bias * mixture.sharpeners
    return value, Mixture(logits, means, whiteners, by_system, by_sharpener)


def squared_error(mixture: Mixture, x: FloatArray, v: FloatArray) -> tuple[float, Mixture]:
    """Return half the mean squared error of velocities (n, d), and its gradient."""
    shares = mixture.log_shares(x)
    weights = np.exp(shares - log_sum(shares))
    each = x @ mixture.systems.transpose(0, 2, 1)  # (K, n, d)
    mean = np.einsum("kn,kni->ni", weights, each)
    error = (mean - v) / len(x)
    by_system = (weights[..., np.newaxis] * error).transpose(0, 2, 1) @ x
    along = np.einsum("kni,ni->kn", each - mean, error)
    found = _by_shares(mixture, x, weights * along)
    value = 0.5 * float(np.square(mean - v).sum()) / len(x)
    return value, Mixture(*found, by_system, np.zeros_like(by_system))


def log_sum(logarithms: FloatArray) -> FloatArray:
    """Return the logarithm of the sum of exponentials over the first axis."""
    largest = logarithms.max(axis=0)
    total: FloatArray = largest + np.log(np.exp(logarithms - largest).sum(axis=0))
    return total


def _log_normal(white: FloatArray, whiteners: FloatArray) -> FloatArray:
    """Return log densities (K, n) of what whiteners (K, d, d) made of samples (K, n, d)."""
    roots = np.log(np.diagonal(whiteners, axis1=1, axis2=2)).sum(axis=1)
    constant = 0.5 * white.shape[2] * np.log(2.0 * np.pi)
    return roots[:, np.newaxis] - 0.5 * np.square(white).sum(axis=2) - constant


def _by_log_diagonal(whiteners: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the gradient (K, d, d) of the weighted (K,) logarithms of the diagonals."""
    inverse = weights[:, np.newaxis] / np.diagonal(whiteners, axis1=1, axis2=2)
    return inverse[:, :, np.newaxis] * np.eye(whiteners.shape[1])


def _by_shares(
    mixture: Mixture, x: FloatArray, weights: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the gradient by logits, means and whiteners, given that by `log_shares` (K, n)."""
    offset = x - mixture.means[:, np.newaxis]
    white = weights[..., np.newaxis] * (offset @ mixture.whiteners.transpose(0, 2, 1))
    by_logits = weights.sum(axis=1) - np.exp(mixture.log_priors) * weights.sum()
    by_means = (white @ mixture.whiteners).sum(axis=1)
    by_whiteners = _by_log_diagonal(mixture.whiteners, weights.sum(axis=1))
    by_whiteners -= white.transpose(0, 2, 1) @ offset
    return by_logits, by_means, by_whiteners


@dataclass(frozen=True)
class Coordinates:
    """Free numbers for mixtures of K Gaussians in d dimensions that keep the constraints."""

    components: int
    dimension: int

    @property
    def free(self) -> int:
        """How many numbers a mixture has; its priors add to 1, so one is not free."""
        d = self.dimension
        return self.components * (1 + d + d * (d + 1) + d * d) - 1

    def mixture(self, point: FloatArray) -> Mixture:
        """Return the mixture at a point of the free space."""
        logits, means, white, roots, turns, sharp = self._split(point)
        gram = roots @ roots.transpose(0, 2, 1) + MARGIN * np.eye(self.dimension)
        systems = turns - turns.transpose(0, 2, 1) - gram
        return Mixture(logits, means, _with_exp(white), systems, _with_exp(sharp))

    def point(self, mixture: Mixture) -> FloatArray:
        """Return the point of a mixture that keeps the constraints."""
        systems = mixture.systems
        gram = -0.5 * (systems + systems.transpose(0, 2, 1)) - MARGIN * np.eye(self.dimension)
        turns = 0.5 * (systems - systems.transpose(0, 2, 1))
        white, sharp = _with_log(mixture.whiteners), _with_log(mixture.sharpeners)
        return self._join(
            mixture.logits, mixture.means, white, np.linalg.cholesky(gram), turns, sharp
        )

    def pulled_back(self, point: FloatArray, gradient: Mixture) -> FloatArray:
        """Return the gradient by the free numbers, given that by the mixture."""
        _, _, white, roots, _, sharp = self._split(point)
        by_roots = -(gradient.systems + gradient.systems.transpose(0, 2, 1)) @ roots
        by_turns = gradient.systems - gradient.systems.transpose(0, 2, 1)
        return self._join(
            gradient.logits,
            gradient.means,
            gradient.whiteners * _diagonal_factors(white),
            by_roots,
            by_turns,
            gradient.sharpeners * _diagonal_factors(sharp),
        )

    def _split(self, point: FloatArray) -> list[FloatArray]:
        k, d = self.components, self.dimension
        sizes = [k, k * d, *(k * len(rows) for rows, _ in self._corners)]
        pieces = np.split(point, np.cumsum(sizes)[:-1])
        found = [pieces[0], pieces[1].reshape(k, d)]
        for piece, (rows, columns) in zip(pieces[2:], self._corners, strict=True):
            matrices = np.zeros((k, d, d))
            matrices[:, rows, columns] = piece.reshape(k, -1)
            found.append(matrices)
        return found

    def _join(self, logits: FloatArray, means: FloatArray, *matrices: FloatArray) -> FloatArray:
        pieces = [
            each[:, rows, columns].ravel()
            for each, (rows, columns) in zip(matrices, self._corners, strict=True)
        ]
        return np.concatenate([logits, means.ravel(), *pieces])

    @cached_property
    def _corners(self) -> tuple[tuple[NDArray[np.intp], NDArray[np.intp]], ...]:
        """Which entries of R, B, C and Q are free."""
        lower, below = np.tril_indices(self.dimension), np.tril_indices(self.dimension, -1)
        return lower, lower, below, lower


def _with_exp(lower: FloatArray) -> FloatArray:
    diagonal = np.eye(lower.shape[1], dtype=bool)
    return np.where(diagonal, np.exp(np.clip(lower, -LARGEST_LOG, LARGEST_LOG)), lower)


def _with_log(lower: FloatArray) -> FloatArray:
    diagonal = np.eye(lower.shape[1], dtype=bool)
    return np.where(diagonal, np.log(np.where(diagonal, lower, 1.0)), lower)


def _diagonal_factors(lower: FloatArray) -> FloatArray:
    inside = np.where(np.abs(lower) < LARGEST_LOG, _with_exp(lower), 0.0)
    return np.where(np.eye(lower.shape[1], dtype=bool), inside, 1.0)
