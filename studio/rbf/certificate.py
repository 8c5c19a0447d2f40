"""Why a field arrives: the numbers that its proof of convergence stands on."""

import math
from dataclasses import dataclass
from typing import Self

from studio.rbf.diffeomorphism import Diffeomorphism
from studio.rbf.pace import Pace

LIMIT = 1.0  # of the steepness; see `studio.rbf.diffeomorphism`


@dataclass(frozen=True)
class Certificate:
    """What was checked so that the proof of convergence holds, and what it gives.

    The proof. The field is ``x' = J(z) (-rate(z) z)`` where ``x = goal + map(z)``, ``map(0) = 0``
    and J is the Jacobian of ``map``. With `steepness` below 1 the map is a diffeomorphism of the
    whole space, so ``V(x) = ||z||^2`` is smooth, zero at the goal alone, and grows without bound
    away from it. Along the field ``z' = -rate(z) z``, so ``V' = -2 rate(z) V``, and the rate is
    never below `slowest_rate`: V falls at least as ``exp(-2 slowest_rate t)`` from every start.

    Examples
    --------
    >>> Certificate(steepness=0.5, slowest_rate=0.1, fastest_rate=2.0).holds
    True
    >>> print(Certificate(steepness=1.5, slowest_rate=0.1, fastest_rate=2.0))
    global convergence DOES NOT HOLD: steepness 1.500 (below 1), rate 0.1 to 2 (above 0)

    """

    steepness: float  # largest ||v|| / (sigma sqrt(e)) of all translations
    slowest_rate: float  # [1 / time] the least that the rate can be anywhere
    fastest_rate: float  # [1 / time] the most

    @classmethod
    def of(cls, chain: Diffeomorphism, pace: Pace) -> Self:
        """Return the certificate of a field made of this map and this pace."""
        return cls(float(chain.steepness.max()), pace.slowest, pace.fastest)

    @property
    def holds(self) -> bool:
        """Whether the field converges to its goal from every start."""
        folds_nowhere = 0.0 <= self.steepness < LIMIT
        return folds_nowhere and 0.0 < self.slowest_rate <= self.fastest_rate < math.inf

    def __str__(self) -> str:
        verdict = "holds" if self.holds else "DOES NOT HOLD"
        return (
            f"global convergence {verdict}: steepness {self.steepness:.3f} (below {LIMIT:g}), "
            f"rate {self.slowest_rate:.3g} to {self.fastest_rate:.3g} (above 0)"
        )
