"""How late a robot's states come, by its own stamps: a network that queues them shows here alone.

The robot's clock and ours share no origin. The quickest message so far tells how far apart they
are at most; how much longer one takes is how late it is. That origin may creep, for clocks run
apart by some ppm, and so slowly that a queue of one second is not forgotten within half an hour.
"""

from dataclasses import dataclass

_CREEP = 5e-4  # [s/s] the fastest that two disciplined clocks run apart: NTP corrects by no more


@dataclass(frozen=True)
class Lateness:
    """The memory from one message to the next."""

    origin: float  # [s] between the two clocks, by the quickest message
    heard: float  # [s] when the last message came, by our clock
    late: float = 0.0  # [s] that it took longer than the quickest one


def lateness(before: Lateness | None, stamp: float | None, heard: float) -> Lateness | None:
    """Return how late a message with this ``stamp`` [s] was that was ``heard`` [s] now."""
    if stamp is None:  # tells nothing, and makes nothing forgotten
        return before
    apart = heard - stamp
    if before is None:
        return Lateness(apart, heard)
    origin = min(apart, before.origin + _CREEP * max(heard - before.heard, 0.0))
    return Lateness(origin, heard, apart - origin)
