"""The Gaussian network and its widths: Eq. 6 to 9 and 13 of the source paper.

The paper prints Eq. 9 as ``exp(-(x - c)^T / r^2)``, which is a vector where a number is meant.
We read ``phi(x) = exp(-||x - c||^2 / (2 sigma^2))``: the Gaussian whose width sigma is what Eq. 13
gives.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist, pdist

FloatArray = NDArray[np.float64]


def gaussian_design(inputs: FloatArray, centers: FloatArray, width: float) -> FloatArray:
    """Return what every Gaussian answers to every input: Eq. 8 and 9, and the matrix of Eq. 14.

    Parameters
    ----------
    inputs : (n, d), in any unit
    centers : (m, d), in the same unit
    width : the sigma of Eq. 13, in the same unit, positive

    Returns
    -------
    (n, m), between 0 and 1

    """
    return gaussians(centers, width)(inputs)


def gaussians(centers: FloatArray, width: float) -> Callable[[FloatArray], FloatArray]:
    """Return `gaussian_design` of these centers as a function of inputs, for being asked often."""
    # Moved to the centers' middle and divided before squaring, so that neither stamps of 1e9 s
    # lose digits nor lengths of 1e-200 vanish.
    middle = 0.5 * centers.min(axis=0) + 0.5 * centers.max(axis=0)
    scaled = (centers - middle) / width

    def answers(inputs: FloatArray) -> FloatArray:
        squared = cdist((inputs - middle) / width, scaled, "sqeuclidean")
        answered: FloatArray = np.exp(-0.5 * squared)
        return answered

    return answers


def network_output(
    inputs: FloatArray,
    centers: FloatArray,
    width: float,
    weights: FloatArray,
    bias: FloatArray | float,
) -> FloatArray:
    """Return ``W^T S(x)`` of Eq. 6 and 7, and a bias as newrb has it: (n,) or (n, k).

    Parameters
    ----------
    inputs : (n, d)
    centers : (m, d)
    width : positive, in the unit of the inputs
    weights : (m,) or (m, k)
    bias : a number, or (k,)

    """
    output: FloatArray = gaussian_design(inputs, centers, width) @ weights + bias
    return output


def spread_to_width(spread: float) -> float:
    """Return the sigma of MATLAB's spread: the distance at which a neuron answers one half.

    Its radial basis is ``exp(-(b * distance)^2)`` with ``b = sqrt(ln 2) / spread``, so
    ``sigma = spread / sqrt(2 ln 2)``.
    """
    return spread / math.sqrt(2.0 * math.log(2.0))


def extent(points: FloatArray) -> float:
    """Return the diagonal of the box around these points (n, d); in one dimension their range."""
    return math.hypot(*np.ptp(points, axis=0))


def largest_distance_width(centers: FloatArray, inputs: FloatArray) -> float:
    """Return Eq. 13, ``sigma = d_max / sqrt(2 M)`` for M centers (m, d).

    Where all centers coincide there is no ``d_max`` among them: the extent of the inputs (n, d)
    takes its place, and 1 where these coincide too and no width matters.
    """
    distances = pdist(centers)
    largest = float(distances.max(initial=0.0)) or extent(inputs) or 1.0
    return largest / math.sqrt(2.0 * len(centers))


def mean_nearest_distance(points: FloatArray) -> float:
    """Return how far the nearest other point is, on average over the distinct points (n, d).

    Zero where there are no two distinct points.
    """
    distinct = np.unique(points, axis=0)
    if len(distinct) < 2:
        return 0.0
    if distinct.shape[1] == 1:
        gaps = np.diff(distinct[:, 0])
        nearest = np.minimum(np.append(gaps, np.inf), np.insert(gaps, 0, np.inf))
    else:
        distances = cdist(distinct, distinct)
        np.fill_diagonal(distances, np.inf)
        nearest = distances.min(axis=1)
    return float(nearest.mean())


def nearest_center_width(centers: FloatArray, inputs: FloatArray) -> float:
    """Return the mean distance from a center (m, d) to the nearest other one.

    With a single distinct center it falls back to Eq. 13.
    """
    return mean_nearest_distance(centers) or largest_distance_width(centers, inputs)
