"""The paper's Eq. 5, made safe: a field of velocities that ends in its goal from everywhere."""

import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.distance import cdist

from studio.rbf.basis import FloatArray
from studio.rbf.certificate import Certificate
from studio.rbf.contract import change_settings, get_settings, require_fitted
from studio.rbf.lessons import Lesson, lesson_from
from studio.rbf.matching import match
from studio.rbf.pace import learn_pace
from studio.rbf.trajectories import Trajectory, as_states, read_demonstrations, read_goal
from studio.rbf.validation import number_above, whole_number

POOR = 0.1  # [reach] a field this far from its demonstrations is not what they show
LINE_POINTS = 1000  # of a bent line, when demonstrations are compared with it


@dataclass(eq=False)
class StableField:
    """A field ``x' = f(x)`` learned from demonstrations that reaches its goal from every start.

    A diffeomorphism bends the straight lines to the goal into the demonstrated paths; along a line
    the distance shrinks at a positive rate, itself learned from the demonstrated speeds. So every
    path is the image of a straight one, and ends where that ends: see `Certificate`. One
    demonstration is enough; of several it takes what they share.

    A field knows one velocity for each place, so a path must not cross itself, and must not return
    to where it started.

    Parameters
    ----------
    goal : (d,) or None, default None
        Where all paths end. None takes the mean of the demonstrations' ends.
    n_translations : int, default 30
        How many Gaussian-weighted translations the diffeomorphism has.
    bound : number above 0 and below 1, default 0.8
        No translation gets steeper. Near 1 the inverse may be steep.
    smoothness : number >= 0, default 3e-5
        Weight of the penalty that holds the map near the identity.
    max_iterations : int, default 300
        Of L-BFGS, which refines the map.
    n_neurons : int, default 30
        Gaussians of the network that learns the rate.

    Attributes
    ----------
    certificate_ : Certificate
    map_ : Diffeomorphism
        From straightened space to the space of motion, both in `unit_`, before the goal is moved
        to its place.
    pace_ : Pace
        The rate in straightened space.
    goal_ : (d,)
    unit_ : float
        Mean reach of the demonstrations, in the unit of positions.
    error_ : float
        Root mean square distance from the demonstrated samples to the path that the field takes
        from where they began, in the unit of positions.
    n_features_in_ : int
        The dimension d.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.linspace(0.0, 2.0, 60)
    >>> hook = np.column_stack([2.0 - t, np.sin(1.5 * t) * (2.0 - t)])
    >>> field = StableField(goal=[0.0, 0.0]).fit([(t, hook)])
    >>> field.certificate_.holds
    True
    >>> path = field.rollout([2.0, 0.0], dt=0.05, steps=400)
    >>> bool(np.linalg.norm(path[-1]) < 1e-3)
    True

    """

    goal: ArrayLike | None = None
    n_translations: int = 30
    bound: float = 0.8
    smoothness: float = 3e-5
    max_iterations: int = 300
    n_neurons: int = 30

    def fit(
        self,
        demonstrations: Iterable[ArrayLike] | Iterable[tuple[ArrayLike, ArrayLike]],
        dt: float | None = None,
    ) -> Self:
        """Learn from demonstrations.

        Parameters
        ----------
        demonstrations : pairs of times (T,) and positions (T, d), each of its own length; with
            ``dt``, positions (T, d) alone, so that an array (K, T, d) will do
        dt : time between samples, where the demonstrations bring none

        Raises
        ------
        ValueError
            Where a setting or a demonstration cannot be used; the message says which and why.
        TypeError
            Where a setting is of the wrong type.

        Warns
        -----
        UserWarning
            Where the field misses its demonstrations by more than a tenth of their reach: they
            show what no such field can do, as a motion that turns back on its own path.

        """
        count = whole_number(self.n_translations, "n_translations")
        iterations = whole_number(self.max_iterations, "max_iterations")
        neurons = whole_number(self.n_neurons, "n_neurons")
        smoothness = number_above(self.smoothness, "smoothness", 0.0, inclusive=True)
        bound = number_above(self.bound, "bound", 0.0, inclusive=False)
        if bound >= 1.0:
            raise ValueError(f"bound is below 1, or the map may fold: not {self.bound!r}")
        trajectories = read_demonstrations(demonstrations, dt)
        dimension = trajectories[0].positions.shape[1]
        lesson = lesson_from(trajectories, read_goal(self.goal, dimension))
        found = match(lesson, count, bound, smoothness, iterations)
        self.map_ = found.chain
        self.goal_ = lesson.goal
        self.unit_ = lesson.unit
        self.n_features_in_ = dimension
        self.pace_ = learn_pace(*self._seen_rates(lesson), neurons)
        self.certificate_ = Certificate.of(self.map_, self.pace_)
        self.error_ = self._distance_from(trajectories)
        if self.error_ > POOR * self.unit_:
            warnings.warn(
                f"the field misses its demonstrations by {self.error_:.3g} (RMS), "
                f"{100.0 * self.error_ / self.unit_:.0f} % of their reach: it arrives, but it is "
                "not what they show; split a motion where it turns back, or raise n_translations",
                stacklevel=2,
            )
        return self

    def velocity(self, x: ArrayLike) -> FloatArray:
        """Return the velocity x' = f(x) of Eq. 5.

        Parameters
        ----------
        x : (d,) or (n, d), in the unit of the demonstrated positions

        Returns
        -------
        of the same shape, in that unit over the unit of the demonstrated times

        Raises
        ------
        NotFittedError
            Before `fit`.
        ValueError
            Where the points cannot be used.

        Examples
        --------
        >>> line = np.exp(-np.linspace(0.0, 4.0, 80))[:, np.newaxis]  # x' = -x
        >>> field = StableField(goal=[0.0], n_translations=3).fit([line], dt=4.0 / 79.0)
        >>> field.velocity([0.5]).round(1)
        array([-0.5])

        """
        require_fitted(self)
        points, shape = as_states(x, self.n_features_in_)
        straight = self._straighten(points)
        towards = -self.pace_.rates(straight)[:, np.newaxis] * straight
        _, pushed = self.map_.push_forward(straight, towards)
        return (self.unit_ * pushed).reshape(shape)

    def rollout(self, x0: ArrayLike, dt: float, steps: int) -> FloatArray:
        """Return the path that the field takes from a start.

        It is computed in straightened space, where the direction never changes and the logarithm
        of the distance falls: by Runge-Kutta's fourth order in that logarithm, so that it falls
        with whatever dt.

        Parameters
        ----------
        x0 : (d,) or (n, d), in the unit of the demonstrated positions
        dt : time from one point to the next, in the unit of the demonstrated times
        steps : how many, 1 or more

        Returns
        -------
        (steps + 1, d), or (steps + 1, n, d) from several starts; the first point is the start

        Raises
        ------
        NotFittedError
            Before `fit`.
        ValueError, TypeError
            Where the starts, dt or steps cannot be used.

        Examples
        --------
        >>> line = np.exp(-np.linspace(0.0, 4.0, 80))[:, np.newaxis]  # x' = -x
        >>> field = StableField(goal=[0.0], n_translations=3).fit([line], dt=4.0 / 79.0)
        >>> field.rollout([1.0], dt=0.5, steps=4)[:, 0].round(1)
        array([1. , 0.6, 0.4, 0.2, 0.1])

        """
        require_fitted(self)
        step = number_above(dt, "dt", 0.0, inclusive=False)
        count = whole_number(steps, "steps")
        starts, shape = as_states(x0, self.n_features_in_)
        straight = self._straighten(starts)
        lines = np.stack(list(self.pace_.descend(straight, step, count)))
        bent = self._bend(lines.reshape(-1, self.n_features_in_))
        path = bent.reshape(count + 1, *shape)
        path[0] = starts.reshape(shape)
        return path

    def lyapunov(self, x: ArrayLike) -> FloatArray | float:
        """Return V at points (n, d): (n,); at one point (d,): a number. See `Certificate`.

        It has no unit, and is infinite where float64 cannot hold it. Raises as `velocity`.
        """
        require_fitted(self)
        points, shape = as_states(x, self.n_features_in_)
        with np.errstate(over="ignore"):
            values: FloatArray = np.square(self._straighten(points)).sum(axis=1)
        return values if len(shape) == 2 else float(values[0])

    def _straighten(self, points: FloatArray) -> FloatArray:
        """Return where points (n, d) lie in the space where all paths are straight: (n, d)."""
        return self.map_.inverse((points - self.goal_) / self.unit_ + self._moved_goal())

    def _bend(self, straight: FloatArray) -> FloatArray:
        """Return the points (n, d) that `_straighten` takes to these: (n, d)."""
        moved = self.map_.forward(straight) - self._moved_goal()
        return self.goal_ + self.unit_ * moved

    def get_params(self, deep: bool = True) -> dict[str, Any]:  # noqa: ARG002 scikit-learn's name
        """Return the settings by name."""
        return get_settings(self)

    def set_params(self, **params: Any) -> Self:
        """Change settings by name; raise ValueError for a name that is none."""
        change_settings(self, params)
        return self

    def _distance_from(self, trajectories: Sequence[Trajectory]) -> float:
        """Return how far samples are from the path that begins where they do, RMS over all."""
        squares = []
        for trajectory in trajectories:
            start = self._straighten(trajectory.positions[:1])
            path = self._bend(np.linspace(1.0, 0.0, LINE_POINTS)[:, np.newaxis] * start)
            squares.append(cdist(trajectory.positions, path, "sqeuclidean").min(axis=1))
        return float(np.sqrt(np.concatenate(squares).mean()))

    def _moved_goal(self) -> FloatArray:
        """Return where the map takes the straightened goal, the origin (1, d)."""
        return self.map_.forward(np.zeros((1, self.n_features_in_)))

    def _seen_rates(self, lesson: Lesson) -> tuple[FloatArray, FloatArray]:
        """Return straightened points (n, d) on the demonstrations' lines, and the rates (n,)."""
        starts = self.map_.inverse(lesson.paths[:, 0] + self._moved_goal())
        passed = lesson.remaining[:-1]
        between = np.sqrt(passed[1:] * passed[:-1])[:, np.newaxis]  # halfway in the logarithm
        lines = between * starts[:, np.newaxis]
        return lines.reshape(-1, self.n_features_in_), lesson.rates.ravel()
