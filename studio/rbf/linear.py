"""Output weights by linear least squares: Eq. 14 done safely.

Eq. 15 inverts ``Phi^T Phi``, whose condition is the square of an already terrible one. The
pseudo-inverse of Eq. 14 comes here from a singular value decomposition cut at `rcond`, and a ridge
shrinks what is left.
"""

import math
from dataclasses import dataclass

import numpy as np

from studio.rbf.basis import FloatArray


@dataclass(frozen=True, eq=False)
class TruncatedSVD:
    """``design = left @ diag(singular) @ right``, without the directions that carry no digits."""

    left: FloatArray  # (n, r)
    singular: FloatArray  # (r,), falling
    right: FloatArray  # (r, m)
    condition: float  # of the whole design, before the cut; may be infinite

    @property
    def rank(self) -> int:
        """How many directions were kept."""
        return len(self.singular)


def truncated_svd(design: FloatArray, rcond: float) -> TruncatedSVD:
    """Decompose a design (n, m) and drop singular values below ``rcond``.

    The cut is relative to the largest one, but never below ``rcond`` itself: a Gaussian is 1 at
    its center, so a direction that weak is one that no sample is near enough to teach. What the
    decomposition's own rounding makes up is always dropped, whatever ``rcond``.
    """
    left, singular, right = np.linalg.svd(design, full_matrices=False)
    cut = max(rcond, np.finfo(np.float64).eps * max(design.shape))
    kept = singular > cut * max(singular[0], 1.0)
    smallest = float(singular[-1])
    return TruncatedSVD(
        left=left[:, kept],
        singular=singular[kept],
        right=right[kept],
        condition=float(singular[0]) / smallest if smallest > 0.0 else math.inf,
    )


def ridge_weights(svd: TruncatedSVD, targets: FloatArray, ridge: float) -> FloatArray:
    """Return the weights (m, k) that minimize ``||targets - design w||^2 + ridge ||w||^2``.

    With ridge 0 they are ``W = Phi^+ d`` of Eq. 14, the shortest of all best ones.
    """
    # s / (s^2 + ridge), written so that s^2 cannot vanish
    gains = 1.0 / (svd.singular + ridge / svd.singular)
    weights: FloatArray = svd.right.T @ (gains[:, np.newaxis] * (svd.left.T @ targets))
    return weights


def removed_shares(svd: TruncatedSVD, ridges: FloatArray) -> FloatArray:
    """Return how much of each kept direction every ridge takes away again: (l, r).

    Not one minus what it leaves: that would lose all digits of a small share.
    """
    penalties = ridges[:, np.newaxis]
    shares: FloatArray = penalties / (np.square(svd.singular) + penalties)
    return shares


def bias_shares(svd: TruncatedSVD, root_counts: FloatArray) -> FloatArray:
    """Return how much of each left direction (r,) the bias, a weighted mean, already explains."""
    unit = root_counts / np.linalg.norm(root_counts)
    shares: FloatArray = np.square(svd.left.T @ unit)
    return shares


def effective_dof(svd: TruncatedSVD, root_counts: FloatArray, ridge: float) -> float:
    """Return the trace of the matrix that takes the targets to the fit, the bias included."""
    kept = 1.0 - removed_shares(svd, np.array([ridge]))[0]
    return 1.0 + float(kept @ (1.0 - bias_shares(svd, root_counts)))
