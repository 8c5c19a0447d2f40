"""What the mean square error does not see: how a curve moves between the samples.

A network can meet every sample and ripple in between; a robot that plays it feels that. So the
curve is held against the smoothing spline through the mean demonstration (Craven and Wahba 1979),
on a grid far finer than the stamps.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import make_smoothing_spline

from studio.rbf.basis import FloatArray
from studio.rbf.validation import demonstration_arrays, stamp_arrays

FINER = 14  # points a stamp: the narrowest useful Gaussian still has ten of them
FEWEST_STAMPS = 5  # of a cubic smoothing spline


@dataclass(frozen=True, eq=False)
class Smoothness:
    """A curve beside the smoothing spline of what it was taught, between the first and last stamp.

    Examples
    --------
    >>> import numpy as np
    >>> Smoothness(np.array([2.0]), np.array([1.0]), np.array([0.01])).ratio
    2.0

    """

    acceleration: FloatArray  # (D,), root mean square of the second derivative, outputs / stamp²
    of_spline: FloatArray  # (D,), the same of the smoothing spline
    deviation: FloatArray  # (D,), largest distance from the spline, in units of the outputs

    @property
    def ratio(self) -> float:
        """Acceleration over the spline's, over all outputs together; about 1 is smooth."""
        own, spline = np.linalg.norm(self.acceleration), np.linalg.norm(self.of_spline)
        if spline == 0.0:
            return 1.0 if own == 0.0 else np.inf
        return float(own / spline)


def smoothness(
    curve: Callable[[FloatArray], ArrayLike],
    demonstrations: ArrayLike | Sequence[ArrayLike],
    stamps: ArrayLike | None = None,
) -> Smoothness:
    """Measure a curve between the stamps of its demonstrations.

    Parameters
    ----------
    curve : function of inputs (n, 1) to (n,) or (n, D), such as a learner's `predict`
    demonstrations : (K, T, D), of shared stamps
    stamps : (T,), rising; 1 to T where they are not given

    Raises
    ------
    ValueError
        Where the stamps differ between demonstrations, do not rise or are fewer than 5, or the
        curve does not answer with D finite outputs.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.linspace(0.0, 6.0, 60)
    >>> taught = np.sin(t)[np.newaxis, :, np.newaxis]
    >>> round(smoothness(np.sin, taught, t).ratio, 2)
    1.0
    >>> rippled = smoothness(lambda x: np.sin(x) + 0.01 * np.sin(60.0 * x), taught, t)
    >>> rippled.ratio > 30.0, rippled.deviation.round(2).tolist()
    (True, [0.01])

    """
    arrays = demonstration_arrays(demonstrations)
    times = stamp_arrays(stamps, arrays)
    if any(not np.array_equal(times[0], each) for each in times):
        raise ValueError("smoothness compares with the mean curve, so stamps must be shared")
    if len(times[0]) < FEWEST_STAMPS or not (np.diff(times[0]) > 0.0).all():
        raise ValueError(f"smoothness needs {FEWEST_STAMPS} or more rising stamps")
    mean = np.mean(arrays, axis=0)
    fine = np.linspace(times[0][0], times[0][-1], FINER * (len(times[0]) - 1) + 1)
    spline = _smoothing_spline(times[0].tobytes(), mean.tobytes(), fine.tobytes())
    found = np.asarray(curve(fine[:, np.newaxis]), dtype=np.float64).reshape(len(fine), -1)
    if found.shape != spline.shape or not np.isfinite(found).all():
        raise ValueError(f"the curve must answer with {mean.shape[1]} finite outputs")
    with np.errstate(over="ignore", divide="ignore", invalid="ignore", under="ignore"):
        step = fine[1] - fine[0]
        if not 0.0 < step**2 < np.inf:
            raise ValueError(f"stamps {step * FINER:.3g} apart need another unit of time")
    return Smoothness(
        acceleration=_acceleration(found, step),
        of_spline=_acceleration(spline, step),
        deviation=np.abs(found - spline).max(axis=0),
    )


@lru_cache(maxsize=8)  # a sweep measures every network against one and the same
def _smoothing_spline(stamp_bytes: bytes, mean_bytes: bytes, asked_bytes: bytes) -> FloatArray:
    """Return the spline through a mean curve (T, D), its penalty chosen by GCV, at stamps asked.

    The arrays come as their bytes, by which they are found again; the answer is read-only.

    scipy seeks the penalty below T whatever the unit of time, so the spline gets stamps whose mean
    spacing is 1; and outputs relative to the first, so that those that never change stay exact.
    """
    stamps, asked = np.frombuffer(stamp_bytes), np.frombuffer(asked_bytes)
    mean = np.frombuffer(mean_bytes).reshape(len(stamps), -1)
    spacing = (stamps[-1] - stamps[0]) / (len(stamps) - 1)
    times, at = (stamps - stamps[0]) / spacing, (asked - stamps[0]) / spacing
    columns = [make_smoothing_spline(times, column)(at) for column in (mean - mean[0]).T]
    spline: FloatArray = np.column_stack(columns) + mean[0]
    spline.setflags(write=False)
    return spline


def _acceleration(curve: FloatArray, step: float) -> FloatArray:
    """Return the root mean square (D,) of the second differences of a curve (n, D)."""
    return np.asarray(np.sqrt(np.square(np.diff(curve, 2, axis=0)).mean(axis=0)) / step**2)
