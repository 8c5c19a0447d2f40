"""Width and ridge chosen by generalized cross-validation (Golub, Heath and Wahba 1979).

The score of a linear fit with residual r and trace of its hat matrix H is
``n ||r||^2 / (n - trace H)^2``, a rotation-invariant stand-in for leaving out one input at a time.
The n are the *distinct* inputs: the repeats of one stamp are not independent tests of the curve's
shape, and counting them lets ripple through.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from studio.rbf.aggregation import DistinctInputs
from studio.rbf.basis import FloatArray, extent, gaussian_design, mean_nearest_distance
from studio.rbf.linear import TruncatedSVD, bias_shares, removed_shares, truncated_svd

WIDTH_CANDIDATES = 10  # from `NARROWEST` to the extent they lie a factor of 1.5 apart at 50 neurons
NARROWEST = 1.4  # times the spacing; narrower ones fit no better, and ripple between the samples
RIDGE_CANDIDATES = 45  # four a decade of sqrt(ridge) / largest singular value
LARGEST_RIDGE = 10.0  # in that same measure: the fit is then all but flat


@dataclass(frozen=True, eq=False)
class Choice:
    """One width and ridge with the decomposition that they were judged by."""

    width: float
    ridge: float
    svd: TruncatedSVD
    score: float


def width_candidates(centers: FloatArray, inputs: FloatArray) -> FloatArray:
    """Return widths from `NARROWEST` spacings of centers and inputs up to the inputs' extent."""
    largest = extent(inputs)
    if largest == 0.0:
        return np.array([1.0])
    spacing = max(mean_nearest_distance(centers), mean_nearest_distance(inputs))
    narrowest = min(NARROWEST * spacing, largest / 4.0)
    widths: FloatArray = np.geomspace(narrowest, largest, WIDTH_CANDIDATES)
    return widths


def ridge_candidates(svd: TruncatedSVD, rcond: float) -> FloatArray:
    """Return ridges (l,) between the cut of the decomposition and an all but flat fit."""
    if svd.rank == 0:
        return np.zeros(1)
    ridges: FloatArray = np.square(_ridge_ratios(rcond) * svd.singular[0])
    return ridges


@cache
def _ridge_ratios(rcond: float) -> FloatArray:
    """Return sqrt(ridge) / largest singular value for every candidate; nobody changes it."""
    smallest = max(rcond, float(np.finfo(np.float64).eps))
    ratios: FloatArray = np.geomspace(smallest, LARGEST_RIDGE, RIDGE_CANDIDATES)
    return ratios


def gcv_scores(
    svd: TruncatedSVD, targets: FloatArray, root_counts: FloatArray, ridges: FloatArray
) -> FloatArray:
    """Return the score of every ridge (l,), summed over outputs relative to their own size.

    ``targets`` (n, k) have their mean removed and are scaled by ``root_counts`` (n,). A ridge that
    leaves no degree of freedom to judge by scores infinity.
    """
    count = len(targets)
    energy = np.square(targets).sum(axis=0)
    relevance = np.divide(1.0, energy, out=np.zeros_like(energy), where=energy > 0.0)
    removed = removed_shares(svd, ridges)
    components = svd.left.T @ targets
    squares = np.square(components) @ relevance
    free_of_bias = 1.0 - bias_shares(svd, root_counts)
    residual = np.square(removed) @ squares
    free = removed @ free_of_bias
    if svd.rank < count:  # else the design spans everything, and what follows is rounding only
        residual += np.square(targets - svd.left @ components).sum(axis=0) @ relevance
        free += max(count - 1.0 - float(free_of_bias.sum()), 0.0)
    score = np.full(len(ridges), np.inf)
    np.divide(count * residual, np.square(free), out=score, where=free > count * 1e-15)
    return score


def choose(
    data: DistinctInputs,
    centers: FloatArray,
    widths: Sequence[float] | FloatArray,
    ridge: float | None,
    rcond: float,
) -> Choice:
    """Return the best of these widths, each with the given ridge or, where None, its best one."""
    root_counts = data.root_counts
    targets = root_counts[:, np.newaxis] * (data.means - mean_target(data))
    best: Choice | None = None
    for width in widths:
        design = root_counts[:, np.newaxis] * gaussian_design(data.inputs, centers, float(width))
        svd = truncated_svd(design, rcond)
        ridges = ridge_candidates(svd, rcond) if ridge is None else np.array([ridge])
        scores = gcv_scores(svd, targets, root_counts, ridges)
        place = int(np.argmin(scores))
        if best is None or scores[place] < best.score:
            best = Choice(float(width), float(ridges[place]), svd, float(scores[place]))
    if best is None:
        raise ValueError("there is no width to choose from")
    return best


def mean_target(data: DistinctInputs) -> FloatArray:
    """Return the mean of all samples' targets (k,)."""
    relative = data.means - data.means[0]  # exact where the targets never change
    weighted: FloatArray = data.counts @ relative / data.counts.sum() + data.means[0]
    return weighted
