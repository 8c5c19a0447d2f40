"""How good a fit is, and how good any fit could be."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from studio.rbf.basis import FloatArray
from studio.rbf.validation import demonstration_arrays, finite_array


@dataclass(frozen=True, eq=False)
class Floor:
    """The error that no function of time can undercut, or why there is none.

    Examples
    --------
    >>> pooled_variance_floor([[[1.0], [2.0]]]).reason
    'a single demonstration has no variance between demonstrations'

    """

    value: FloatArray | None  # (D,)
    reason: str = ""  # in words, where the value is None


def pooled_variance_floor(
    demonstrations: ArrayLike | Sequence[ArrayLike], stamps: ArrayLike | None = None
) -> Floor:
    """Return the pooled variance (D,) within each stamp of demonstrations (K, T, D).

    Where K demonstrations share their stamps, the mean square error of any function of time over
    all of them is exactly this floor plus its error on their mean curve.

    Parameters
    ----------
    demonstrations : (K, T, D), or K arrays (T_k, D)
    stamps : (T,) shared by all, or (K, T); taken as shared where they are not given

    Returns
    -------
    Floor, whose value is None, with a reason, for a single demonstration and where stamps differ

    Raises
    ------
    ValueError
        Where the demonstrations are none, not finite, or not of one number of columns.

    Examples
    --------
    >>> taught = [[[1.0], [2.0]], [[3.0], [2.0]]]  # K = 2, T = 2, D = 1
    >>> pooled_variance_floor(taught).value
    array([0.5])

    """
    arrays = demonstration_arrays(demonstrations)
    if len(arrays) == 1:
        return Floor(None, "a single demonstration has no variance between demonstrations")
    if len({len(array) for array in arrays}) > 1 or not _shared(stamps, arrays):
        return Floor(None, "the demonstrations do not share their stamps")
    stacked = np.stack(arrays)
    return Floor(_mean_square(stacked - stacked.mean(axis=0), (0, 1)))


def _shared(stamps: ArrayLike | None, arrays: list[FloatArray]) -> bool:
    if stamps is None:
        return True
    values = finite_array(stamps, "stamps")
    length = len(arrays[0])
    if values.shape not in ((length,), (len(arrays), length)):
        raise ValueError(f"stamps have shape ({length},) or ({len(arrays)}, {length})")
    return values.ndim == 1 or bool((values == values[0]).all())


def mean_squared_error(targets: ArrayLike, predictions: ArrayLike) -> FloatArray:
    """Return the mean square of the errors (n, k), for each output: (k,). What Table I prints.

    Raises ValueError where the shapes differ or a number is not finite.

    Examples
    --------
    >>> mean_squared_error([[0.0, 1.0], [2.0, 1.0]], [[0.0, 0.0], [0.0, 0.0]])
    array([2., 1.])

    """
    return _mean_square(_errors(targets, predictions), 0)


def largest_error(targets: ArrayLike, predictions: ArrayLike) -> FloatArray:
    """Return the largest absolute error of (n, k), for each output: (k,).

    This is the epsilon* of Eq. 12, over the samples that are given. Raises as
    `mean_squared_error`.

    Examples
    --------
    >>> largest_error([[0.0, 1.0], [2.0, 1.0]], [[0.0, 0.0], [0.0, 0.0]])
    array([2., 1.])

    """
    return np.asarray(np.abs(_errors(targets, predictions)).max(axis=0))


def r_squared(targets: ArrayLike, predictions: ArrayLike) -> float:
    """Return the coefficient of determination, the mean over outputs.

    An output that never changes counts 1 where it is met exactly and 0 otherwise, as scikit-learn
    has it. Raises as `mean_squared_error`.

    Examples
    --------
    >>> r_squared([1.0, 2.0, 3.0], [1.0, 2.0, 4.0])
    0.5

    """
    errors = _errors(targets, predictions).reshape(len(np.asarray(targets)), -1)
    values = finite_array(targets, "targets").reshape(errors.shape)
    around = values - values.mean(axis=0)
    size = np.maximum(np.abs(around).max(axis=0), np.abs(errors).max(axis=0))
    size[size == 0.0] = 1.0  # relative to it, squares neither overflow nor vanish
    unexplained = np.square(errors / size).sum(axis=0)
    variation = np.square(around / size).sum(axis=0)
    constant = np.where(unexplained == 0.0, 1.0, 0.0)
    share = np.divide(unexplained, variation, out=1.0 - constant, where=variation > 0.0)
    return float(np.mean(1.0 - share))


def _mean_square(errors: FloatArray, axis: int | tuple[int, int]) -> FloatArray:
    with np.errstate(over="ignore"):
        found = np.asarray(np.square(errors).mean(axis=axis))
    if not np.isfinite(found).all():
        raise ValueError(f"errors of {np.abs(errors).max():.3g} have no square: use another unit")
    return found


def _errors(targets: ArrayLike, predictions: ArrayLike) -> FloatArray:
    wanted, found = finite_array(targets, "targets"), finite_array(predictions, "predictions")
    if wanted.shape != found.shape or wanted.size == 0:
        raise ValueError(f"targets {wanted.shape} and predictions {found.shape} must match")
    return found - wanted
