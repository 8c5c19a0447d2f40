"""What a live stream tells of itself: immutable, for snapshots and for the command line."""

from dataclasses import dataclass

from studio.engine.live.latency import LatencyChain

_UNMEASURED = LatencyChain()


@dataclass(frozen=True)
class Counts:
    """Where all messages have gone: ``received`` is the sum of the others, and of one pending.

    The pending one is the newest frame, until a tick takes it.
    """

    received: int = 0
    used: int = 0  # taken by a tick
    dropped: int = 0  # a newer frame came before a tick took them
    late: int = 0  # not newer than the frame before
    others: int = 0  # show somebody else alone, while the followed person is in sight
    waiting: int = 0  # of publishers that do not drive
    too_fast: int = 0  # above the rate that is taken, hence not read
    unreadable: int = 0


@dataclass(frozen=True)
class LiveStatus:
    """A live stream at this moment."""

    address: str = ""  # where to send to; empty where nothing listens
    publishers: int = 0  # that are connected
    driver: str = ""  # the one whose frames are taken; empty where nobody's are
    protocol: str = ""  # the driver's
    stream: int = 0  # how many streams there were; each begins with another driver or clock
    rate: float = 0.0  # [Hz] of the frames accepted of late
    age: float | None = None  # [s] of the newest frame
    tells_hands: bool = True  # whether it tells hand states, as far as was seen yet
    bodies: tuple[str, ...] = ()  # ids of all who were in sight of late
    followed: str | None = None  # the one of them whose frames are taken
    counts: Counts = Counts()
    latency: LatencyChain = _UNMEASURED

    @property
    def is_flowing(self) -> bool:
        """Whether frames come in right now."""
        return bool(self.driver) and self.rate > 0.0


def in_short(live: LiveStatus) -> str:
    """Return in words who sends, or what to do so that somebody does."""
    if live.is_flowing:
        return f"{live.driver} drives with {live.protocol}, {live.rate:.0f} frames a second."
    if live.driver:
        return f"{live.driver} has stopped sending: start its sensor again, or another one."
    if live.publishers:
        return "A publisher is connected, and has not sent a frame yet."
    where = live.address or "the studio's address for live streams"
    return (
        f"Nobody sends yet: let a sensor's program send to {where}, or try "
        f"studio play FILE --to {where}"
    )
