"""The live source: publishers put frames in, the session takes the newest one at every tick.

Any thread may call anything here. Nothing waits for anything but a lock that is held for
microseconds, so that no publisher holds up the session.
"""

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace

from studio.engine.errors import StudioError
from studio.engine.live.latency import Delays, LatencyChain
from studio.engine.live.status import Counts, LiveStatus
from studio.engine.skeleton import SIDES, HandState, Skeleton
from studio.engine.sources.family import MAXIMUM_ID_LENGTH, Frame
from studio.engine.sources.following import Following, choose_body

RESTARTED = 1.0  # [s]; stamps that run back by more are those of a clock begun anew
_RATE_OVER = 30  # frames
_IN_SIGHT = 1.0  # [s] for which somebody who is missing from frames still is among the bodies
_SILENT = 2.0  # [s] without a frame, after which the rate is nothing
_ENOUGH = 90  # frames of somebody, after which a stream without hand states tells none


@dataclass(frozen=True, eq=False)
class Taken:
    """What a tick takes: the followed person in the newest frame."""

    skeleton: Skeleton | None  # None: nobody is in it; its time is the sensor's
    stream: int
    arrival: float  # [s] of the clock that the source was given


class LiveSource:
    """See the module.

    Parameters
    ----------
    now : callable
        The time [s], by a clock that never runs back.
    on_frame : callable, optional
        Called with the number of the stream, every accepted frame and its arrival, in the
        publishers' thread.
    """

    def __init__(
        self,
        now: Callable[[], float],
        on_frame: Callable[[int, Frame, float], None] | None = None,
    ) -> None:
        self.now = now
        self._on_frame = on_frame
        self._lock = threading.Lock()
        self._status = LiveStatus()
        self._counts: dict[str, int] = dict.fromkeys(Counts.__dataclass_fields__, 0)
        self._newest: Taken | None = None
        self.fresh = threading.Event()  # set while no tick has taken the newest frame
        self._stamp: float | None = None  # of the newest frame [s]
        self._following: Following | None = None
        self._seen: dict[str, float] = {}  # when each body was in a frame last [s]
        self._arrivals: deque[float] = deque(maxlen=_RATE_OVER)
        self._bodies, self._hands = 0, False  # of this stream: how many, any state
        self._on_its_way: tuple[float, float] | None = None  # arrived, taken [s]
        self._transit, self._waiting = Delays(), Delays()
        self._computing, self._total, self._limiting = Delays(), Delays(), Delays()

    # What the listener says.

    def connect(self, address: str, publishers: int) -> None:
        """Say where the listener listens, and how many publishers are connected."""
        with self._lock:
            self._status = replace(self._status, address=address, publishers=publishers)

    def drive(self, driver: str, protocol: str) -> None:
        """Begin the stream of another driver; nothing of the last one's is taken any more."""
        with self._lock:
            self._status = replace(self._status, driver=driver, protocol=protocol)
            self._begin()

    def leave(self) -> None:
        """End the stream: its driver is gone."""
        with self._lock:
            self._status = replace(self._status, driver="", protocol="")
            self._arrivals.clear()
            self._drop_pending()

    def count(self, what: str) -> None:
        """Count one message that was received and is no frame to be taken: a name of `Counts`."""
        with self._lock:
            self._counts["received"] += 1
            self._counts[what] += 1

    def put(self, frame: Frame, arrival: float, is_stamped: bool) -> str:
        """Take in the driver's frame that came at ``arrival`` [s]; return why not, or nothing."""
        with self._lock:
            self._counts["received"] += 1
            behind = None if self._stamp is None else self._stamp - frame.time
            if behind is not None and 0.0 <= behind <= RESTARTED:
                self._counts["late"] += 1
                return (
                    f"late: its time, {frame.time!r} s, is not after that of the frame before, "
                    f"{self._stamp!r} s"
                )
            if behind is not None and behind > 0.0:
                self._begin()
            self._stamp = frame.time
            self._arrivals.append(arrival)
            if is_stamped:
                self._transit.add(arrival - frame.time)
            stream = self._status.stream
            self._show(frame, arrival)
        if self._on_frame is not None:
            self._on_frame(stream, frame, arrival)
        return ""

    # What the session asks.

    def take(self) -> Taken | None:
        """Return the newest frame, or None where no new one has come since the last call."""
        with self._lock:
            self._on_its_way = None
            if not self.fresh.is_set() or self._newest is None:
                return None
            self.fresh.clear()
            self._counts["used"] += 1
            now = self.now()
            self._waiting.add(now - self._newest.arrival)
            self._on_its_way = self._newest.arrival, now
            return self._newest

    def follow(self, body: str | None) -> None:
        """Follow one of those in sight from now on, for as long as it is there; None: the nearest.

        Raises
        ------
        StudioError
            Where nobody of that id is in sight.
        """
        with self._lock:
            if body is None:
                self._following = None
            elif body in self._in_sight(self.now()):
                self._following = Following(body, self._seen[body])
            else:
                raise StudioError(f"Body {body} is not in sight any more: choose another one")

    def command_given(self, limiting: float | None) -> None:
        """Take note that a tick has given its command, and how far the limiter is behind [s]."""
        with self._lock:
            if self._on_its_way is not None:
                (arrival, taken), now = self._on_its_way, self.now()
                self._computing.add(now - taken)
                self._total.add(now - arrival)
                self._on_its_way = None
            if limiting is not None:
                self._limiting.add(limiting)

    def status(self) -> LiveStatus:
        """Return how things stand."""
        with self._lock:
            now = self.now()
            return replace(
                self._status,
                rate=self._rate(now),
                age=None if self._newest is None else now - self._newest.arrival,
                tells_hands=self._hands or self._bodies < _ENOUGH,
                bodies=self._in_sight(now),
                followed=None if self._following is None else self._following.body_id,
                counts=Counts(**self._counts),
                latency=LatencyChain(
                    self._transit.spread(above_least=True),
                    self._waiting.spread(),
                    self._computing.spread(),
                    self._total.spread(),
                    self._limiting.spread(),
                ),
            )

    # With the lock held.

    def _begin(self) -> None:
        """Begin another stream: another person as far as the gate is concerned."""
        self._drop_pending()
        self._status = replace(self._status, stream=self._status.stream + 1)
        self._stamp = self._following = None
        self._bodies, self._hands = 0, False
        self._seen.clear()
        self._arrivals.clear()
        self._transit.clear()

    def _drop_pending(self) -> None:
        if self.fresh.is_set():
            self._counts["dropped"] += 1
            self.fresh.clear()

    def _show(self, frame: Frame, arrival: float) -> None:
        """Let the followed person in the frame be what the next tick takes."""
        self._seen = {body: at for body, at in self._seen.items() if arrival - at <= _IN_SIGHT}
        self._seen |= {skeleton.body_id: arrival for skeleton in frame.bodies}
        # The wait for a missing person goes by the time here, not by what a publisher says.
        self._following, skeleton = choose_body(self._following, Frame(arrival, frame.bodies))
        if skeleton is None and frame.bodies:
            self._counts["others"] += 1
            return
        self._drop_pending()
        stream = self._status.stream
        if skeleton is not None:
            self._note_hands(skeleton)
            # Another stream's person is another one, even under the same id: so the gate closes.
            skeleton = replace(skeleton, body_id=_named(stream, skeleton.body_id))
        self._newest = Taken(skeleton, stream, arrival)
        self.fresh.set()

    def _note_hands(self, skeleton: Skeleton) -> None:
        states = (skeleton.hand(side).state for side in SIDES)
        self._bodies += 1
        self._hands = self._hands or any(state is not HandState.UNKNOWN for state in states)

    def _in_sight(self, now: float) -> tuple[str, ...]:
        return tuple(sorted(body for body, at in self._seen.items() if now - at <= _IN_SIGHT))

    def _rate(self, now: float) -> float:
        if len(self._arrivals) < 2 or now - self._arrivals[-1] > _SILENT:
            return 0.0
        span = self._arrivals[-1] - self._arrivals[0]
        return (len(self._arrivals) - 1) / span if span > 0.0 else 0.0


def _named(stream: int, body_id: str) -> str:
    """Return an id that no other stream's body has, and that is no longer than ids may be."""
    return f"{stream}:{body_id}"[:MAXIMUM_ID_LENGTH]
