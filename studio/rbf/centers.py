"""Where the Gaussians sit. The paper only says that they are "selected from the sample"."""

from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.distance import cdist

from studio.rbf.aggregation import DistinctInputs
from studio.rbf.basis import FloatArray
from studio.rbf.validation import as_inputs, one_of

CenterRule = Literal["grid", "kmeans", "random"]
RandomState = int | np.random.Generator | None
LLOYD_ROUNDS = 100  # k-means ends long before, unless clusters swap a point forever


def place_centers(
    rule: CenterRule | ArrayLike, data: DistinctInputs, count: int, random_state: RandomState
) -> FloatArray:
    """Return the centers (m, d) by a rule, or the caller's own, in the unit of the data.

    Raises
    ------
    ValueError
        Where there is no such rule, or the caller's centers do not fit the inputs.

    """
    if not isinstance(rule, str):
        return _own_centers(rule, data)
    one_of(rule, "centers", get_args(CenterRule), " or an array (m, d)")
    if rule == "random":
        return random_centers(data.inputs, count, np.random.default_rng(random_state))
    if rule == "kmeans":
        return kmeans_centers(data, count, np.random.default_rng(random_state))
    return grid_centers(data.inputs, count)


def _own_centers(values: ArrayLike, data: DistinctInputs) -> FloatArray:
    try:
        centers = as_inputs(values)
    except ValueError as error:
        raise ValueError(f"the given centers cannot be used: {error}") from error
    features = data.inputs.shape[1]
    if centers.shape[1] != features:
        raise ValueError(
            f"the given centers have {centers.shape[1]} features, but X has {features}"
        )
    return centers / data.input_unit


def grid_centers(inputs: FloatArray, count: int) -> FloatArray:
    """Return centers (count, d) spread evenly over the distinct inputs (n, d).

    In one dimension they divide the sorted inputs evenly, ends included; between two inputs they
    are interpolated. In more dimensions a lattice would need ``p ** d`` centers, most of them far
    from any sample, so there they are inputs, each the farthest from those before it (maximin,
    from the input nearest to the middle).
    """
    if inputs.shape[1] > 1:
        return _farthest_points(inputs, count)
    ordered = np.sort(inputs[:, 0])
    last = len(ordered) - 1
    places = np.linspace(0.0, last, count) if count > 1 else np.array([0.5 * last])
    centers: FloatArray = np.interp(places, np.arange(last + 1), ordered)[:, np.newaxis]
    return centers


def _farthest_points(inputs: FloatArray, count: int) -> FloatArray:
    """Return inputs chosen by maximin; beyond all of them it begins again from the first."""
    middle = inputs.mean(axis=0, keepdims=True)
    chosen = [int(cdist(middle, inputs).argmin())]
    distances = cdist(inputs[chosen], inputs)[0]
    while len(chosen) < min(count, len(inputs)):
        chosen.append(int(distances.argmax()))
        distances = np.minimum(distances, cdist(inputs[chosen[-1:]], inputs)[0])
    centers: FloatArray = inputs[np.resize(chosen, count)]
    return centers


def random_centers(inputs: FloatArray, count: int, generator: np.random.Generator) -> FloatArray:
    """Return centers (count, d) drawn from the distinct inputs (n, d), each once while they last.

    Beyond all of them, every further round draws each once more.
    """
    rounds = -(-count // len(inputs))
    order = np.concatenate([generator.permutation(len(inputs)) for _ in range(rounds)])
    centers: FloatArray = inputs[order[:count]]
    return centers


def kmeans_centers(data: DistinctInputs, count: int, generator: np.random.Generator) -> FloatArray:
    """Return the means (count, d) of k-means clusters of all samples.

    Lloyd's rounds from a k-means++ start (Arthur and Vassilvitskii 2007). With as many clusters
    as distinct inputs, or more, the centers are those inputs, as `random_centers` draws them.
    """
    if count >= len(data.inputs):
        return random_centers(data.inputs, count, generator)
    centers = _spread_start(data, count, generator)
    for _ in range(LLOYD_ROUNDS):
        nearest = cdist(data.inputs, centers).argmin(axis=1)
        weight = np.bincount(nearest, weights=data.counts, minlength=count)
        sums = [
            np.bincount(nearest, weights=data.counts * column, minlength=count)
            for column in data.inputs.T
        ]
        held = weight > 0.0  # an emptied cluster keeps its center
        moved = centers.copy()
        moved[held] = np.stack(sums, axis=1)[held] / weight[held, np.newaxis]
        if np.array_equal(moved, centers):
            break
        centers = moved
    return centers


def _spread_start(data: DistinctInputs, count: int, generator: np.random.Generator) -> FloatArray:
    """Draw distinct inputs, each with a chance that grows as its squared distance to the others."""
    chosen = [int(generator.choice(len(data.inputs), p=data.counts / data.counts.sum()))]
    nearest = cdist(data.inputs[chosen], data.inputs)[0]
    while len(chosen) < count:
        # Relative to the largest before squaring, for lengths whose squares would vanish.
        chance = data.counts * np.square(nearest / nearest.max())
        chosen.append(int(generator.choice(len(data.inputs), p=chance / chance.sum())))
        nearest = np.minimum(nearest, cdist(data.inputs[chosen[-1:]], data.inputs)[0])
    return data.inputs[chosen]
