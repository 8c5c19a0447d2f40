"""A program that is connected: what it subscribed to, what it waits for, how much it sends."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from studio.engine.inbox import Answer
from studio.engine.live.reception import TokenBucket
from studio.engine.remote.outbox import Outbox
from studio.engine.robot import CONTROL_RATE
from studio.remote.asked import Stream

FLOOD = 5_000.0  # messages a second; whoever sends more costs time even unread, and is sent away
FASTEST = 1_000.0  # of them that are answered, joint targets apart
_BURST = 500.0
MOST_UNREADABLE = 20  # messages at once; a few more a second are forgiven
_FORGIVEN = 5.0  # a second
MOST_WAITING = 32  # commands that have not taken effect
COMPLAIN_EVERY = 1.0  # [s] between two errors that answer no request


@dataclass(frozen=True)
class Subscription:
    """A stream at a rate that need not divide that of the ticks: frames are spread over them.

    In n ticks from its beginning there are as many whole periods as frames: never more than were
    asked for, and that rate on average.
    """

    rate: float  # [Hz]
    begun: int  # the tick before its first one

    def is_due(self, tick: int) -> bool:
        """Tell whether a period ends with a tick."""
        return self._periods(tick) > self._periods(tick - 1)

    def _periods(self, tick: int) -> int:
        return math.floor((tick - self.begun) * self.rate / CONTROL_RATE)


@dataclass(eq=False)
class Guest:
    """See the module."""

    name: str  # no other guest has it
    called: str  # by others
    outbox: Outbox
    flood: TokenBucket
    requests: TokenBucket
    unreadable: TokenBucket
    streams: dict[Stream, Subscription] = field(default_factory=dict)
    waiting: int = 0  # commands that have not taken effect
    complained: float | None = None  # [s] when
    answer: Answer | None = None  # to its joint targets
    told: tuple[bool, str, str] | None = None  # the role that it was told last, without times

    @classmethod
    def of(cls, name: str, called: str, wake: Callable[[], None], now: float) -> "Guest":
        """Return one that has just come in at ``now`` [s]."""
        return cls(
            name,
            called,
            Outbox(wake),
            flood=TokenBucket(FLOOD, FLOOD, now),
            requests=TokenBucket(FASTEST, _BURST, now),
            unreadable=TokenBucket(_FORGIVEN, MOST_UNREADABLE, now),
        )

    def may_complain(self, now: float) -> bool:
        """Tell whether it is time for another error that answers no request."""
        if self.complained is not None and now - self.complained < COMPLAIN_EVERY:
            return False
        self.complained = now
        return True
