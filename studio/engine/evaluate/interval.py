"""How sure a rate is, and whether two rates of the same trials differ."""

import math
from dataclasses import dataclass
from fractions import Fraction

NORMAL_95 = 1.959963984540054  # the standard normal distribution's 97.5 % point


@dataclass(frozen=True)
class Rate:
    """A success rate with its 95 % confidence interval."""

    successes: int
    trials: int
    low: float
    high: float

    @property
    def value(self) -> float:
        """The rate itself, 0 to 1; 0 of no trials."""
        return self.successes / self.trials if self.trials else 0.0

    @property
    def words(self) -> str:
        """As one says it: ``87 % (79 to 92 %), 87 of 100``."""
        percent = f"{100 * self.value:.3g} % ({100 * self.low:.3g} to {100 * self.high:.3g} %)"
        return f"{percent}, {self.successes} of {self.trials}"


def rate_of(successes: int, trials: int) -> Rate:
    """Return a rate with its interval; of no trials it may be anything from 0 to 1."""
    return Rate(successes, trials, *wilson(float(successes), trials))


def wilson(successes: float, trials: int) -> tuple[float, float]:
    """Return the 95 % score interval of a rate (Wilson 1927, JASA 22:209, its Eq. for p).

    The rates that a score test with ``trials`` trials would not reject. It keeps to 0 and 1, and
    says something where nothing, or all, succeeded, which the usual rate ± 1.96 sigma does not.
    """
    if trials == 0:
        return 0.0, 1.0
    rate, square = successes / trials, NORMAL_95**2
    middle = rate + square / (2.0 * trials)
    reach = NORMAL_95 * math.sqrt(rate * (1.0 - rate) / trials + square / (4.0 * trials**2))
    scale = 1.0 + square / trials
    low = 0.0 if successes == 0 else max(0.0, (middle - reach) / scale)
    high = 1.0 if successes == trials else min(1.0, (middle + reach) / scale)
    return low, high


def mcnemar(only_one: int, only_other: int) -> float:
    """Return how likely a difference as large as this is by chance alone, both ways.

    The exact test of McNemar (1947, Psychometrika 12:153): of the same trials, those in which only
    the one or only the other succeeded would fall evenly if the two were equally good.
    """
    differing = only_one + only_other
    ways = sum(math.comb(differing, k) for k in range(min(only_one, only_other) + 1))
    return min(1.0, float(2 * Fraction(ways, 2**differing)))  # of whole numbers: floats overflow
