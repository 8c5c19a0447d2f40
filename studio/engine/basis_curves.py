"""What each Gaussian of a network adds to a joint, and what they come to together: Eq. 6, 7."""

from dataclasses import dataclass

import numpy as np

from studio.engine.skeleton import FloatArray
from studio.engine.teaching import INDEX_TIME, Lesson
from studio.rbf import NewrbRegressor, RBFRegressor
from studio.rbf.basis import gaussian_design

MOST_DRAWN = 40  # Gaussians; more are a tangle
_REACH = 3.5  # widths, beyond which a Gaussian is as good as zero
_ACROSS = 25  # points on each


@dataclass(frozen=True, eq=False)
class Basis:
    """The parts of one joint's curve."""

    neurons: int  # of the network
    parts: tuple[tuple[FloatArray, FloatArray], ...]  # of each Gaussian its stamps and angles [deg]
    stamps: FloatArray  # (n,), in samples from 1 to 142
    total: FloatArray  # (n,) [deg], the sum of all Gaussians, drawn or not
    bias: float  # [deg], which the network adds to it


def basis_of(lesson: Lesson, column: int) -> Basis | None:
    """Return the parts of a joint's curve; None for a learner that is no network over time.

    Of many Gaussians those with the largest weights are there, by their places in time.
    """
    model = lesson.model
    if not isinstance(model, RBFRegressor | NewrbRegressor):
        return None
    weights = np.degrees(model.weights_[:, column])
    centers, width = model.centers_[:, 0], model.width_
    largest = np.sort(np.argsort(-np.abs(weights), kind="stable")[:MOST_DRAWN])
    stamps = np.linspace(INDEX_TIME[0], INDEX_TIME[-1], 2 * len(INDEX_TIME) - 1)
    design = gaussian_design(stamps[:, np.newaxis], model.centers_, width)
    return Basis(
        neurons=len(weights),
        parts=tuple(_part(centers[j], width, weights[j]) for j in largest),
        stamps=stamps,
        total=design @ weights,
        bias=float(np.degrees(np.ravel(model.bias_)[column])),
    )


def _part(center: float, width: float, weight: float) -> tuple[FloatArray, FloatArray]:
    low, high = center - _REACH * width, center + _REACH * width
    stamps = np.linspace(max(low, INDEX_TIME[0]), min(high, INDEX_TIME[-1]), _ACROSS)
    return stamps, weight * np.exp(-0.5 * ((stamps - center) / width) ** 2)
