"""Demonstrations of a motion as paths through space, each with its own stamps."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from studio.rbf.basis import FloatArray
from studio.rbf.validation import finite_array, number_above

SMALLEST = 1e-100  # reach and time, so that their squares and ratios stay within float64


@dataclass(frozen=True, eq=False)
class Trajectory:
    """One demonstration."""

    times: FloatArray  # (T,), rising
    positions: FloatArray  # (T, d)

    @property
    def velocities(self) -> FloatArray:
        """Central differences (T, d), one-sided at the ends: the derivative in Eq. 5."""
        if len(self.times) == 2:
            found: FloatArray = np.gradient(self.positions, self.times, axis=0)
        else:  # of second order at the ends too
            found = np.gradient(self.positions, self.times, axis=0, edge_order=2)
        return found


def read_demonstrations(
    demonstrations: Iterable[ArrayLike] | Iterable[tuple[ArrayLike, ArrayLike]],
    dt: float | None,
) -> tuple[Trajectory, ...]:
    """Return demonstrations as trajectories of one dimension.

    Parameters
    ----------
    demonstrations : pairs of times (T,) and positions (T, d); with ``dt``, positions (T, d) alone,
        so that an array (K, T, d) will do
    dt : time between two samples, or None where every demonstration brings its times

    Raises
    ------
    ValueError, TypeError
        Where there is none, one has fewer than two samples, times do not rise, a number is not
        finite, or the dimensions differ. The message names the demonstration, counted from 1.

    """
    step = None if dt is None else number_above(dt, "dt", 0.0, inclusive=False)
    found = tuple(
        _trajectory(item, step, f"demonstration {number}")
        for number, item in enumerate(demonstrations, start=1)
    )
    if not found:
        raise ValueError("there is no demonstration to learn from")
    dimensions = [trajectory.positions.shape[1] for trajectory in found]
    if len(set(dimensions)) > 1:
        raise ValueError(f"demonstrations have one dimension d, not {dimensions}")
    with np.errstate(over="ignore"):
        reach = max(float(np.ptp(each.positions, axis=0).max()) for each in found)
        spans = [float(each.times[-1] - each.times[0]) for each in found]
    if reach and not SMALLEST < reach < 1.0 / SMALLEST:
        raise ValueError(f"demonstrations that reach {reach:.3g} far need another unit")
    if not (min(spans) > SMALLEST and max(spans) < 1.0 / SMALLEST):
        raise ValueError(f"demonstrations that take {max(spans):.3g} need another unit of time")
    return found


def _trajectory(item: object, step: float | None, name: str) -> Trajectory:
    if step is not None:
        positions = _positions(item, name)
        stamps: FloatArray = step * np.arange(len(positions), dtype=np.float64)
        return Trajectory(stamps, positions)
    if not isinstance(item, tuple | list) or len(item) != 2:
        raise ValueError(f"{name} is a pair of times (T,) and positions (T, d); or give dt")
    times: FloatArray = finite_array(item[0], f"times of {name}")
    positions = _positions(item[1], name)
    if times.shape != positions.shape[:1]:
        raise ValueError(f"{name} has {len(positions)} positions, but times of shape {times.shape}")
    late = np.flatnonzero(~(np.diff(times) > 0.0))
    if len(late):
        raise ValueError(f"times of {name} must rise, but sample {late[0] + 1} is not after it")
    return Trajectory(times, positions)


def _positions(item: object, name: str) -> FloatArray:
    try:
        positions = finite_array(item, f"positions of {name}")  # type: ignore[arg-type]
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: {error}") from error
    if positions.ndim != 2 or positions.shape[1] == 0:
        raise ValueError(f"positions of {name} have shape (T, d), not {positions.shape}")
    if len(positions) < 2:
        raise ValueError(f"{name} has {len(positions)} samples, but a motion takes at least two")
    return positions


def read_goal(goal: ArrayLike | None, dimension: int) -> FloatArray | None:
    """Return a goal (d,), or None where it is not given; raise ValueError for another shape."""
    if goal is None:
        return None
    found = finite_array(goal, "goal")
    if found.shape != (dimension,):
        raise ValueError(f"goal has shape ({dimension},), not {found.shape}")
    return found


def as_states(x: ArrayLike, dimension: int) -> tuple[FloatArray, tuple[int, ...]]:
    """Return points (d,) or (n, d) as (n, d), and the shape that they had.

    Raises ValueError where the shape is another one, or a number is not finite.
    """
    values = finite_array(x, "x")
    if values.ndim not in (1, 2) or values.shape[-1] != dimension or len(values) == 0:
        raise ValueError(f"x has shape ({dimension},) or (n, {dimension}), not {values.shape}")
    return values.reshape(-1, dimension), values.shape
