"""Eq. 5 on Baxter: motions that follow fields of joint velocities instead of a clock.

A field has one velocity for each posture, but an arm that pushes and comes back passes every
posture twice. So `PushAndReturn` learns two fields, one to the turning point and one back, and
changes over where the first has arrived; `OnePlainField` is the paper's single field as printed,
which cannot do it. Both start at once: a field has no clock, so it cannot wait as a person does.

Both are learners as `studio.engine.teaching.Model` asks for: they answer with the path that their
fields take from the demonstrations' mean start, at the time asked for.
"""

import math
import warnings
from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline

from studio.engine.errors import StudioError
from studio.engine.skeleton import FloatArray
from studio.rbf import PlainField, StableField

STEPS = 568  # in a demonstration's duration, between points of a path: four a sample of the 142
ARRIVED = 0.02  # of a leg's reach: so near its goal, the next leg begins
RETURNS = 0.25  # of the reach: a motion that ends nearer than this to its turning point stays there
ITERATIONS = 300  # of the refinement of a field's map, up to 60 neurons
REFINED = 18_000  # neurons times iterations: more neurons get fewer, as somebody waits for them
LONGEST = 4  # times the demonstrated duration, after which a leg ends wherever it is
Demonstrations = Sequence[tuple[FloatArray, FloatArray]]  # times (T,) and joints (T, D) [rad]


class PushAndReturn:
    """Two stable fields in a row, or one where the demonstrations end where they turn."""

    def __init__(self, neurons: int, bound: float = 0.8) -> None:
        self.neurons, self.bound = neurons, bound
        self.fields: tuple[StableField, ...] = ()

    def fit(self, X: FloatArray, Y: FloatArray) -> "PushAndReturn":
        """Learn joints (n, D) [rad] from demonstrations one after another, X (n,) their times."""
        taught = split_where_time_restarts(X, Y)
        legs = legs_of(taught)
        iterations = min(ITERATIONS, REFINED // self.neurons)
        try:
            with warnings.catch_warnings():  # how far it misses is in the remark
                warnings.simplefilter("ignore", UserWarning)
                self.fields = tuple(
                    StableField(
                        n_translations=self.neurons, bound=self.bound, max_iterations=iterations
                    ).fit(leg)
                    for leg in legs
                )
        except ValueError as error:
            cure = "leave out the demonstration that differs from the others, or take rbf"
            raise StudioError(f"field: {error}; {cure}") from error
        step = _duration(taught) / STEPS
        paths = [np.mean([rows[:1] for _, rows in taught], axis=0)]
        for field in self.fields:
            paths.append(_until_arrived(field, paths[-1][-1], step)[1:])
        self._path = _spline(np.concatenate(paths), step)
        self._first = float(taught[0][0][0])
        return self

    def predict(self, X: FloatArray) -> FloatArray:
        """Return the joints (n, D) [rad] at times X (n,) or (n, 1)."""
        return _at(self._path, X.ravel() - self._first)

    @property
    def remark(self) -> str:
        """The fields' certificates in words."""
        names = ("there", "back")[: len(self.fields)]
        certificates = [
            f"field {name}: {field.certificate_}, {math.degrees(field.error_):.1f} deg from what "
            "was shown"
            for name, field in zip(names, self.fields, strict=True)
        ]
        return "; ".join([*certificates, "fields keep no time: compare paths, not times"])


class OnePlainField:
    """The paper's Eq. 5 with Eq. 6 to 15 as printed: one field for the whole motion."""

    def __init__(self, neurons: int) -> None:
        self.neurons = neurons

    def fit(self, X: FloatArray, Y: FloatArray) -> "OnePlainField":
        """Learn joints (n, D) [rad] from demonstrations one after another, X (n,) their times."""
        taught = split_where_time_restarts(X, Y)
        start = np.mean([rows[0] for _, rows in taught], axis=0)
        step = _duration(taught) / STEPS
        self.field = PlainField(n_neurons=self.neurons).fit(taught)
        path = self.field.rollout(start, step, STEPS)
        reach = max(_from_start(rows).max() for _, rows in taught)
        if not reach > 0.0:
            raise StudioError("plain-field: nothing moves in these demonstrations")
        share = _from_start(path).max() / reach
        short = np.linalg.norm(path[-1] - np.mean([rows[-1] for _, rows in taught], axis=0))
        self.remark = (
            f"one field for both ways, nothing certified: it gets {100.0 * share:.0f} % as far "
            f"from its start as the demonstrations, and stops {short:.2f} rad from their end"
        )
        self._path = _spline(path, step)
        self._first = float(taught[0][0][0])
        return self

    def predict(self, X: FloatArray) -> FloatArray:
        """Return the joints (n, D) [rad] at times X (n,) or (n, 1)."""
        return _at(self._path, X.ravel() - self._first)


def split_where_time_restarts(X: FloatArray, Y: FloatArray) -> Demonstrations:
    """Return demonstrations that lie one after another: times do not rise where one begins."""
    times = X.ravel()
    firsts = np.flatnonzero(np.diff(times) <= 0.0) + 1
    return list(zip(np.split(times, firsts), np.split(Y, firsts), strict=True))


def legs_of(taught: Demonstrations) -> tuple[Demonstrations, ...]:
    """Return the demonstrations up to where each turns, and from there on if they come back."""
    turns = [int(_from_start(rows).argmax()) for _, rows in taught]
    there = [
        (times[: turn + 1], rows[: turn + 1])
        for (times, rows), turn in zip(taught, turns, strict=True)
    ]
    back = [(times[turn:], rows[turn:]) for (times, rows), turn in zip(taught, turns, strict=True)]
    returning = [
        bool(np.linalg.norm(rows[-1] - rows[0]) > RETURNS * _from_start(whole).max())
        for (_, rows), (_, whole) in zip(back, taught, strict=True)
    ]
    if len(set(returning)) > 1:
        odd = 1 + returning.index(returning.count(True) < len(returning) / 2)
        raise StudioError(
            f"field: some demonstrations come back and others stay where they turn (number {odd} "
            "differs from most): leave out one kind"
        )
    return (there, back) if returning[0] else (taught,)


def _from_start(rows: FloatArray) -> FloatArray:
    distances: FloatArray = np.linalg.norm(rows - rows[0], axis=1)
    return distances


def _duration(taught: Demonstrations) -> float:
    return float(max(times[-1] - times[0] for times, _ in taught))


def _until_arrived(field: StableField, start: FloatArray, step: float) -> FloatArray:
    """Return a field's path (n, D) up to where it has as good as reached its goal."""
    path = field.rollout(start, step, LONGEST * STEPS)
    far = np.linalg.norm(path - field.goal_, axis=1) > ARRIVED * field.unit_
    return path[: int(np.argmin(far)) + 1] if not far.all() else path


def _spline(path: FloatArray, step: float) -> CubicSpline:
    return CubicSpline(step * np.arange(len(path)), path)


def _at(path: CubicSpline, times: FloatArray) -> FloatArray:
    """Return the path (n, D) at times (n,): after its end it rests there."""
    joints: FloatArray = path(np.clip(times, path.x[0], path.x[-1]))
    return joints
