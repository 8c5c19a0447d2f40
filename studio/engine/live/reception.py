"""What becomes of a publisher's message: read, counted, answered in words. No socket is needed.

One publisher drives: the first one who sends a frame that can be read. The others wait, and are
told so; the first of them to send takes over once the driver has left, or has sent nothing that
could be read for `SILENCE`. One thread owns a reception.
"""

from collections.abc import Callable
from dataclasses import dataclass

from studio.engine.errors import StudioError
from studio.engine.live.protocols import Protocol, detect, read_objects
from studio.engine.live.source import LiveSource

LARGEST_MESSAGE = 128 * 1024  # bytes; six people in all of node-kinect2's detail are 50 kB
FASTEST = 120.0  # messages a second that are read, four times a Kinect's
_BURST = 60.0  # of them, that may come at once after a pause
FLOOD = 5_000.0  # a second; whoever sends more costs time even unread, and is sent away
UNREADABLE_COSTS = 10.0  # messages of that rate: nobody may keep the studio busy with garbage
SILENCE = 5.0  # [s] after which a driver's seat is free
ANSWER_EVERY = 1.0  # [s] between two complaints to one publisher

Answer = dict[str, object]


class TokenBucket:
    """Lets ``rate`` messages a second through, and ``burst`` at once."""

    def __init__(self, rate: float, burst: float, now: float) -> None:
        self._rate, self._burst = rate, burst
        self._tokens, self._since = burst, now

    def take(self, now: float) -> bool:
        """Take a token if one is there."""
        self._tokens = min(self._burst, self._tokens + (now - self._since) * self._rate)
        self._since = now
        if self._tokens < 1.0:
            return False
        self._tokens -= 1.0
        return True

    def owe(self, cost: float) -> None:
        """Take tokens that may not be there; the debt is paid by waiting."""
        self._tokens -= cost


@dataclass(eq=False)
class Publisher:
    """A connection, and what is known of it."""

    name: str  # for people
    bucket: TokenBucket
    flood: TokenBucket
    protocol: Protocol | None = None  # told by its first message that could be read
    told: str = ""  # the state that it was told last
    complained: float | None = None  # when it was told what is wrong [s]


class FloodError(StudioError):
    """A publisher sends so much that even passing over it costs too much."""


class Reception:
    """See the module."""

    def __init__(self, source: LiveSource, now: Callable[[], float]) -> None:
        self._source, self._now = source, now
        self._driver: Publisher | None = None
        self._heard = 0.0  # when the driver's last readable frame came [s]

    def welcome(self, name: str) -> tuple[Publisher, Answer]:
        """Return what stands for a new connection, and what to tell it."""
        now = self._now()
        publisher = Publisher(
            name, TokenBucket(FASTEST, _BURST, now), TokenBucket(FLOOD, FLOOD, now)
        )
        if self._is_taken(now):
            return publisher, self._told_waiting(publisher)
        return publisher, {"status": "ready", "expects": "frames; the first one makes you drive"}

    def receive(self, publisher: Publisher, message: str | bytes) -> Answer | None:
        """Take in a message; return what to answer, if anything.

        Raises
        ------
        FloodError
            Where the publisher has to be sent away.
        """
        now = self._now()
        if not publisher.flood.take(now):
            self._source.count("too_fast")
            raise FloodError(f"more than {FLOOD:,.0f} messages a second")
        if not publisher.bucket.take(now):
            self._source.count("too_fast")
            return self._complain(publisher, f"too fast: {FASTEST:.0f} messages a second are read")
        if self._driver is not publisher and self._is_taken(now):
            self._source.count("waiting")
            return None if publisher.told == "waiting" else self._told_waiting(publisher)
        try:
            objects = read_objects(message)
            protocol = publisher.protocol or detect(objects[0])
            frame = protocol.read(objects, now)
        except StudioError as error:
            publisher.bucket.owe(UNREADABLE_COSTS)
            self._source.count("unreadable")
            return self._complain(publisher, str(error))
        publisher.protocol = protocol
        answer = self._seat(publisher, protocol)
        self._heard = now
        late = self._source.put(frame, now, protocol.is_stamped(objects[0]))
        return answer or (self._complain(publisher, late) if late else None)

    def leave(self, publisher: Publisher) -> None:
        """Take note that a connection has ended."""
        if self._driver is publisher:
            self._driver = None
            self._source.leave()

    def _is_taken(self, now: float) -> bool:
        return self._driver is not None and now - self._heard <= SILENCE

    def _seat(self, publisher: Publisher, protocol: Protocol) -> Answer | None:
        """Let a publisher drive; return what to tell it unless it drives already."""
        if self._driver is publisher:
            return None
        self._driver = publisher
        self._source.drive(publisher.name, protocol.name)
        publisher.told = "driving"
        return {"status": "driving", "protocol": protocol.name}

    def _told_waiting(self, publisher: Publisher) -> Answer:
        publisher.told = "waiting"
        driver = self._driver.name if self._driver else "another"
        return {"status": "waiting", "reason": f"{driver} drives; go on sending to be the next"}

    def _complain(self, publisher: Publisher, words: str) -> Answer | None:
        now = self._now()
        if publisher.complained is not None and now - publisher.complained < ANSWER_EVERY:
            return None
        publisher.complained = now
        return {"error": words}
