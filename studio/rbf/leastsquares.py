"""Least squares that grows one column at a time, and knows its residual at every size."""

import math

import numpy as np
from scipy.linalg import solve_triangular

from studio.rbf.basis import FloatArray

DEPENDENT = 1e-10  # a column of which less than this share is new is left out, its weight 0
MOSTLY_NEW = 0.3  # a column of which more than this share is new has lost no digit worth a second


def orthogonalized(columns: FloatArray, basis: FloatArray) -> FloatArray:
    """Return the part of columns (n, c) or (n,) that an orthonormal basis (n, b) does not span.

    Projected out twice: what rounding leaves of the first time, the second removes. Where most of
    a single column stays there is nothing worth removing (Daniel, Gragg, Kaufman, Stewart 1976).
    """
    once = columns - basis @ (columns @ basis if columns.ndim == 1 else basis.T @ columns)
    if columns.ndim == 1 and once @ once > MOSTLY_NEW**2 * (columns @ columns):
        return once
    twice: FloatArray = once - basis @ (once @ basis if columns.ndim == 1 else basis.T @ once)
    return twice


class GrowingLeastSquares:
    """Weighted least squares with a bias: ``root_counts * (bias + columns @ weights) ~ targets``.

    A QR decomposition by Gram-Schmidt, orthogonalized twice. ``residual`` (n, k) is that of the
    best weights for the columns added so far.
    """

    def __init__(self, root_counts: FloatArray, targets: FloatArray) -> None:
        self._targets = targets
        # More than the n + 1 columns that can be independent there never are.
        self._basis = np.empty((len(targets), len(targets) + 1), order="F")
        self._size = 0
        self._kept: list[FloatArray] = []  # the columns that are independent
        self._independent: list[bool] = []
        self.residual = targets.copy()
        self.add(root_counts)

    def add(self, column: FloatArray) -> None:
        """Add a column (n,), its rows already scaled by the root counts; O(n b)."""
        column = np.ascontiguousarray(column)
        new = orthogonalized(column, self._basis[:, : self._size])
        length = math.sqrt(new @ new)
        independent = length > DEPENDENT * math.sqrt(column @ column)
        self._independent.append(independent)
        if not independent:
            return
        new /= length
        self._kept.append(column)
        self._basis[:, self._size] = new
        self._size += 1
        self.residual -= new[:, np.newaxis] * (new @ self.residual)

    def solution(self) -> tuple[FloatArray, FloatArray]:
        """Return the bias (k,) and the weights (m, k) of all columns added since."""
        basis = self._basis[:, : self._size]
        upper = basis.T @ np.column_stack(self._kept)  # R; below its diagonal is rounding only
        weights = np.zeros((len(self._independent), self._targets.shape[1]))
        weights[self._independent] = solve_triangular(
            upper, basis.T @ self._targets, check_finite=False
        )
        return weights[0], weights[1:]
