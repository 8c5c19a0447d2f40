"""All numbers of a chain of translations refined at once, by the exact gradient.

What is minimized is the distance between demonstrated paths and bent lines in the space where the
motion happens, not in the straightened one, which may be squeezed. A squashed shift keeps every
translation's steepness below the bound whatever the optimizer tries.
"""

import numpy as np

from studio.rbf.basis import FloatArray
from studio.rbf.diffeomorphism import STEEPEST, Diffeomorphism
from studio.rbf.lessons import Lesson

START_WEIGHT = 100.0  # a path is measured from where it starts, so that must be met
Step = tuple[FloatArray, FloatArray, FloatArray]  # offsets in widths (n, d), squares, Gaussians


class Objective:
    """Weighted mean square distance between paths and bent lines, and its gradient.

    The numbers to find: centers (m, d), free shifts u (m, d), log widths (m,) and the paths'
    starts in the straightened space (K, d). A shift is ``bound sigma sqrt(e) u / sqrt(1 + u^2)``.
    The penalty ``smoothness / 2 ||u||^2`` holds the map near the identity.
    """

    def __init__(self, lesson: Lesson, count: int, bound: float, smoothness: float) -> None:
        paths, points, self._dimension = lesson.paths.shape
        self._count, self._bound, self._smoothness = count, bound, smoothness
        self._remaining = np.tile(lesson.remaining, paths)[:, np.newaxis]
        self._owner = np.repeat(np.arange(paths), points)
        self._targets = lesson.paths.reshape(-1, self._dimension)
        weights = np.ones(points)
        weights[0] = START_WEIGHT
        self._weights = (np.tile(weights, paths) / weights.sum() / paths)[:, np.newaxis]
        self._firsts = points * np.arange(paths)

    def packed(self, chain: Diffeomorphism, starts: FloatArray) -> FloatArray:
        """Return the numbers (p,) of a chain whose steepness is below the bound."""
        shares = np.minimum(chain.steepness / self._bound, 1.0 - 1e-12)  # rounding may make 1 of it
        stretch = 1.0 / (chain.widths / STEEPEST * self._bound * np.sqrt(1.0 - shares**2))
        free = chain.shifts * stretch[:, np.newaxis]
        return np.concatenate(
            [chain.centers.ravel(), free.ravel(), np.log(chain.widths), starts.ravel()]
        )

    def unpacked(self, numbers: FloatArray) -> tuple[Diffeomorphism, FloatArray]:
        """Return the chain and the starts (K, d) that the numbers (p,) stand for."""
        centers, free, log_widths, starts = self._split(numbers)
        widths = np.exp(log_widths)
        return Diffeomorphism(centers, self._stretch(free, widths) * free, widths), starts

    def __call__(self, numbers: FloatArray) -> tuple[float, FloatArray]:
        """Return the objective at these numbers (p,), and its gradient (p,)."""
        centers, free, log_widths, starts = self._split(numbers)
        widths = np.exp(log_widths)
        stretch = self._stretch(free, widths)
        shifts = stretch * free
        goal = np.zeros((1, self._dimension))
        lines = np.concatenate([self._remaining * starts[self._owner], goal])
        bent, steps = _bend(lines, centers, shifts, widths)
        errors = bent[:-1] - bent[-1] - self._targets
        slopes = self._weights * errors
        value = 0.5 * np.vdot(slopes, errors) + 0.5 * self._smoothness * np.vdot(free, free)
        slopes = np.concatenate([slopes, -slopes.sum(axis=0, keepdims=True)])
        to_lines, to_centers, to_shifts, to_widths = _propagate_back(slopes, steps, shifts, widths)
        to_starts = np.add.reduceat(self._remaining * to_lines[:-1], self._firsts, axis=0)
        along = np.einsum("md,md->m", to_shifts, shifts)
        squash = 1.0 + np.square(free).sum(axis=1)
        to_free = stretch * to_shifts + (self._smoothness - along / squash)[:, np.newaxis] * free
        parts = [to_centers.ravel(), to_free.ravel(), to_widths + along, to_starts.ravel()]
        return float(value), np.concatenate(parts)

    def _split(self, numbers: FloatArray) -> list[FloatArray]:
        """Return views of centers, free shifts, log widths and starts."""
        size = self._count * self._dimension
        parts = np.split(numbers, [size, 2 * size, 2 * size + self._count])
        shapes = ((-1, self._dimension), (-1, self._dimension), (-1,), (-1, self._dimension))
        return [part.reshape(shape) for part, shape in zip(parts, shapes, strict=True)]

    def _stretch(self, free: FloatArray, widths: FloatArray) -> FloatArray:
        """Return what a free shift is multiplied by (m, 1) to keep below the bound."""
        squash = np.sqrt(1.0 + np.square(free).sum(axis=1))
        factors: FloatArray = (self._bound / STEEPEST * widths / squash)[:, np.newaxis]
        return factors


def _bend(
    points: FloatArray, centers: FloatArray, shifts: FloatArray, widths: FloatArray
) -> tuple[FloatArray, list[Step]]:
    """Return where a chain takes points (n, d), and what its gradient will need of each step."""
    steps = []
    for center, shift, width in zip(centers, shifts, widths, strict=True):
        relative = (points - center) / width
        squared = np.einsum("nd,nd->n", relative, relative)
        shares = np.exp(-0.5 * squared)
        steps.append((relative, squared, shares))
        points = points + shares[:, np.newaxis] * shift
    return points, steps


def _propagate_back(
    slopes: FloatArray, steps: list[Step], shifts: FloatArray, widths: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the gradient for points (n, d), centers, shifts (m, d) and log widths (m,).

    It begins with the one for where the points ended (n, d), and goes from the last step back.
    """
    to_centers, to_shifts = np.empty_like(shifts), np.empty_like(shifts)
    to_widths = np.empty_like(widths)
    for place in reversed(range(len(steps))):
        relative, squared, shares = steps[place]
        pull = shares * (slopes @ shifts[place])
        change = (pull / widths[place])[:, np.newaxis] * relative
        to_shifts[place] = shares @ slopes
        to_widths[place] = pull @ squared
        to_centers[place] = change.sum(axis=0)
        slopes = slopes - change
    return slopes, to_centers, to_shifts, to_widths
