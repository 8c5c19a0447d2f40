"""Samples made ready for a fit: scaled without rounding, repeated inputs drawn together.

K demonstrations that share their stamps give K targets to each input. The least squares fit of
all of them is exactly the fit of their means, each weighted by its count: the squares about the
means do not depend on the network, and are the floor under its error.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from studio.rbf.basis import FloatArray

IndexArray = NDArray[np.intp]
LARGEST = 1e290  # weights can be larger than the targets by as much as 1e10, and more by their sum


@dataclass(frozen=True, eq=False)
class DistinctInputs:
    """The n distinct inputs among q samples, sorted, and what was taught at each.

    Inputs and targets are divided by powers of two, so that their squares stay within float64
    whatever the caller's units are, and not a digit is lost.
    """

    inputs: FloatArray  # (n, d), in `input_unit`
    counts: FloatArray  # (n,), how many samples share the input
    means: FloatArray  # (n, k), their mean target, in `target_units`
    within: FloatArray  # (k,), mean square of the samples about these means
    mean_square: FloatArray  # (k,), mean square of the samples
    first: IndexArray  # (n,), the first sample that has the input
    group: IndexArray  # (q,), which distinct input a sample has
    input_unit: float
    target_units: FloatArray  # (k,)

    @property
    def root_counts(self) -> FloatArray:
        """Square roots of the counts (n,): what a row is scaled by in weighted least squares."""
        return np.sqrt(self.counts)

    @property
    def floor(self) -> FloatArray | None:
        """Mean square (k,), in the caller's units, that no function of the input can undercut.

        None where no input repeats: then nothing tells the noise from the curve.
        """
        if self.counts.max() <= 1.0:
            return None
        return self.within * np.square(self.target_units)

    def by_first_appearance(self) -> "DistinctInputs":
        """Return the same with the inputs as they first appear among the samples."""
        order = np.argsort(self.first)
        place = np.argsort(order)  # where each input goes
        return replace(
            self,
            group=place[self.group],
            inputs=self.inputs[order],
            counts=self.counts[order],
            means=self.means[order],
            first=self.first[order],
        )


def distinct_inputs(inputs: FloatArray, targets: FloatArray) -> DistinctInputs:
    """Scale samples (q, d) with targets (q, k), and draw repeated inputs together.

    Raises
    ------
    ValueError
        Where they spread so far that float64 could not hold the weights.

    """
    with np.errstate(over="ignore"):
        input_unit = float(_power_of_two(np.ptp(inputs, axis=0).max()))
        target_units = _power_of_two(np.ptp(targets, axis=0) + np.abs(targets).max(axis=0))
    inputs, targets = inputs / input_unit, targets / target_units
    # In one dimension the plain np.unique is many times faster than its axis form.
    keys, axis = (inputs[:, 0], None) if inputs.shape[1] == 1 else (inputs, 0)
    _, first, inverse, counts = np.unique(
        keys, axis=axis, return_index=True, return_inverse=True, return_counts=True
    )
    group = inverse.reshape(-1)
    # Relative to one of the samples, so that targets that never change keep their exact value.
    relative = targets - targets[0]
    sums = [np.bincount(group, weights=column, minlength=len(counts)) for column in relative.T]
    means = np.stack(sums, axis=1) / counts[:, np.newaxis] + targets[0]
    return DistinctInputs(
        inputs=inputs[first],
        counts=counts.astype(np.float64),
        means=means,
        within=np.square(targets - means[group]).mean(axis=0),
        mean_square=np.square(targets).mean(axis=0),
        first=first,
        group=group,
        input_unit=input_unit,
        target_units=target_units,
    )


def _power_of_two(magnitude: FloatArray) -> FloatArray:
    """Return the power of two just above each magnitude, and 1 for zero."""
    if not np.max(magnitude) < LARGEST:
        raise ValueError(f"the samples spread over {LARGEST:g} or more: use another unit")
    _, exponent = np.frexp(magnitude)
    return np.where(magnitude > 0.0, np.ldexp(1.0, np.minimum(exponent, 1023)), 1.0)
