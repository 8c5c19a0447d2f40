"""A smooth map with a smooth inverse, made of Gaussian-weighted translations.

Each translation ``x -> x + exp(-||x - c||^2 / (2 sigma^2)) v`` drags the surroundings of a center
along. A Gaussian is nowhere steeper than ``1 / (sigma sqrt(e))``, so the length

    steepness = ||v|| / (sigma sqrt(e))

bounds how fast the shift changes. Below 1 the translation is a contraction added to the identity,
hence one-to-one, onto, and smooth both ways; a chain of such is too. Above 1 it folds space. The
form is that of Perrin and Schlehuber-Caissier, "Fast diffeomorphic matching to learn globally
asymptotically stable nonlinear dynamical systems", Systems & Control Letters 96 (2016), whose
``rho`` is ``1 / (sigma sqrt(2))``.
"""

import math
from dataclasses import dataclass

import numpy as np

from studio.rbf.basis import FloatArray

STEEPEST = 1.0 / math.sqrt(math.e)  # slope of exp(-r^2 / 2) at r = 1, where it is largest
LARGEST_SHARE = 4.0  # [ulp] of the inverse: the scalar root it needs is known that well
NEWTON_ROUNDS = 80  # quadratic near the root, and halving while far: 53 halvings already suffice


@dataclass(frozen=True, eq=False)
class Diffeomorphism:
    """A chain of Gaussian-weighted translations, first to last.

    Raises
    ------
    ValueError
        Where the shapes do not fit, a number is not finite, a width is not positive, or the
        steepness of a translation is not below 1, so that the chain need not have an inverse.

    Examples
    --------
    >>> chain = Diffeomorphism(np.array([[0.0]]), np.array([[0.5]]), np.array([1.0]))
    >>> chain.forward(np.array([[0.0]]))
    array([[0.5]])
    >>> chain.inverse(np.array([[0.5]]))
    array([[0.]])

    """

    centers: FloatArray  # (m, d), where each translation acts, in the space it meets
    shifts: FloatArray  # (m, d), how far each moves its center
    widths: FloatArray  # (m,), the sigma of each Gaussian

    def __post_init__(self) -> None:
        shape = np.shape(self.centers)
        if len(shape) != 2 or np.shape(self.shifts) != shape or np.shape(self.widths) != shape[:1]:
            raise ValueError(
                f"centers and shifts have shape (m, d) and widths (m,), not {shape}, "
                f"{np.shape(self.shifts)} and {np.shape(self.widths)}"
            )
        if not (np.isfinite(self.centers).all() and np.isfinite(self.shifts).all()):
            raise ValueError("centers and shifts must be finite")
        if not (np.isfinite(self.widths).all() and (self.widths > 0.0).all()):
            raise ValueError("widths must be finite and positive")
        too_steep = np.flatnonzero(~(self.steepness < 1.0))
        if len(too_steep):
            worst = int(too_steep[np.argmax(self.steepness[too_steep])])
            raise ValueError(
                f"translation {worst} has steepness {self.steepness[worst]:.3g}, but only below 1 "
                f"it is sure to have an inverse: widen its Gaussian or shorten its shift"
            )

    @property
    def steepness(self) -> FloatArray:
        """How fast each translation's shift can change from place to place (m,), below 1."""
        with np.errstate(over="ignore"):
            lengths: FloatArray = np.linalg.norm(self.shifts, axis=1) / self.widths * STEEPEST
        return lengths

    def forward(self, points: FloatArray) -> FloatArray:
        """Return where points (n, d) go: (n, d)."""
        moved = points
        for center, shift, width in zip(self.centers, self.shifts, self.widths, strict=True):
            moved = moved + _shares((moved - center) / width)[:, np.newaxis] * shift
        return moved

    def push_forward(
        self, points: FloatArray, vectors: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return where points (n, d) go, and the Jacobian there times a vector each: twice (n, d).

        A path through a point with that velocity becomes a path with the returned one.
        """
        moved, pushed = points, vectors
        for center, shift, width in zip(self.centers, self.shifts, self.widths, strict=True):
            relative = (moved - center) / width
            shares = _shares(relative)
            # shares first: far away they are 0, and the rest would be 0 times infinity
            changes = -np.einsum("nd,nd->n", shares[:, np.newaxis] * relative, pushed) / width
            moved = moved + shares[:, np.newaxis] * shift
            pushed = pushed + changes[:, np.newaxis] * shift
        return moved, pushed

    def inverse(self, points: FloatArray) -> FloatArray:
        """Return what `forward` takes to these points (n, d): (n, d)."""
        origin = points
        links = zip(self.centers[::-1], self.shifts[::-1], self.widths[::-1], strict=True)
        for center, shift, width in links:
            shares = _shares_before((origin - center) / width, shift / width)
            origin = origin - shares[:, np.newaxis] * shift
        return origin


def _shares(relative: FloatArray) -> FloatArray:
    """Return the Gaussians (n,) of what lies (n, d) widths from a center."""
    shares: FloatArray = np.exp(-0.5 * np.einsum("nd,nd->n", relative, relative))
    return shares


def _shares_before(moved: FloatArray, shift: FloatArray) -> FloatArray:
    """Return the share t (n,) of a shift (d,) that brought points to ``moved`` (n, d), in widths.

    The point came from ``moved - t shift``, where the Gaussian is t: the root of
    ``t - exp(-||moved - t shift||^2 / 2)``. That rises with slope ``1 - steepness`` at least, so
    there is exactly one, and it lies between 0 and 1. Newton's method, halving where it leaves
    the bracket.
    """
    constant = np.einsum("nd,nd->n", moved, moved)
    along, square = moved @ shift, float(shift @ shift)
    share: FloatArray = np.exp(-0.5 * constant)
    low, high = np.zeros_like(share), np.ones_like(share)
    for _ in range(NEWTON_ROUNDS):
        gaussian = np.exp(-0.5 * np.maximum(constant - (2.0 * along - share * square) * share, 0.0))
        excess = share - gaussian
        slope = 1.0 - gaussian * (along - share * square)
        low, high = np.where(excess < 0.0, share, low), np.where(excess > 0.0, share, high)
        step = share - excess / slope
        better = np.where((step < low) | (step > high), 0.5 * (low + high), step)
        change = np.abs(better - share)
        share = better
        if (change <= LARGEST_SHARE * np.finfo(np.float64).eps * share).all():
            break
    return share
