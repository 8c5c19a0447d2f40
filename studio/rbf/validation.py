"""What a learner accepts, refused in words where it does not."""

import math
from collections.abc import Sequence
from numbers import Integral, Real

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import issparse

from studio.rbf.basis import FloatArray


def as_inputs(X: ArrayLike) -> FloatArray:
    """Return inputs (n,) or (n, d) as (n, d).

    Raises
    ------
    ValueError
        Where they are empty, sparse, complex, not finite, or have another number of axes.

    """
    values = finite_array(X, "X")
    if values.ndim == 1:
        values = values[:, np.newaxis]
    if values.ndim != 2:
        raise ValueError(f"X has shape (n,) or (n, d), not {values.shape}")
    if values.shape[1] == 0:
        raise ValueError(
            f"found 0 feature(s) (shape={values.shape}) while a minimum of 1 is required."
        )
    if values.shape[0] == 0:
        raise ValueError(f"found 0 samples (shape={values.shape}), at least one is needed")
    return values


def as_inputs_like(X: ArrayLike, features: int, owner: object) -> FloatArray:
    """Return inputs as (n, features), for a learner that was taught that many.

    Raises
    ------
    ValueError
        As `as_inputs`, or where the number of features is another one.

    """
    if features != 1 and not issparse(X) and np.asarray(X).ndim == 1:
        raise ValueError(
            f"X has one axis, but {type(owner).__name__} was taught {features} features. "
            f"Reshape your data: X.reshape(1, -1) where it is a single sample."
        )
    values = as_inputs(X)
    if values.shape[1] != features:
        raise ValueError(
            f"X has {values.shape[1]} features, but {type(owner).__name__} "
            f"is expecting {features} features as input."
        )
    return values


def as_targets(y: ArrayLike | None, rows: int) -> FloatArray:
    """Return targets (n,) or (n, k) in float64, their shape kept.

    Raises
    ------
    ValueError
        Where they are missing, not finite, of another number of axes, or not one row an input.

    """
    if y is None:
        raise ValueError("a regressor requires y to be passed, but the target y is None")
    values = finite_array(y, "y")
    if values.ndim not in (1, 2) or 0 in values.shape[1:]:
        raise ValueError(f"y has shape (n,) or (n, k), not {values.shape}")
    if len(values) != rows:
        raise ValueError(f"X has {rows} samples, but y has {len(values)}")
    return values


def as_taught(values: FloatArray, targets: FloatArray) -> FloatArray | float:
    """Return values (k,), one an output, as they are, or as a number where y had one axis."""
    return values if targets.ndim == 2 else float(values[0])


def demonstration_arrays(demonstrations: ArrayLike | Sequence[ArrayLike]) -> list[FloatArray]:
    """Return demonstrations (K, T, D), or K of them (T_k, D), as a list of K arrays.

    Raises
    ------
    ValueError
        Where they are none, not finite, or not of one number of columns.

    """
    arrays = [finite_array(array, "a demonstration") for array in demonstrations]  # type: ignore[union-attr]
    if not arrays or any(array.ndim != 2 or 0 in array.shape for array in arrays):
        raise ValueError("demonstrations have shape (K, T, D), none of these zero")
    if len({array.shape[1] for array in arrays}) > 1:
        raise ValueError("all demonstrations have the same number of columns")
    return arrays


def stamp_arrays(
    stamps: ArrayLike | Sequence[ArrayLike] | None, arrays: list[FloatArray]
) -> list[FloatArray]:
    """Return the stamps (T_k,) of each demonstration: given for all, for each, or 1 to T_k.

    Raises
    ------
    ValueError
        Where they are not finite, or not one a row.

    """
    lengths = [len(array) for array in arrays]
    if stamps is None:
        return [np.arange(1.0, length + 1.0) for length in lengths]
    given: list[ArrayLike] = list(stamps)  # type: ignore[arg-type]
    if given and np.ndim(given[0]) == 0:
        given = [np.array(given)] * len(arrays)
    times = [finite_array(each, "stamps") for each in given]
    if [each.shape for each in times] != [(length,) for length in lengths]:
        raise ValueError(
            "stamps are one a row of the demonstrations, given once for all or for each of them"
        )
    return times


def finite_array(values: ArrayLike, name: str) -> FloatArray:
    """Return a float64 array; raise ValueError in words, with the place of the first fault."""
    if issparse(values):
        raise ValueError(f"{name} is sparse, which is not supported: pass {name}.toarray()")
    array = np.asarray(values)
    if np.iscomplexobj(array):
        raise ValueError(f"Complex data not supported, but {name} is of {array.dtype}")
    array = array.astype(np.float64)
    if not np.isfinite(array).all():
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise ValueError(f"{name} must be finite, but {name}[{place}] is NaN or inf")
    return array


def whole_number(value: object, name: str) -> int:
    """Return a whole number from 1 up; raise TypeError or ValueError in words."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise TypeError(f"{name} is a whole number, not {value!r}")
    if value < 1:
        raise ValueError(f"{name} is at least 1, not {value!r}")
    return int(value)


def number_above(value: object, name: str, lowest: float, *, inclusive: bool) -> float:
    """Return a finite number above (or at) the lowest; raise TypeError or ValueError in words."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{name} is a number, not {value!r}")
    number = float(value)
    if not math.isfinite(number) or number < lowest or (number == lowest and not inclusive):
        bound = "at least" if inclusive else "above"
        raise ValueError(f"{name} is a finite number {bound} {lowest:g}, not {value!r}")
    return number


def one_of(value: str, name: str, choices: Sequence[str], otherwise: str = "") -> str:
    """Return the value if it is among the choices; raise ValueError that lists them."""
    if value not in choices:
        listed = ", ".join(repr(choice) for choice in choices)
        raise ValueError(f"{name} is one of {listed}{otherwise}; not {value!r}")
    return value
