"""A thread for each link, so that no tick ever waits for a network.

Commands go in by a slot of one: the newest wins, each is sent once, and one that has grown old
is never sent. That is the watchdog: where the studio stalls, or stops commanding, nothing leaves
any more but one word that the robot is to hold still where it is. (Baxter needs none: its own
controller holds its position 0.2 s after the last command, its default timeout.)
"""

import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from studio.engine.links.lateness import Lateness, lateness
from studio.engine.links.link import LinkError, Range, RobotLink, RobotState

STALE = 0.2  # [s] after which neither a command nor a state is worth anything: Baxter's own timeout
POLL = 0.005  # [s] between two looks at what came, while nothing is to send
RETRY = 1.0  # [s] before a lost link is opened anew
_LONGEST_CLOSE = 3.0  # [s] that the studio's end waits for a link's

Order = Callable[[RobotLink], None]


@dataclass(frozen=True, eq=False)
class Heard:
    """The newest state, and when it came."""

    state: RobotState
    at: float  # [s] by our clock
    late: float = 0.0  # [s] that it took longer than the quickest one

    def age(self, now: float) -> float:
        """Return how old it is [s]."""
        return now - self.at + self.late


class LinkThread:
    """See the module. Every method may be called from any thread, and none but `close` waits.

    Parameters
    ----------
    link
        Only this thread touches it.
    now
        Any clock [s] that does not run back.
    """

    def __init__(self, link: RobotLink, now: Callable[[], float]) -> None:
        self.url, self._link, self._now = link.url, link, now
        self.heard: Heard | None = None  # None while it is not connected, or tells nothing
        self.limits: Mapping[str, Range] = {}
        self.is_open = False
        self.trouble = ""  # why it is not connected, in words
        self.sent = 0  # commands that the link was given to send
        self._lock = threading.Lock()
        self._slot: tuple[float, Mapping[str, float]] | None = None
        self._is_over = False  # commands have ended until the next
        self._last: float | None = None  # [s] when one left, until the robot was told to hold
        self._orders: deque[tuple[Order, float | None]] = (
            deque()
        )  # [s] since when it may be too late
        self._news, self._closing = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run, name="robot link", daemon=True)
        self._thread.start()

    def put(self, targets: Mapping[str, float] | None) -> None:
        """Send targets as soon as possible, in place of any that wait; None: and nothing else."""
        with self._lock:
            fits = self.is_open and targets is not None
            self._slot = (self._now(), dict(targets or {})) if fits else None
            self._is_over = targets is None
        self._news.set()

    def order(self, order: Order) -> None:
        """Let the link do something else, in the order of the calls, if it is open."""
        self._put_order(order, None)

    def enable(self) -> None:
        """Let the link power the motors, soon or not at all: a stop after this comes first."""
        self._put_order(lambda link: link.enable(), self._now())

    def halt(self) -> None:
        """Send no targets that wait, power no motors, and let the robot hold where it is."""
        with self._lock:
            self._halt()

    def end(self) -> None:
        """Let it end, soon: targets that wait are not sent, but orders are, such as to disable."""
        with self._lock:
            self._halt()
        self._closing.set()
        self._news.set()

    def close(self) -> None:
        """End it, and wait for that, though not for ever: no tick may call this."""
        self.end()
        self._thread.join(_LONGEST_CLOSE)

    def _put_order(self, order: Order, since: float | None) -> None:
        with self._lock:
            if self.is_open:
                self._orders.append((order, since))
        self._news.set()

    def _halt(self) -> None:
        """Drop what makes the robot move; the lock is held."""
        self._slot, self._is_over = None, True
        self._orders = deque(each for each in self._orders if each[1] is None)

    def _run(self) -> None:
        while not self._closing.is_set():
            try:
                self._link.open()
                self._serve()
            except (LinkError, OSError) as lost:
                self.trouble = str(lost)
            except Exception as fault:  # a library's, or of ours: the same for the robot
                self.trouble = f"{self.url}: the link failed: {type(fault).__name__}: {fault}"
            finally:
                self._forget()
                self._link.close()
            self._closing.wait(RETRY)

    def _serve(self) -> None:
        """Send and listen until the link is lost or closed."""
        self.limits, self.trouble = self._link.limits, ""
        with self._lock:
            self.is_open = True
        clocks: Lateness | None = None
        while not self._closing.is_set():
            self._news.wait(POLL)
            self._news.clear()
            self._pass_on()
            state = self._link.read()
            if state is not None:
                at = self._now()
                clocks = lateness(clocks, state.stamp, at)
                self.heard = Heard(state, at, clocks.late if clocks else 0.0)
        self._pass_on()  # orders that came with the end

    def _pass_on(self) -> None:
        """Send what waits, orders first: one of them may be the end of it."""
        while (order := self._next_order()) is not None:
            order(self._link)
        with self._lock:
            waiting, self._slot, is_over = self._slot, None, self._is_over
        now = self._now()
        if waiting is not None and now - waiting[0] <= STALE and not self._closing.is_set():
            self._last = now
            self._link.send(waiting[1])
            self.sent += 1
        elif self._last is not None and (is_over or now - self._last > STALE):
            self._last = None
            self._link.stop()

    def _next_order(self) -> Order | None:
        """Return the next order that is not too late, one by one: a stop may come between two."""
        with self._lock:
            while self._orders:
                order, since = self._orders.popleft()
                if since is None or self._now() - since <= STALE:
                    return order
        return None

    def _forget(self) -> None:
        with self._lock:
            self.is_open, self.heard, self._slot, self._last = False, None, None, None
            self._orders.clear()
