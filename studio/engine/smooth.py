"""Smoothing of directions: a One-Euro filter on unit vectors, never on angles, which wrap.

Reference: Casiez, Roussel, Vogel, "1 € Filter", CHI 2012. The cutoff grows with the direction's
angular speed, so that a still arm does not shake and a moving one does not lag.
"""

import math
from dataclasses import dataclass

from studio.engine.vectors import Vector, angle_between, blend, unit

SHORTEST_STEP = 1 / 120  # [s]; a burst of stamps must not turn noise into speed


@dataclass(frozen=True)
class OneEuroMemory:
    """What the filter knows since it last accepted a direction."""

    time: float  # [s]
    direction: Vector
    speed: float  # [rad/s], itself smoothed


@dataclass(frozen=True)
class OneEuro:
    """Settings of the filter; `step` does the work."""

    min_cutoff: float  # [Hz] at rest
    beta: float  # [Hz per rad/s]
    derivative_cutoff: float = 1.0  # [Hz]
    fastest: float = 25.0  # [rad/s]; faster is an outlier (12 would reject real motion)
    patience: float = 0.1  # [s] for which outliers are rejected; after that they are the truth

    def step(
        self, memory: OneEuroMemory | None, direction: Vector, time: float
    ) -> tuple[OneEuroMemory, Vector]:
        """Take a unit vector at ``time`` [s]; return the memory to keep and the smoothed vector.

        Reset is ``memory = None``. Time must not run backwards; equal times count as
        `SHORTEST_STEP`.
        """
        if memory is None:
            return OneEuroMemory(time, direction, 0.0), direction
        elapsed = max(time - memory.time, SHORTEST_STEP)
        speed = angle_between(memory.direction, direction) / elapsed
        if speed > self.fastest and elapsed <= self.patience:
            return memory, memory.direction
        speed = memory.speed + _weight(self.derivative_cutoff, elapsed) * (speed - memory.speed)
        weight = _weight(self.min_cutoff + self.beta * speed, elapsed)
        # Opposite directions may blend to nothing; the new one is then as good as any.
        smoothed = unit(blend(memory.direction, direction, weight)) or direction
        return OneEuroMemory(time, smoothed, speed), smoothed


def _weight(cutoff: float, elapsed: float) -> float:
    """Return how much of the news a first-order low-pass lets through in ``elapsed`` seconds."""
    return 1.0 / (1.0 + 1.0 / (2.0 * math.pi * cutoff * elapsed))
