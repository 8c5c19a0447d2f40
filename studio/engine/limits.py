"""The last stage before any robot: no command ever passes a joint's position or velocity limit."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from studio.engine.errors import StudioError
from studio.engine.skeleton import FloatArray

_WITHIN = 1.0 - 1e-9  # of the limit: rounding must not carry a step over it


@dataclass(frozen=True, eq=False)
class Command:
    """What is sent to the robot, and which limits it met on the way."""

    sent: FloatArray  # (D,) [rad]
    position_limited: NDArray[np.bool_]  # (D,)
    velocity_limited: NDArray[np.bool_]  # (D,)
    guarded: str = ""  # what the collision guard keeps apart, in words
    stopped: bool = False  # they are so near that the guard lets them come no nearer
    resting: str = ""  # the same in words, if that is what an arm does that just hangs

    def of_first(self, count: int) -> "Command":
        """Return the command of the first joints alone."""
        return replace(
            self,
            sent=self.sent[:count],
            position_limited=self.position_limited[:count],
            velocity_limited=self.velocity_limited[:count],
        )

    @property
    def limited(self) -> bool:
        """Whether any limit bit."""
        return bool(self.position_limited.any() or self.velocity_limited.any())


@dataclass(frozen=True, eq=False)
class Limits:
    """Position limits [rad] and velocity limits [rad/s] of D joints; `step` does the work."""

    lower: FloatArray  # (D,)
    upper: FloatArray  # (D,)
    velocity: FloatArray  # (D,)

    def step(self, sent: FloatArray, wanted: ArrayLike, elapsed: float) -> Command:
        """Return the command nearest to ``wanted`` (D,) [rad] that the limits allow.

        ``sent`` (D,) is the previous command, inside the limits, ``elapsed`` [s] the time since it.

        Raises
        ------
        StudioError
            Where a wanted angle is not finite, or the shape or the elapsed time is wrong: numpy's
            clip would let NaN through.
        """
        target = np.asarray(wanted, dtype=float)
        if target.shape != self.lower.shape or not np.isfinite(target).all():
            raise StudioError(f"a command needs {self.lower.size} finite angles, not {wanted!r}")
        if not elapsed > 0.0:
            raise StudioError(f"a command needs a time step above zero, not {elapsed!r} s")
        inside = _clipped(target, self.lower, self.upper)
        furthest = self.velocity * elapsed * _WITHIN
        # The sum may round past a position limit that the previous command sat on: clip once more.
        way = inside - sent
        moved = _clipped(sent + _clipped(way, -furthest, furthest), self.lower, self.upper)
        return Command(moved, inside != target, np.abs(way) > furthest)


def _clipped(values: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Return what np.clip returns for finite values, for a third of its price."""
    inside: FloatArray = np.minimum(np.maximum(values, lower), upper)
    return inside
