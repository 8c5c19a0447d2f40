"""How fast a straightened line is walked: a positive rate, learned where demonstrations went."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from studio.rbf.basis import FloatArray, gaussians
from studio.rbf.regressor import RBFRegressor
from studio.rbf.validation import finite_array

LARGEST_FACTOR = 5.0  # from the median; slower is a rest, which a field cannot time


@dataclass(frozen=True, eq=False)
class Pace:
    """The rate of ``z' = -rate(z) z``: what a network says, between bounds above zero."""

    network: RBFRegressor  # of the logarithm of the rate
    slowest: float  # [1 / time]
    fastest: float  # [1 / time]

    def rates(self, points: FloatArray) -> FloatArray:
        """Return the rate (n,) at straightened points (n, d)."""
        return self._bounded(self.network.predict(points))

    def descend(self, points: FloatArray, dt: float, steps: int) -> Iterator[FloatArray]:
        """Yield points (n, d) and where they are after each step: steps + 1 times.

        Runge-Kutta's fourth order in the logarithm of the distance. All four rates are positive,
        so the distance falls in every step, and the direction stays.
        """
        yield finite_array(points, "X")
        rates = self._asked_often()
        for _ in range(steps):
            first = rates(points)
            second = rates(_shrunk(points, 0.5 * dt * first))
            third = rates(_shrunk(points, 0.5 * dt * second))
            fourth = rates(_shrunk(points, dt * third))
            points = _shrunk(points, dt * (first + 2.0 * (second + third) + fourth) / 6.0)
            yield points

    def _asked_often(self) -> Callable[[FloatArray], FloatArray]:
        """Return `rates`, the same to the bit, that looks at no input for what is wrong with it.

        Points that shrink stay finite, and looking takes longer than answering.
        """
        network = self.network
        answers = gaussians(network.centers_, network.width_)
        return lambda points: self._bounded(answers(points) @ network.weights_ + network.bias_)

    def _bounded(self, logarithms: FloatArray) -> FloatArray:
        rates: FloatArray = np.exp(np.clip(logarithms, np.log(self.slowest), np.log(self.fastest)))
        return np.clip(rates, self.slowest, self.fastest)


def learn_pace(points: FloatArray, rates: FloatArray, neurons: int) -> Pace:
    """Return the pace that was seen as rates (n,) at straightened points (n, d).

    Rates are bounded to within `LARGEST_FACTOR` of their median, where the network sees them as
    where it answers; far from all points it answers their geometric mean.
    """
    median = float(np.median(rates))
    slowest, fastest = median / LARGEST_FACTOR, median * LARGEST_FACTOR
    logarithms = np.log(np.clip(rates, slowest, fastest))
    return Pace(RBFRegressor(n_neurons=neurons).fit(points, logarithms), slowest, fastest)


def _shrunk(points: FloatArray, falls: FloatArray) -> FloatArray:
    """Return points (n, d) whose distance's logarithm fell by so much (n,)."""
    shrunk: FloatArray = points * np.exp(-falls)[:, np.newaxis]
    return shrunk
