"""Where the Gaussians sit. The paper only says that they are "selected from the sample"."""

from itertools import islice
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.distance import cdist

from studio.rbf.aggregation import DistinctInputs, IndexArray
from studio.rbf.basis import FloatArray, extent, gaussian_design
from studio.rbf.gcv import mean_target
from studio.rbf.selection import independent_picks
from studio.rbf.validation import as_inputs, one_of

PlacingRule = Literal["grid", "kmeans", "random"]  # they ask for no targets and no width
CenterRule = Literal[PlacingRule, "ols"]
RandomState = int | np.random.Generator | None
LLOYD_ROUNDS = 100  # k-means ends long before, unless clusters swap a point forever
LATTICE_DIGITS = 9  # far above rounding, far below any spacing that matters


def place_centers(
    rule: PlacingRule | ArrayLike, data: DistinctInputs, count: int, random_state: RandomState
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
    points = _on_lattice(inputs)
    middle = np.round(points.mean(axis=0, keepdims=True), LATTICE_DIGITS)
    chosen = [int(cdist(middle, points).argmin())]
    distances = cdist(points[chosen], points)[0]
    while len(chosen) < min(count, len(points)):
        chosen.append(int(distances.argmax()))
        distances = np.minimum(distances, cdist(points[chosen[-1:]], points)[0])
    centers: FloatArray = inputs[np.resize(chosen, count)]
    return centers


def greedy_centers(data: DistinctInputs, count: int, width: float) -> FloatArray:
    """Return the inputs (m, d) that orthogonal least squares picks for Gaussians of one width.

    Forward selection of Chen, Cowan and Grant (1991), see `studio.rbf.selection`, with the targets
    about their mean, for that is what the weights have to fit. At most ``count`` of them: it ends
    where no input is left whose Gaussian the chosen ones do not span.
    """
    points = _on_lattice(data.inputs)
    relative = float(f"{width / (extent(data.inputs) or 1.0):.{LATTICE_DIGITS}g}")
    root_counts = data.root_counts[:, np.newaxis]
    design = root_counts * gaussian_design(points, points, relative)
    targets = root_counts * (data.means - mean_target(data))
    energies = data.counts.sum() * data.within + np.square(targets).sum(axis=0)
    picks = islice(independent_picks(design, targets, energies), count)
    centers: FloatArray = data.inputs[list(picks)]
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
    points = _on_lattice(data.inputs)
    start = _spread_start(points, data.counts, count, generator)
    centers, own = points[start], data.inputs[start]  # on the lattice, and where they truly are
    for _ in range(LLOYD_ROUNDS):
        nearest = cdist(points, centers).argmin(axis=1)
        moved = _cluster_means(points, data.counts, nearest, centers)
        own = _cluster_means(data.inputs, data.counts, nearest, own)
        if np.array_equal(moved, centers):
            break
        centers = moved
    return own


def _spread_start(
    points: FloatArray, counts: FloatArray, count: int, generator: np.random.Generator
) -> list[int]:
    """Draw points (n, d), each with a chance that grows as its squared distance to the others."""
    chosen = [int(generator.choice(len(points), p=counts / counts.sum()))]
    nearest = cdist(points[chosen], points, "sqeuclidean")[0]
    while len(chosen) < count:
        chance = counts * nearest if nearest.any() else counts  # all on one spot: any will do
        chosen.append(int(generator.choice(len(points), p=chance / chance.sum())))
        nearest = np.minimum(nearest, cdist(points[chosen[-1:]], points, "sqeuclidean")[0])
    return chosen


def _cluster_means(
    points: FloatArray, counts: FloatArray, nearest: IndexArray, centers: FloatArray
) -> FloatArray:
    """Return the mean of the points nearest to each center; an emptied one stays where it is."""
    weight = np.bincount(nearest, weights=counts, minlength=len(centers))
    held = weight > 0.0
    moved = centers.copy()
    for column, values in enumerate(points.T):
        sums = np.bincount(nearest, weights=counts * values, minlength=len(centers))
        moved[held, column] = sums[held] / weight[held]
    return moved


def _on_lattice(inputs: FloatArray) -> FloatArray:
    """Return inputs (n, d) relative to their extent, rounded.

    Even stamps tie all the time. Rounding makes a tie a tie in every unit, so that choices by
    distance, or by what wide Gaussians leave of one another, never depend on it.
    """
    relative = (inputs - inputs.min(axis=0)) / (extent(inputs) or 1.0)
    points: FloatArray = np.round(relative, LATTICE_DIGITS)
    return points
