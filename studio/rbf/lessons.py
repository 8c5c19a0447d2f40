"""What a field that ends in its goal can take from demonstrations: paths to the goal, in its unit.

The points of a path are an equal way apart, so that where a hand rested counts no more than where
it moved; when it passed them is kept beside.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from studio.rbf.basis import FloatArray
from studio.rbf.trajectories import Trajectory

PATH_POINTS = 40  # a path; the shapes of handwriting lose nothing that a person's repeats share
RESTING = 0.01  # [reach] what moves less than this is a hand at rest, or noise
NEAREST_START = 0.02  # [reach] a start this near the goal is the goal
FARTHEST_END = 0.25  # [reach] an end this far from the goal is another goal


@dataclass(frozen=True, eq=False)
class Lesson:
    """Paths that start anywhere and end at the goal, which is the origin here."""

    paths: FloatArray  # (K, n, d), in `unit`, relative to `goal`
    times: FloatArray  # (K, n), when each point was passed
    goal: FloatArray  # (d,)
    unit: float  # mean reach of the demonstrations, in the unit of positions

    @property
    def remaining(self) -> FloatArray:
        """What is left of the way at each point (n,): 1 at the start, 0 at the goal."""
        return np.linspace(1.0, 0.0, self.paths.shape[1])

    @property
    def starts(self) -> FloatArray:
        """Where each path begins (K, d)."""
        return self.paths[:, 0]

    @property
    def rates(self) -> FloatArray:
        """How fast the logarithm of what remains fell between points (K, n - 2), in 1 / time.

        The last stretch is left out: its logarithm falls without end.
        """
        falls = -np.diff(np.log(self.remaining[:-1]))
        found: FloatArray = falls / np.diff(self.times[:, :-1], axis=1)
        return found


def lesson_from(trajectories: Sequence[Trajectory], goal: FloatArray | None) -> Lesson:
    """Return the paths of demonstrations to a goal (d,), or to the mean of their ends where None.

    Each is bent so that it ends exactly there: a shift that grows with the way.

    Raises
    ------
    ValueError
        Where a demonstration does not move, starts at the goal or ends far from it.

    """
    if goal is None:
        goal = np.mean([trajectory.positions[-1] for trajectory in trajectories], axis=0)
    walks = [
        _walk(trajectory, goal, f"demonstration {number}")
        for number, trajectory in enumerate(trajectories, start=1)
    ]
    paths = np.stack([path for path, _ in walks])
    unit = float(np.linalg.norm(paths, axis=2).max(axis=1).mean())
    return Lesson(paths / unit, np.stack([times for _, times in walks]), goal, unit)


def _walk(trajectory: Trajectory, goal: FloatArray, name: str) -> tuple[FloatArray, FloatArray]:
    """Return points (n, d) an equal way apart, relative to the goal, and when they were passed."""
    relative = trajectory.positions - goal
    distances = np.linalg.norm(relative, axis=1)
    reach = float(distances.max())
    if not np.ptp(trajectory.positions, axis=0).any():
        raise ValueError(f"{name} does not move: there is nothing to learn from it")
    if distances[0] < NEAREST_START * reach:
        raise ValueError(
            f"{name} starts at its goal: a field has one velocity at each place (Eq. 5), and there "
            f"it is to stand still; split the motion in two where it turns back"
        )
    if distances[-1] > FARTHEST_END * reach:
        raise ValueError(
            f"{name} ends {distances[-1]:.3g} from the goal, more than a quarter of its reach of "
            f"{reach:.3g}: give the goal where it ends"
        )
    moving = _moving(relative, RESTING * reach)
    path, times = relative[moving], trajectory.times[moving]
    way = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1)))
    path = path - (way / way[-1])[:, np.newaxis] * path[-1]
    places = np.linspace(0.0, way[-1], PATH_POINTS)
    points = np.stack([np.interp(places, way, column) for column in path.T], axis=1)
    return points, np.interp(places, way, times)


def _moving(positions: FloatArray, step: float) -> list[int]:
    """Return the samples that lie at least a step from the one returned before."""
    found = [0]
    for place, position in enumerate(positions):
        if np.linalg.norm(position - positions[found[-1]]) >= step:
            found.append(place)
    return found
