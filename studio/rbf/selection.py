"""Which sample becomes the next center: forward orthogonal least squares.

Chen, Cowan and Grant (1991). Every sample is a candidate with a column p of the design, its
Gaussian's answers to all samples. Once the part of p is removed that the centers chosen before
already span, the candidate's score over the outputs s is

    sum_s [ (p^T d_s)^2 / (p^T p * d_s^T d_s) ]^2

with the targets d_s as they are, not centered. The highest score wins, the first among equals.

Repeated samples give equal columns, so candidates are the distinct inputs.
"""

import math
from collections.abc import Iterator

import numpy as np

from studio.rbf.basis import FloatArray
from studio.rbf.leastsquares import orthogonalized

DEPENDENT = 1e-10  # a column of which less than this share is new adds nothing but rounding
STALE = 1e-6  # of a squared length: how far it may be downdated before it is measured anew


def independent_picks(
    design: FloatArray, targets: FloatArray, energies: FloatArray
) -> Iterator[int]:
    """Yield candidates best first, until none is left that the chosen ones do not span.

    Instead of the deflated columns themselves it keeps an orthonormal basis of the chosen ones,
    and downdates every candidate's ``p^T p`` and ``p^T d`` by it: O(n^2) a pick.

    Parameters
    ----------
    design : (n, n), a column for each candidate; rows are the distinct inputs, scaled by the
        square roots of their counts, which leaves all products what they are over the samples
    targets : (n, k), the means, scaled alike
    energies : (k,), ``d_s^T d_s`` over all samples

    """
    design = np.asfortranarray(design)  # its columns are what is read
    squared = np.square(design).sum(axis=0)
    least, stale_below = DEPENDENT**2 * squared, STALE * squared
    roots = np.sqrt(energies)
    units = np.divide(targets, roots, out=np.zeros_like(targets), where=roots > 0.0)
    products = units.T @ design  # (k, n); a score is sum_s product^4 / squared^2
    basis = np.empty(design.shape, order="F")  # its first columns are the basis so far
    free = np.ones(design.shape[1], dtype=bool)
    for size in range(design.shape[1]):
        chosen = basis[:, :size]
        stale = free & (squared < stale_below)
        if np.count_nonzero(stale):  # downdating has cost these too many digits
            remainder = orthogonalized(design[:, stale], chosen)
            squared[stale] = np.square(remainder).sum(axis=0)
            stale_below[stale] = STALE * squared[stale]
            products[:, stale] = units.T @ remainder
        free &= squared > least
        if not np.count_nonzero(free):
            return
        shares = products * products
        score = np.full(len(free), -1.0)
        quartics = np.add.reduce(shares * shares, axis=0)
        np.divide(quartics, squared * squared, out=score, where=free)
        pick = int(score.argmax())
        free[pick] = False
        column = orthogonalized(design[:, pick], chosen)
        column /= math.sqrt(column.dot(column))
        basis[:, size] = column
        yield pick
        along = column.dot(design)
        squared -= along * along
        products -= np.multiply.outer(column.dot(units), along)


def deflated_picks(
    design: FloatArray, targets: FloatArray, energies: FloatArray, copies: FloatArray
) -> Iterator[int]:
    """Yield candidates best first as MATLAB's newrb does, repeated samples and all.

    There the picked sample leaves, but its repeats stay. Their columns, which the pick spans, are
    deflated to rounding noise, and since the score divides by the column's own length that noise
    competes in earnest. So a candidate stays here as often as its sample repeats.

    Parameters
    ----------
    design : (q, n), a column for each distinct candidate and a row for each sample
    targets : (q, k)
    energies : (k,)
    copies : (n,), how many samples share each candidate

    """
    deflated, left = design.copy(), copies.copy()
    while left.any():
        squared = np.square(deflated).sum(axis=0)
        score = scores(squared, deflated.T @ targets, energies)
        pick = int(np.argmax(np.where(left > 0, score, -1.0)))
        left[pick] -= 1
        yield pick
        if squared[pick] > np.finfo(np.float64).tiny:
            column = deflated[:, pick].copy()
            deflated -= np.outer(column, column @ deflated / squared[pick])


def scores(squared: FloatArray, products: FloatArray, energies: FloatArray) -> FloatArray:
    """Return each candidate's score (n,) from ``p^T p`` (n,), ``p^T d`` (n, k) and ``d^T d`` (k,).

    An output that is zero throughout, and a column that nothing is left of, add no score.
    """
    possible = np.outer(squared, energies)
    share = np.divide(
        np.square(products), possible, out=np.zeros_like(products), where=possible > 0.0
    )
    total: FloatArray = np.square(share).sum(axis=1)
    return total
