"""Wanted angles inside the position limits: the shoulder clamped, the elbow solved anew for it.

On real recordings 37 % of arm frames hang lower than Baxter's s1 allows. Clamping alone throws
the forearm off; solving e0 and e1 for the clamped shoulder keeps it close to the person's.
"""

import math
from dataclasses import dataclass

from studio.engine.retarget import Angles, Mapping, solve_arm, solve_elbow
from studio.engine.skeleton import Side
from studio.engine.vectors import Vector, angle_between

STRAIGHT = math.radians(15)  # of flexion, below which e0 is noise and is held
PAST_BEFORE_CHANGE = math.radians(60)  # beyond 180° before e0 unwinds to the other side ...
CHANGE_AFTER = 0.5  # ... and for how long [s]


@dataclass(frozen=True)
class ReachMemory:
    """The side of ±180° on which e0 is, and since when it wants to be on the other."""

    e0: float = 0.0  # [rad], unwrapped: may lie beyond ±π while waving about it
    past_since: float | None = None  # [s]


@dataclass(frozen=True)
class Reach:
    """Settings: the position limits [rad] of s0, s1, e0, e1; `step` does the work."""

    side: Side
    mapping: Mapping
    lower: Angles
    upper: Angles

    def step(
        self, memory: ReachMemory | None, upper_arm: Vector, forearm: Vector, time: float
    ) -> tuple[ReachMemory, Angles]:
        """Return the wanted angles [rad] inside the limits for a smoothed arm at ``time`` [s]."""
        s0, s1, e0, e1 = solve_arm(upper_arm, forearm, self.side, self.mapping)
        reached = (self._clamp(0, s0), self._clamp(1, s1))
        if self.mapping == "paper":
            return ReachMemory(), (*reached, 0.0, self._clamp(3, e1))
        if reached != (s0, s1):
            elbow = solve_elbow(forearm, self.side, *reached)
            e0, e1 = elbow if elbow is not None else (e0, 0.0)
        if memory is not None and angle_between(upper_arm, forearm) < STRAIGHT:
            e0 = memory.e0
        memory = _follow_roll(memory, e0, time)
        return memory, (*reached, self._clamp(2, memory.e0), self._clamp(3, e1))

    def _clamp(self, index: int, angle: float) -> float:
        return min(max(angle, self.lower[index]), self.upper[index])


def _follow_roll(memory: ReachMemory | None, e0: float, time: float) -> ReachMemory:
    """Keep e0 on its side of ±180° until it has been well past it for a while.

    A naive clamp turns the forearm by almost a full turn whenever e0 crosses ±180°, which a
    forearm held straight up does all the time.
    """
    if memory is None:
        return ReachMemory(e0)
    turns = round((memory.e0 - e0) / (2.0 * math.pi))
    unwrapped = e0 + 2.0 * math.pi * turns
    if abs(unwrapped) <= math.pi + PAST_BEFORE_CHANGE:
        return ReachMemory(unwrapped)
    since = time if memory.past_since is None else memory.past_since
    if time - since < CHANGE_AFTER:
        return ReachMemory(unwrapped, since)
    return ReachMemory(math.remainder(unwrapped, 2.0 * math.pi))
