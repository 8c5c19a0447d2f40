"""Least squares that grows one column at a time, and knows its residual at every size."""

import math

import numpy as np
from scipy.linalg import solve_triangular

from studio.rbf.basis import FloatArray

DEPENDENT = 1e-10  # a column of which less than this share is new is left out, its weight 0
MOSTLY_NEW = 0.1  # a column of which more than this share is new has lost one digit at most


def orthogonalized(columns: FloatArray, basis: FloatArray) -> FloatArray:
    """Return the part of columns (n, c) or (n,) that an orthonormal basis (n, b) does not span.

    Projected out twice: what rounding leaves of the first time, the second removes. Where much of
    a single column stays there is nothing worth removing (Daniel, Gragg, Kaufman, Stewart 1976).
    """
    once: FloatArray = columns - basis.dot(basis.T.dot(columns))
    if columns.ndim == 1 and once.dot(once) > MOSTLY_NEW**2 * columns.dot(columns):
        return once
    twice: FloatArray = once - basis.dot(basis.T.dot(once))
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
        self._upper = np.zeros((len(targets) + 1, len(targets) + 1), order="F")  # R
        self._independent: list[bool] = []
        self.residual = targets.copy()
        self.add(root_counts)

    def add(self, column: FloatArray) -> None:
        """Add a column (n,), its rows already scaled by the root counts; O(n b)."""
        column = np.ascontiguousarray(column)
        basis = self._basis[:, : self._size]
        new = orthogonalized(column, basis)
        length = math.sqrt(new.dot(new))
        independent = length > DEPENDENT * math.sqrt(column.dot(column))
        self._independent.append(independent)
        if not independent:
            return
        new /= length
        self._upper[: self._size, self._size] = column.dot(basis)
        self._upper[self._size, self._size] = length
        self._basis[:, self._size] = new
        self._size += 1
        self.residual -= np.multiply.outer(new, new.dot(self.residual))

    def solution(self) -> tuple[FloatArray, FloatArray]:
        """Return the bias (k,) and the weights (m, k) of all columns added since."""
        basis = self._basis[:, : self._size]
        upper = self._upper[: self._size, : self._size]
        weights = np.zeros((len(self._independent), self._targets.shape[1]))
        weights[self._independent] = solve_triangular(
            upper, basis.T @ self._targets, check_finite=False
        )
        return weights[0], weights[1:]
