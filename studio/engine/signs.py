"""One hand over time: how long a sign has been observed, and since when the hand is lost.

A frame's state is taken to last until the next frame, for `LONGEST_SIGHT` at most, so that a hold
is the same at 15, 30 and 60 Hz and a stalled sensor adds next to nothing. Unknown and NotTracked
mean "hold what you knew", for a bounded time; they never mean Open. Times are whole nanoseconds:
holds are multiples of 1/30 s, and floats compare wrongly on half of them.
"""

from dataclasses import dataclass, replace

from studio.engine.skeleton import HandState

UNSEEN = (HandState.UNKNOWN, HandState.NOT_TRACKED)
NANOSECONDS = 1_000_000_000
LONGEST_SIGHT = NANOSECONDS // 10
_ROUNDING = 1_000  # [ns]: a hold adds up intervals that were each rounded to a nanosecond


def nanoseconds(seconds: float) -> int:
    """Return seconds as whole nanoseconds."""
    return round(seconds * NANOSECONDS)


@dataclass(frozen=True)
class HandMemory:
    """What is known of a hand; times in nanoseconds."""

    time: int = 0  # of the newest frame
    state: HandState = HandState.UNKNOWN  # in it
    confidence: float = 1.0  # in it
    sign: HandState | None = None  # the one seen now, or seen last before the hand was lost
    held: int = 0  # for how long the sign has been observed, up to the newest frame
    lost_since: int | None = None  # start of the unbroken run of Unknown and NotTracked

    def seen_until(self, now: int) -> int:
        """Return until when the newest frame's state is taken to last."""
        return min(now, self.time + LONGEST_SIGHT)

    def lost_for(self, now: int) -> int:
        """Return for how long the hand has been lost; 0 where it is seen."""
        return 0 if self.lost_since is None else now - self.lost_since

    def held_by(self, now: int) -> int:
        """Return for how long the sign has been observed when another frame comes now."""
        if self.sign is None or self.state is not self.sign:
            return self.held
        return self.held + max(self.seen_until(now) - self.time, 0)

    def forgotten(self, now: int, longest_gap: int) -> "HandMemory":
        """Return the memory without its sign where the hand has been lost for too long."""
        if self.sign is None or self.lost_for(now) <= longest_gap:
            return self
        return replace(self, sign=None, held=0)

    def showing(self, state: HandState, confidence: float, now: int) -> "HandMemory":
        """Return the memory with another frame in it, a sign or one of UNSEEN."""
        if state in UNSEEN:
            lost_since = now if self.lost_since is None else self.lost_since
            return HandMemory(now, state, confidence, self.sign, self.held_by(now), lost_since)
        held = self.held_by(now) if state is self.sign else 0
        return HandMemory(now, state, confidence, state, held)


def lasts(held: int, needed: int) -> bool:
    """Return whether a hold [ns] is long enough."""
    return held >= needed - _ROUNDING


def reaches(before: int, after: int, needed: int) -> bool:
    """Return whether a hold that grows from ``before`` to ``after`` [ns] becomes long enough."""
    return lasts(after, needed) and not lasts(before, needed)
