"""A sensor's stamps, moved onto the session's ticks, so that no publisher can falsify time.

Gate and limits count ticks alone. The filters need to know how much time lies between two frames,
which only the sensor can tell; what it says is believed within the tick in which the frame was
taken, and no further. Hence a stalled, bursting or restarted publisher, or one whose stamps are
made up, changes the filters' view of time by less than one tick; and since every frame stays in
its tick, a recording of a live run gives the same commands when it is followed again.
"""

from dataclasses import dataclass

from studio.engine.robot import CONTROL_PERIOD

_EARLIEST = 0.99 * CONTROL_PERIOD  # [s] before the tick: at a whole period it would be the last one
_CLOSEST = CONTROL_PERIOD / 4  # [s] between two frames of two ticks


@dataclass(frozen=True)
class Rebased:
    """The last frame: which stream it was of, the stamp it had and the time it was given [s]."""

    stream: int
    stamp: float
    time: float


def rebase(last: Rebased | None, stream: int, stamp: float, tick: float) -> Rebased:
    """Return where a frame taken at the time ``tick`` [s] belongs among the ticks.

    Parameters
    ----------
    last : Rebased or None
        The frame before, taken at least one tick ago; None at the beginning.
    stream : int
        Counts the streams: of another one, the stamps have another origin.
    stamp : float
        The sensor's own time [s]; more than the last one's of the same stream.
    tick : float
        The session's time [s].
    """
    if last is None or last.stream != stream:
        return Rebased(stream, stamp, tick)
    earliest = max(tick - _EARLIEST, last.time + _CLOSEST)
    # From frame to frame, not from the stream's first one: a clock that runs fast or slow then
    # meets a bound again and again instead of for good.
    time = last.time + (stamp - last.stamp)
    return Rebased(stream, stamp, min(max(time, earliest), tick))
