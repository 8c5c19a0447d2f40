"""A diffeomorphism that bends straight lines to the goal into demonstrated paths.

A first chain is grown greedily, as Perrin and Schlehuber-Caissier (2016) do: each translation is
the one that brings the bent lines closest to the paths. Then all its numbers are refined at once,
see `studio.rbf.refinement`.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from scipy.spatial.distance import cdist

from studio.rbf.basis import FloatArray
from studio.rbf.diffeomorphism import STEEPEST, Diffeomorphism
from studio.rbf.lessons import Lesson
from studio.rbf.refinement import Objective

FIRST_WIDTHS = np.geomspace(0.05, 2.4, 12)  # [reach] what the greedy search tries
GREEDY_STRIDE = 2  # it looks at every second point of a path: enough to begin with
GREEDY_SHARES = (0.95, 0.8, 0.6, 0.4, 0.25)  # [bound] below 1: its squashed shift is infinite
MOST_CANDIDATES = 200  # for a center, however many demonstrations there are
LONGEST_TRIED = 30  # translations: those that come first in a chain decide how it unrolls
TRIAL = 60  # iterations until a first chain shows what it is good for
GOAL_WEIGHT = 5.0  # of the goal in the greedy search, where all paths meet
MEMORY = 20  # pairs that L-BFGS remembers


@dataclass(frozen=True, eq=False)
class Match:
    """A chain for which ``forward(r * start) - forward(0)`` is a path, r what remains of its way.

    Both sides are in the lesson's unit and relative to its goal.
    """

    chain: Diffeomorphism
    error: float  # root mean square distance between paths and bent lines, in the lesson's unit


def match(lesson: Lesson, count: int, bound: float, smoothness: float, iterations: int) -> Match:
    """Return a chain of ``count`` translations whose steepness stays below ``bound``.

    The first chain decides on which side of each other the parts of a path are unrolled, and no
    refinement changes that: so a few are tried, and the most promising one is grown to its whole
    length and finished.
    """
    first = min(count, LONGEST_TRIED)
    objective = Objective(lesson, first, bound, smoothness)
    trials = [
        _refined(
            objective, objective.packed(grow(lesson, first, share * bound), lesson.starts), TRIAL
        )
        for share in GREEDY_SHARES
    ]
    numbers = min(trials, key=lambda trial: trial[0])[1]
    if count > first:
        chain, starts = objective.unpacked(numbers)
        chain = _longer(chain, starts, lesson, count - first, GREEDY_SHARES[0] * bound)
        objective = Objective(lesson, count, bound, smoothness)
        numbers = objective.packed(chain, starts)
    numbers = _refined(objective, numbers, iterations)[1]
    chain, starts = objective.unpacked(numbers)
    lines = lesson.remaining[:, np.newaxis] * starts[:, np.newaxis]
    bent = chain.forward(lines.reshape(-1, starts.shape[1])) - chain.forward(
        np.zeros_like(starts[:1])
    )
    squares = np.square(bent.reshape(lesson.paths.shape) - lesson.paths).sum(axis=2)
    return Match(chain, float(np.sqrt(squares.mean())))


def _refined(
    objective: Objective, numbers: FloatArray, iterations: int
) -> tuple[float, FloatArray]:
    found = minimize(
        objective,
        numbers,
        jac=True,
        method="L-BFGS-B",
        options={"maxiter": iterations, "maxfun": 2 * iterations, "maxcor": MEMORY},
    )
    return float(found.fun), found.x


def grow(lesson: Lesson, count: int, bound: float) -> Diffeomorphism:
    """Return a first chain, each translation the best one for what the others left over."""
    dimension = lesson.paths.shape[2]
    nothing = Diffeomorphism(np.empty((0, dimension)), np.empty((0, dimension)), np.empty(0))
    return _longer(nothing, lesson.starts, lesson, count, bound)


def _longer(
    chain: Diffeomorphism, starts: FloatArray, lesson: Lesson, count: int, bound: float
) -> Diffeomorphism:
    """Return a chain with ``count`` translations more for lines from starts (K, d).

    Each sits on a point of the bent lines, its width is one of `FIRST_WIDTHS`, its shift solves the
    least squares problem that remains, shortened to the bound.
    """
    picked = slice(None, None, -GREEDY_STRIDE)  # from the goal, so that this one is among them
    dimension = lesson.paths.shape[2]
    remaining = lesson.remaining[picked, np.newaxis]
    goal = chain.forward(np.zeros((1, dimension)))  # the paths are relative to where it is now
    targets = lesson.paths[:, picked].reshape(-1, dimension) + goal
    points = chain.forward((remaining * starts[:, np.newaxis]).reshape(-1, dimension))
    weights = np.tile(np.where(remaining[:, 0] == 0.0, GOAL_WEIGHT, 1.0), len(lesson.paths))
    links = [chain]
    for _ in range(count):
        links.append(_best_translation(points, targets - points, weights, bound))
        points = links[-1].forward(points)
    return Diffeomorphism(
        np.concatenate([link.centers for link in links]),
        np.concatenate([link.shifts for link in links]),
        np.concatenate([link.widths for link in links]),
    )


def _best_translation(
    points: FloatArray, missing: FloatArray, weights: FloatArray, bound: float
) -> Diffeomorphism:
    """Return the translation of points (n, d) that leaves the least of what is missing (n, d)."""
    candidates = points[:: -(-len(points) // MOST_CANDIDATES)]
    squared = cdist(candidates, points, "sqeuclidean")
    best_gain, best = -1.0, None
    for width in FIRST_WIDTHS:
        shares = np.exp(-0.5 * squared / width**2)  # of every point (columns) in every center's
        weighted = shares * weights
        curvatures = np.einsum("cn,cn->c", weighted, shares)
        slopes = weighted @ missing
        shifts = slopes / curvatures[:, np.newaxis]
        lengths = np.linalg.norm(shifts, axis=1)
        longest = bound * width / STEEPEST
        shifts *= (longest / np.maximum(lengths, longest))[:, np.newaxis]
        gains = 2.0 * np.einsum("cd,cd->c", shifts, slopes)
        gains -= np.square(shifts).sum(axis=1) * curvatures
        place = int(np.argmax(gains))
        if gains[place] > best_gain:
            best_gain = gains[place]
            best = Diffeomorphism(candidates[[place]], shifts[[place]], np.array([width]))
    if best is None:
        raise ValueError("the paths are too far apart for a translation to be judged")
    return best
