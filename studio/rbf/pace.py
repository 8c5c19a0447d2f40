"""How fast a straightened line is walked: a positive rate, learned where demonstrations went."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from studio.rbf.basis import FloatArray
from studio.rbf.regressor import RBFRegressor

LARGEST_FACTOR = 5.0  # from the median; slower is a rest, which a field cannot time


@dataclass(frozen=True, eq=False)
class Pace:
    """The rate of ``z' = -rate(z) z``: what a network says, between bounds above zero."""

    network: RBFRegressor  # of the logarithm of the rate
    slowest: float  # [1 / time]
    fastest: float  # [1 / time]

    def rates(self, points: FloatArray) -> FloatArray:
        """Return the rate (n,) at straightened points (n, d)."""
        logarithms = self.network.predict(points)
        rates: FloatArray = np.exp(np.clip(logarithms, np.log(self.slowest), np.log(self.fastest)))
        return np.clip(rates, self.slowest, self.fastest)

    def descend(self, points: FloatArray, dt: float, steps: int) -> Iterator[FloatArray]:
        """Yield points (n, d) and where they are after each step: steps + 1 times.

        Runge-Kutta's fourth order in the logarithm of the distance. All four rates are positive,
        so the distance falls in every step, and the direction stays.
        """
        yield points
        for _ in range(steps):
            first = self.rates(points)
            second = self.rates(_shrunk(points, 0.5 * dt * first))
            third = self.rates(_shrunk(points, 0.5 * dt * second))
            fourth = self.rates(_shrunk(points, dt * third))
            points = _shrunk(points, dt * (first + 2.0 * (second + third) + fourth) / 6.0)
            yield points


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
