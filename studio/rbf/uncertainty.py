"""How sure the network is: the noise about it, and what the samples left open about its weights.

Bayesian linear regression (Bishop 2006, Section 3.3): with noise of variance s^2 and weights drawn
beforehand with variance s^2 / ridge, the weights' posterior covariance is
``s^2 (Phi^T Phi + ridge I)^-1``. Without a ridge it is that of least squares.
"""

import numpy as np

from studio.rbf.aggregation import DistinctInputs
from studio.rbf.basis import FloatArray, gaussian_design
from studio.rbf.gcv import Choice
from studio.rbf.linear import removed_shares


def noise_of(
    data: DistinctInputs, targets: FloatArray, choice: Choice, effective_dof: float
) -> FloatArray | None:
    """Return the standard deviation (k,) of all samples about the fit, in the data's own unit.

    ``s^2 = RSS / (q - trace H)`` (Wahba 1983, who shows it for the ridge that GCV chooses). None
    where less than one of the q degrees of freedom is left: then the division means nothing.

    Parameters
    ----------
    data : DistinctInputs
    targets : (n, k), the means about the bias, scaled by the root counts
    choice : the fit
    effective_dof : trace of its hat matrix, the bias included

    """
    samples = float(data.counts.sum())
    if samples - effective_dof < 1.0:
        return None
    svd = choice.svd
    components = svd.left.T @ targets
    removed = removed_shares(svd, np.array([choice.ridge]))[0][:, np.newaxis]
    missed = targets - svd.left @ components + svd.left @ (removed * components)
    rest = samples * data.within + np.square(missed).sum(axis=0)
    noise: FloatArray = np.sqrt(rest / (samples - effective_dof))
    return noise


def covariance_root(choice: Choice, samples: int) -> FloatArray:
    """Return a root R (m + 1, r + 1) of the covariance ``R R^T`` of bias and weights, for noise 1.

    The bias is the mean of the q samples, its variance 1 / q.
    """
    svd = choice.svd
    spread = svd.right.T / np.hypot(svd.singular, np.sqrt(choice.ridge))
    root = np.zeros((spread.shape[0] + 1, spread.shape[1] + 1))
    root[0, 0] = 1.0 / np.sqrt(samples)
    root[1:, 1:] = spread
    return root


def predictive_std(
    inputs: FloatArray,
    centers: FloatArray,
    width: float,
    root: FloatArray,
    noise: FloatArray | float,
) -> FloatArray:
    """Return the standard deviation of one new sample at each input: (n,) or (n, k).

    Parameters
    ----------
    inputs : (n, d)
    centers : (m, d)
    width : positive, in the unit of the inputs
    root : (m + 1, r + 1), of `covariance_root`
    noise : a number, or (k,)

    """
    spread = gaussian_design(inputs, centers, width) @ root[1:] + root[0]
    share = np.sqrt(1.0 + np.square(spread).sum(axis=1))
    std: FloatArray = np.multiply.outer(share, noise)
    return std
