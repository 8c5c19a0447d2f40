"""Soft engagement: on arming the robot comes to the person, slowly at first, never in a jump.

Users of such systems complain of a violent first move. So the robot starts at `slow`, keeps to it
for `slow_for` whatever happens, and then gains speed, by `rise` each second and more as the gap
closes, until it has caught up. All joints go the same share of their way, in a straight line.

What has been held off by the guard for `LONGEST_HOLD` comes anew: a robot that could not follow
must not leap when it can again. Only a gap that is really small ends an engagement, no time does.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

Joints = tuple[float, ...]  # (D,) [rad]

COMING = "coming to you"  # the reason while the robot is on its way
ARRIVED_WITHIN = 0.05  # [rad] of the largest joint's gap: 3°, which nobody sees as a jump
# Held off is what the guard leaves further behind than this, and slower than `Engage.slow`: an arm
# that slides along a desk a little above the person's goes on following.
HELD_OFF_BEYOND = 0.1  # [rad]
LONGEST_HOLD = 0.5  # [s] of it, after which the robot engages anew
# What was unseen for longer is engaged anew as well: the person may be anywhere by then.
LONG_UNSEEN = 0.5  # [s]
_ROUNDING = 1e-9  # [rad] in which what was sent differs from what was asked, for no guard's sake


@dataclass(frozen=True)
class EngageMemory:
    """Since when the robot has been coming, and how far it has got."""

    since: float  # [s]
    arrived: bool = False  # it has been where the person is: from here on it follows
    released: bool = False  # no cap on its speed any more
    held_off_since: float | None = None  # [s] None while nothing holds it off


@dataclass(frozen=True)
class Move:
    """Where the joints of an arm, or of a wrist, go in one tick."""

    engaged: EngageMemory | None  # None where they have nobody to follow
    wanted: Joints | None  # [rad]
    target: Joints  # [rad] on the way there


class Passed(NamedTuple):
    """What the guard made of a move, [rad]."""

    before: Joints  # as sent a tick ago
    asked: Joints  # of the guard
    sent: Joints


@dataclass(frozen=True)
class Engage:
    """Settings; `step` does the work."""

    slow: float = 0.3  # [rad/s] of the fastest joint, to begin with
    slow_for: float = 1.0  # [s]
    rise: float = 0.3  # [rad/s²] after that
    near: float = 0.3  # [rad] of gap, within which the cap rises to `full` as the gap closes
    full: float = 1.5  # [rad/s] Baxter's slowest top speed, to which the cap rises at most

    def step(
        self, memory: EngageMemory | None, sent: Joints, wanted: Joints, time: float, elapsed: float
    ) -> tuple[EngageMemory, Joints]:
        """Return the target [rad] on the way from ``sent`` to ``wanted`` for this tick.

        ``time`` [s] is now, ``elapsed`` [s] the time since ``sent``. With ``memory = None`` the
        engagement begins.
        """
        memory = memory or EngageMemory(time)
        if memory.released:
            return memory, wanted
        gap = largest(sent, wanted)
        is_near, since = gap < ARRIVED_WITHIN, time - memory.since
        if is_near and since >= self.slow_for:
            return replace(memory, arrived=True, released=True), wanted
        memory = replace(memory, arrived=memory.arrived or is_near)
        way = self._cap(since, gap) * elapsed
        share = way / gap if gap > way else 1.0
        return memory, tuple(at + share * (to - at) for at, to in zip(sent, wanted, strict=True))

    def after(self, move: Move, passed: Passed, time: float, elapsed: float) -> EngageMemory | None:
        """Take note of what the guard made of a move; what was held off for long engages anew."""
        memory, wanted = move.engaged, move.wanted
        if memory is None or wanted is None:
            return memory
        is_guarded = largest(passed.asked, passed.sent) > _ROUNDING
        is_still = largest(passed.before, passed.sent) < self.slow * elapsed
        if not (is_guarded and is_still and largest(passed.sent, wanted) > HELD_OFF_BEYOND):
            return replace(memory, held_off_since=None)
        since = time if memory.held_off_since is None else memory.held_off_since
        if time - since > LONGEST_HOLD:
            return EngageMemory(time, held_off_since=since)
        return replace(memory, held_off_since=since)

    def _cap(self, since: float, gap: float) -> float:
        """Return the speed [rad/s] that the fastest joint may have."""
        if since < self.slow_for:
            return self.slow
        by_time = self.slow + self.rise * (since - self.slow_for)
        closeness = max(1.0 - gap / self.near, 0.0)
        return min(max(by_time, self.slow + (self.full - self.slow) * closeness), self.full)


def largest(one: Joints, other: Joints) -> float:
    """Return the largest joint's gap [rad] between two poses."""
    return max(abs(there - here) for here, there in zip(one, other, strict=True))
