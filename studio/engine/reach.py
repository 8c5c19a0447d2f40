"""Wanted angles inside the position limits: the shoulder clamped, the elbow solved anew for it.

On real recordings 37 % of arm frames hang lower than Baxter's s1 allows. Clamping alone throws
the forearm off; solving e0 and e1 for the clamped shoulder keeps it close to the person's.
"""

import math
from dataclasses import dataclass

from studio.engine.retarget import DRIVEN_JOINTS, Angles, Mapping, solve_arm, solve_elbow
from studio.engine.robot import Robot
from studio.engine.skeleton import FloatArray, Side
from studio.engine.vectors import Vector, turn_between

STRAIGHT = math.radians(15)  # of flexion, below which e0 is noise and is held
PAST_BEFORE_CHANGE = math.radians(60)  # beyond 180° before e0 unwinds to the other side ...
CHANGE_AFTER = 0.5  # ... and for how long [s]
# s0 turns about the vertical, so it says less and less as the upper arm nears it: its rate is
# TURN_RATE · min(1, h / LEVEL)², with h the length of the upper arm's shadow on the floor.
TURN_RATE = 1.5  # [rad/s], the joint's own limit
LEVEL = 0.35


@dataclass(frozen=True)
class ReachMemory:
    """Where s0 was and when, on which side of ±180° e0 is, and since when it wants to the other."""

    time: float  # [s]
    s0: float  # [rad], inside the limits
    e0: float = 0.0  # [rad], unwrapped: may lie beyond ±π while waving about it
    past_since: float | None = None  # [s]


@dataclass(frozen=True)
class Reach:
    """Settings: the position limits [rad] of s0, s1, e0, e1; `step` does the work."""

    side: Side
    mapping: Mapping
    lower: Angles
    upper: Angles

    @classmethod
    def for_robot(cls, robot: Robot, side: Side, mapping: Mapping) -> "Reach":
        """Return the stage for one arm of ``robot``."""
        limits = robot.limits_of([f"{side}_{joint}" for joint in DRIVEN_JOINTS])
        return cls(side, mapping, as_angles(limits.lower), as_angles(limits.upper))

    def step(
        self, memory: ReachMemory | None, upper_arm: Vector, forearm: Vector, time: float
    ) -> tuple[ReachMemory, Angles]:
        """Return the wanted angles [rad] inside the limits for a smoothed arm at ``time`` [s]."""
        s0, s1, e0, e1 = solve_arm(upper_arm, forearm, self.side, self.mapping)
        turned = self._turn(memory, self._clamp(0, s0), math.cos(s1), time)
        reached = (turned, self._clamp(1, s1))
        if self.mapping == "paper":
            return ReachMemory(time, turned), (*reached, 0.0, self._clamp(3, e1))
        if reached != (s0, s1):
            elbow = solve_elbow(forearm, self.side, *reached)
            e0, e1 = elbow if elbow is not None else (e0, 0.0)
        if memory is not None and turn_between(upper_arm, forearm) < STRAIGHT:
            e0 = memory.e0
        roll, past_since = _follow_roll(memory, e0, time)
        memory = ReachMemory(time, turned, roll, past_since)
        return memory, (*reached, self._clamp(2, roll), self._clamp(3, e1))

    def _turn(self, memory: ReachMemory | None, s0: float, shadow: float, time: float) -> float:
        """Return s0 as near to where it should be as its rate allows."""
        if memory is None:
            return s0
        rate = TURN_RATE * min(1.0, shadow / LEVEL) ** 2
        furthest = rate * (time - memory.time)
        return min(max(s0, memory.s0 - furthest), memory.s0 + furthest)

    def _clamp(self, index: int, angle: float) -> float:
        return min(max(angle, self.lower[index]), self.upper[index])


def _follow_roll(memory: ReachMemory | None, e0: float, time: float) -> tuple[float, float | None]:
    """Keep e0 on its side of ±180° until it has been well past it for a while.

    A naive clamp turns the forearm by almost a full turn whenever e0 crosses ±180°, which a
    forearm held straight up does all the time. Returns e0 unwrapped, and since when it is past.
    """
    if memory is None:
        return e0, None
    turns = round((memory.e0 - e0) / (2.0 * math.pi))
    unwrapped = e0 + 2.0 * math.pi * turns
    if abs(unwrapped) <= math.pi + PAST_BEFORE_CHANGE:
        return unwrapped, None
    since = time if memory.past_since is None else memory.past_since
    if time - since < CHANGE_AFTER:
        return unwrapped, since
    return math.remainder(unwrapped, 2.0 * math.pi), None


def as_angles(values: FloatArray) -> Angles:
    """Return four numbers as `Angles`."""
    s0, s1, e0, e1 = values.tolist()
    return (s0, s1, e0, e1)
