"""Arrays over control ticks and what is read off them: paths, jumps, second differences, lags."""

import math

import numpy as np
from scipy.interpolate import CubicSpline

from studio.engine.arms import driven_joints
from studio.engine.motion_trace import Mask, finite_rows
from studio.engine.performance import whole_body
from studio.engine.problems import runs_of
from studio.engine.robot import CONTROL_PERIOD, load_robot
from studio.engine.skeleton import FloatArray, Side

QUIET = 0.10  # [m/s] of the wrist
GRID = 0.01  # [s] on which lags are sought ...
LONGEST_LAG = 1.0  # [s] ... up to here

_WRIST = "lower_forearm"  # the link whose origin is the wrist


def wrist_path(angles: FloatArray, side: Side) -> FloatArray:
    """Return where Baxter's wrist is (T, 3) [m] at s0, s1, e0, e1 (T, 4) [rad]; NaN for NaN."""
    body = whole_body(np.nan_to_num(angles), driven_joints(side))
    path: FloatArray = load_robot().forward_kinematics(f"{side}_{_WRIST}", body)[:, :3, 3]
    return np.where(finite_rows(angles)[:, None], path, np.nan)


def flips_of(e0: FloatArray) -> list[int]:
    """Return the ticks from which e0 (T,) [rad] jumps by more than π to the next."""
    ticks: list[int] = np.flatnonzero(np.abs(np.diff(e0)) > math.pi).tolist()
    return ticks


def quiet_ticks(wrist: FloatArray) -> Mask:
    """Return at which ticks (T,) the wrist (T, 3) [m] is nearly still."""
    if len(wrist) < 2:
        return np.zeros(len(wrist), dtype=bool)
    speed = np.linalg.norm(np.gradient(wrist, CONTROL_PERIOD, axis=0), axis=1)
    quiet: Mask = speed < QUIET
    return quiet


def squares_of(wrist: FloatArray, quiet: Mask) -> FloatArray:
    """Return squared second differences (T,) [m²] about quiet ticks, NaN elsewhere."""
    squares = np.full(len(wrist), np.nan)
    if len(wrist) >= 3:
        squares[1:-1] = np.sum(np.diff(wrist, 2, axis=0) ** 2, axis=1)
    return np.where(quiet, squares, np.nan)


def correlation_of(reference: FloatArray, path: FloatArray) -> FloatArray:
    """Return the summed products of the two paths' velocities at each lag (101,) of `GRID`."""
    lags = round(LONGEST_LAG / GRID) + 1
    found = np.zeros(lags)
    for first, last in runs_of(finite_rows(reference) & finite_rows(path)):
        if (last - first) * CONTROL_PERIOD > 2.0 * LONGEST_LAG:
            there, here = (_velocity(x[first : last + 1]) for x in (reference, path))
            # The same stretch of the reference at every lag, or longer lags would count less.
            count = len(there) - lags + 1
            found += [float(np.sum(there[:count] * here[k : k + count])) for k in range(lags)]
    return found


def _velocity(path: FloatArray) -> FloatArray:
    """Return the velocity (N, 3) [m/s] along a path (T, 3) [m] of ticks, on the fine grid."""
    ticks = CONTROL_PERIOD * np.arange(len(path))
    velocity: FloatArray = CubicSpline(ticks, path)(np.arange(0.0, ticks[-1], GRID), 1)
    return velocity


def lag_of(correlation: FloatArray) -> float:
    """Return the lag [s] at which a correlation (101,) is highest; NaN where nothing moved."""
    return GRID * int(np.argmax(correlation)) if correlation.any() else math.nan
