"""Least squares that grows one column at a time, and knows its residual at every size."""

import numpy as np
from scipy.linalg import solve_triangular

from studio.rbf.basis import FloatArray

DEPENDENT = 1e-10  # a column of which less than this share is new is left out, its weight 0


def orthogonalized(columns: FloatArray, basis: FloatArray) -> FloatArray:
    """Return the part of columns (n, c) that an orthonormal basis (n, b) does not span.

    Projected out twice: what rounding leaves of the first time, the second removes.
    """
    once = columns - basis @ (basis.T @ columns)
    twice: FloatArray = once - basis @ (basis.T @ once)
    return twice


class GrowingLeastSquares:
    """Weighted least squares with a bias: ``root_counts * (bias + columns @ weights) ~ targets``.

    A QR decomposition by Gram-Schmidt, orthogonalized twice. ``residual`` (n, k) is that of the
    best weights for the columns added so far.
    """

    def __init__(self, root_counts: FloatArray, targets: FloatArray) -> None:
        self._targets = targets
        self._basis = np.empty((len(targets), 0))
        self._triangle: list[FloatArray] = []  # column j of R, (j + 1,)
        self._independent: list[bool] = []
        self.residual = targets.copy()
        self.add(root_counts)

    def add(self, column: FloatArray) -> None:
        """Add a column (n,), its rows already scaled by the root counts; O(n b)."""
        new = orthogonalized(column[:, np.newaxis], self._basis)
        length = float(np.linalg.norm(new))
        independent = length > DEPENDENT * float(np.linalg.norm(column))
        self._independent.append(independent)
        if not independent:
            return
        new /= length
        self._triangle.append(np.append(self._basis.T @ column, length))
        self._basis = np.hstack([self._basis, new])
        self.residual -= new @ (new.T @ self.residual)

    def solution(self) -> tuple[FloatArray, FloatArray]:
        """Return the bias (k,) and the weights (m, k) of all columns added since."""
        size = len(self._triangle)
        upper = np.zeros((size, size))
        for place, column in enumerate(self._triangle):
            upper[: place + 1, place] = column
        weights = np.zeros((len(self._independent), self._targets.shape[1]))
        weights[self._independent] = solve_triangular(upper, self._basis.T @ self._targets)
        return weights[0], weights[1:]
