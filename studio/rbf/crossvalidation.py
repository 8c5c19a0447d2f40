"""Held-out error: leaving out one demonstration at a time, never single frames.

Demonstrations share their stamps, so a left-out frame's neighbors in time, and its twins in the
other demonstrations' rows, would tell the learner what it is asked: only whole demonstrations are
unseen.
"""

from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from studio.rbf.basis import FloatArray
from studio.rbf.validation import demonstration_arrays, stamp_arrays, whole_number

Rows = NDArray[np.intp]


@dataclass(frozen=True)
class LeaveOneDemonstrationOut:
    """Splits stacked demonstrations for scikit-learn's tools: pass it as ``cv``.

    Parameters
    ----------
    lengths : how many rows each of the K demonstrations has, in the order in which they are stacked

    Examples
    --------
    >>> for train, test in LeaveOneDemonstrationOut([2, 3]).split(range(5)):
    ...     print(train, test)
    [2 3 4] [0 1]
    [0 1] [2 3 4]

    """

    lengths: Sequence[int]

    def split(
        self,
        X: Any,
        y: Any = None,  # noqa: ARG002 scikit-learn's names, here and below
        groups: Any = None,  # noqa: ARG002
    ) -> Iterator[tuple[Rows, Rows]]:
        """Yield the rows to train on and the rows left out, a demonstration at a time.

        Raises
        ------
        ValueError
            Where X has another number of rows, or there is nothing to leave out.
        TypeError
            Where a length is no whole number.

        """
        lengths = [whole_number(length, "a demonstration's length") for length in self.lengths]
        if len(lengths) < 2:
            raise ValueError("to leave one demonstration out there must be two or more")
        if len(X) != sum(lengths):
            raise ValueError(f"X has {len(X)} rows, but the demonstrations {sum(lengths)}")
        owner = np.repeat(np.arange(len(lengths)), lengths)
        for left_out in range(len(lengths)):
            yield np.flatnonzero(owner != left_out), np.flatnonzero(owner == left_out)

    def get_n_splits(
        self,
        X: Any = None,  # noqa: ARG002
        y: Any = None,  # noqa: ARG002
        groups: Any = None,  # noqa: ARG002
    ) -> int:
        """Return K."""
        return len(self.lengths)


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Errors on demonstrations that the learner did not see.

    Examples
    --------
    >>> import numpy as np
    >>> HeldOut(np.array([[2.0], [4.0]]), np.array([[2.0], [4.0]])).ratio
    1.0

    """

    mse: FloatArray  # (K, D), on each demonstration of what learned from the others
    of_means: FloatArray | None  # (K, D), of the others' mean curve; None where stamps differ

    @property
    def ratio(self) -> float | None:
        """Mean square error over that of the others' mean curve, all demonstrations and outputs.

        About 1 is all that can be had, for what is left is how demonstrations differ; below 1 the
        learner smoothed away noise of the mean curve. None where stamps differ, or nothing does.
        """
        if self.of_means is None or not self.of_means.any():
            return None
        return float(self.mse.sum() / self.of_means.sum())


def leave_one_demonstration_out(
    estimator: Any,
    demonstrations: ArrayLike | Sequence[ArrayLike],
    stamps: ArrayLike | Sequence[ArrayLike] | None = None,
) -> HeldOut:
    """Teach a copy of a learner on all demonstrations but one, for each, and ask it for that one.

    Parameters
    ----------
    estimator : a learner of scikit-learn's contract; it is left as it is
    demonstrations : (K, T, D), or K arrays (T_k, D)
    stamps : (T,) shared by all, or K arrays (T_k,); 1 to T_k where they are not given

    Raises
    ------
    ValueError
        Where there are fewer than two demonstrations, or they cannot be used.

    Examples
    --------
    >>> import numpy as np
    >>> from studio.rbf import RBFRegressor
    >>> t = np.linspace(0.0, 3.0, 40)
    >>> taught = np.array([[np.sin(t) + shift] for shift in (-0.1, 0.0, 0.1)]).transpose(0, 2, 1)
    >>> held_out = leave_one_demonstration_out(RBFRegressor(10), taught, t)
    >>> held_out.mse.round(4).tolist()  # 0.15, 0, 0.15 squared
    [[0.0225], [0.0], [0.0225]]
    >>> round(held_out.ratio, 3)
    1.0

    """
    arrays = demonstration_arrays(demonstrations)
    times = stamp_arrays(stamps, arrays)
    inputs, rows = np.concatenate(times)[:, np.newaxis], np.vstack(arrays)
    splitter = LeaveOneDemonstrationOut([len(array) for array in arrays])
    shared = all(np.array_equal(times[0], each) for each in times)
    errors, of_means = [], []
    for left_out, (train, test) in enumerate(splitter.split(inputs)):
        learner = deepcopy(estimator).fit(inputs[train], rows[train])
        found = np.reshape(learner.predict(inputs[test]), (len(test), -1))
        errors.append(np.square(rows[test] - found).mean(axis=0))
        if shared:
            others = np.mean([a for k, a in enumerate(arrays) if k != left_out], axis=0)
            of_means.append(np.square(rows[test] - others).mean(axis=0))
    return HeldOut(np.array(errors), np.array(of_means) if shared else None)
