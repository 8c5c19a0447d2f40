"""Derivatives of the Gaussian network by its input, written out rather than differenced."""

import numpy as np
from numpy.polynomial.hermite_e import hermeval

from studio.rbf.basis import FloatArray, gaussian_design


def network_derivative(
    inputs: FloatArray, centers: FloatArray, width: float, weights: FloatArray, order: int
) -> FloatArray:
    """Return the derivative of `studio.rbf.basis.network_output`.

    Parameters
    ----------
    inputs : (n, d)
    centers : (m, d)
    width : positive, in the unit of the inputs
    weights : (m,) or (m, k)
    order : from 1 up; 1 where d > 1

    Returns
    -------
    (n,) or (n, k) where d is 1, else the Jacobian (n, d) or (n, k, d)

    Raises
    ------
    ValueError
        Where a higher order is asked of more than one feature, or float64 does not hold it.

    """
    if inputs.shape[1] > 1 and order > 1:
        raise ValueError(f"of {inputs.shape[1]} features there is order 1 only, not {order}")
    with np.errstate(all="ignore"):
        if inputs.shape[1] == 1:
            answer = gaussian_derivative(inputs, centers, width, order) @ weights
        else:
            answer = _jacobian(inputs, centers, width, weights)
        answer = answer / np.float64(width) ** order
    if not np.isfinite(answer).all():
        raise ValueError("float64 does not hold the derivative: use another unit for the inputs")
    return answer


def gaussian_derivative(
    inputs: FloatArray, centers: FloatArray, width: float, order: int
) -> FloatArray:
    """Return a derivative of every Gaussian (n, m) by ``x / width``, for inputs (n, 1).

    With ``u = (x - c) / width`` it is ``(-1)^order He_order(u) exp(-u^2 / 2)``, He the
    probabilists' Hermite polynomials (Abramowitz and Stegun 1964, 22.11.8).
    """
    offsets = (inputs - centers.T) / width
    polynomial = hermeval(offsets, [0.0] * order + [(-1.0) ** order])
    answers: FloatArray = polynomial * gaussian_design(inputs, centers, width)
    return np.where(np.isfinite(answers), answers, 0.0)  # a huge power times exp(-huge) is none


def _jacobian(
    inputs: FloatArray, centers: FloatArray, width: float, weights: FloatArray
) -> FloatArray:
    """Return ``sum_j -weights_j phi_j(x) (x - c_j) / width``: (n, d) or (n, k, d)."""
    answers = gaussian_design(inputs, centers, width)
    offsets = (inputs[:, np.newaxis, :] - centers) / width  # (n, m, d)
    summed: FloatArray = np.einsum("nm,nmd,m...->n...d", answers, -offsets, weights)
    return summed
