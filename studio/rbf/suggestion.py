"""How many neurons are enough: the smallest network that nothing larger beats by much."""

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from studio.rbf.basis import FloatArray
from studio.rbf.crossvalidation import leave_one_demonstration_out
from studio.rbf.regressor import RBFRegressor
from studio.rbf.score import pooled_variance_floor
from studio.rbf.validation import (
    demonstration_arrays,
    finite_array,
    number_above,
    stamp_arrays,
    whole_number,
)

COUNTS = (5, 10, 15, 20, 30, 50, 75, 100, 142)  # up to the samples of the paper's demonstrations


@dataclass(frozen=True, eq=False)
class Suggestion:
    """A number of neurons, and why.

    Examples
    --------
    >>> print(suggest_from((5, 10, 20), [1.20, 1.009, 1.001], [0.050, 0.0402, 0.0400]).words)
    10 neurons: the smallest of the 3 counts tried with training error within 1 % of the floor \
(1.009 times it) and a mean square held-out error within 1 % of the best (0.0402; the best is \
0.04, at 20).

    """

    neurons: int
    counts: tuple[int, ...]  # those that were tried, rising
    floor_ratios: FloatArray | None  # (c,), training error over the floor; None without a floor
    held_out: FloatArray  # (c,), mean square error by leave-one-demonstration-out
    reached: bool  # whether any count is within both tolerances
    words: str


def suggest_neurons(
    demonstrations: ArrayLike | Sequence[ArrayLike],
    stamps: ArrayLike | None = None,
    counts: Sequence[int] = COUNTS,
    tolerance: float = 0.01,
    estimator: Any = None,
) -> Suggestion:
    """Fit a learner with every count of neurons, and return the smallest that is enough.

    Parameters
    ----------
    demonstrations : (K, T, D), or K arrays (T_k, D); two or more
    stamps : (T,) shared by all, or K arrays (T_k,); 1 to T_k where they are not given
    counts : of neurons, to try
    tolerance : by which share the error may exceed the floor, and the best held-out error
    estimator : a learner with the setting `n_neurons` or `max_neurons`; RBFRegressor() by default

    Raises
    ------
    ValueError, TypeError
        Where the counts, the tolerance or the demonstrations cannot be used.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.linspace(0.0, 1.0, 60)
    >>> generator = np.random.default_rng(0)
    >>> taught = np.sin(7.0 * t)[:, np.newaxis] + 0.1 * generator.normal(size=(4, 60, 1))
    >>> suggest_neurons(taught, t, counts=(1, 4, 8, 16), tolerance=0.05).neurons
    8

    """
    arrays = demonstration_arrays(demonstrations)
    times = stamp_arrays(stamps, arrays)
    tried = sorted({whole_number(count, "a count of neurons") for count in counts})
    learner = deepcopy(RBFRegressor() if estimator is None else estimator)
    setting = "n_neurons" if "n_neurons" in learner.get_params() else "max_neurons"
    shared = all(np.array_equal(times[0], each) for each in times)
    floor = pooled_variance_floor(arrays).value if shared else None
    inputs, rows = np.concatenate(times)[:, np.newaxis], np.vstack(arrays)
    errors, held_out = [], []
    for count in tried:
        learner.set_params(**{setting: count})
        held_out.append(float(leave_one_demonstration_out(learner, arrays, times).mse.mean()))
        answer = np.reshape(learner.fit(inputs, rows).predict(inputs), rows.shape)
        errors.append(float(np.square(rows - answer).mean()))
    ratios = None if floor is None or not floor.any() else np.array(errors) / floor.mean()
    return suggest_from(tried, ratios, held_out, tolerance)


def suggest_from(
    counts: Sequence[int],
    floor_ratios: ArrayLike | None,
    held_out: ArrayLike,
    tolerance: float = 0.01,
) -> Suggestion:
    """Return the smallest count that is enough, from errors already measured.

    Parameters
    ----------
    counts : (c,), rising
    floor_ratios : (c,), training error over the floor, or None where there is no floor
    held_out : (c,), mean square errors by leave-one-demonstration-out
    tolerance : as of `suggest_neurons`

    Raises
    ------
    ValueError, TypeError
        Where there is no count, an error is missing, negative or not finite, or the tolerance is
        no number from 0 up.

    Examples
    --------
    >>> suggest_from((5, 10, 20), None, [0.05, 0.041, 0.04], tolerance=0.05).neurons
    10

    """
    share = number_above(tolerance, "tolerance", 0.0, inclusive=True)
    errors = _errors(held_out, "held_out", len(counts))
    ratios = None if floor_ratios is None else _errors(floor_ratios, "floor_ratios", len(counts))
    near_best = errors <= (1.0 + share) * errors.min()
    enough = near_best if ratios is None else near_best & (ratios <= 1.0 + share)
    reached = bool(enough.any())
    place = int(np.argmax(enough if reached else near_best))
    words = _words(counts, place, ratios, errors, share, reached)
    return Suggestion(int(counts[place]), tuple(counts), ratios, errors, reached, words)


def _errors(values: ArrayLike, name: str, count: int) -> FloatArray:
    errors = finite_array(values, name)
    if count == 0 or errors.shape != (count,):
        raise ValueError(f"there must be at least one count of neurons, and {name} for each")
    if (errors < 0.0).any():
        raise ValueError(f"{name} are errors or their ratios, and never negative")
    return errors


def _words(
    counts: Sequence[int],
    place: int,
    ratios: FloatArray | None,
    errors: FloatArray,
    share: float,
    reached: bool,
) -> str:
    best = int(np.argmin(errors))
    near = (
        f"a mean square held-out error within {100.0 * share:g} % of the best ({errors[place]:.3g}"
    )
    near += ")" if place == best else f"; the best is {errors[best]:.3g}, at {counts[best]})"
    tried = (
        f"the smallest of the {len(counts)} counts tried"
        if len(counts) > 1
        else "the only one tried"
    )
    start = f"{counts[place]} neurons: {tried} with "
    if ratios is None:
        return f"{start}{near}. There is no floor to compare with."
    own = f"({ratios[place]:.4g} times it)"
    if reached:
        return f"{start}training error within {100.0 * share:g} % of the floor {own} and {near}."
    return f"{start}{near}. None that is comes within {100.0 * share:g} % of the floor {own}."
