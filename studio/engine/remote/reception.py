"""What becomes of a program's message. No socket is needed, and no clock but the one it is given.

One thread owns it.
"""

import itertools
import logging
from collections.abc import Callable

import studio
from studio.engine.errors import StudioError
from studio.engine.remote.clockwork import LINKED, SEAT_LOST, Clockwork
from studio.engine.remote.guest import FLOOD, Guest
from studio.engine.remote.reading import UnreadableError, read_message
from studio.engine.remote.requests import Hosted, Requests
from studio.engine.remote.roles import Roles
from studio.engine.remote.shelf import Shelf
from studio.engine.remote.views import Frame, frame_of
from studio.engine.remote.wire import readable
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES, load_robot
from studio.engine.seat import Seat
from studio.engine.snapshot import Snapshot
from studio.engine.stepping import Steps
from studio.remote import told
from studio.remote.asked import Stream
from studio.remote.commands import SetJointTarget

_LOG = logging.getLogger(__name__)
CLOSED = "The program that controlled Baxter has ended or lost its line, so Baxter was let go."


class LeaveError(StudioError):
    """A program has to be sent away."""


class Reception:
    """See the module.

    Parameters
    ----------
    session
        Returns the session; raises StudioError where it has ended.
    steps
        Who has its clock.
    seat
        Who controls it.
    now
        The time [s].
    later
        Has something done on the thread that owns this; any thread may call it.
    """

    def __init__(
        self,
        session: Callable[[], Hosted],
        steps: Steps,
        seat: Seat,
        now: Callable[[], float],
        later: Callable[[Callable[[], None]], None],
    ) -> None:
        self._seat, self._now, self._tick = seat, now, 0
        self._guests: list[Guest] = []
        self._numbers = itertools.count(1)
        self._untold: set[str] = set()  # streams of which a frame could not be told

        def tick() -> int:
            return self._tick

        self._roles, self._shelf = Roles(seat, now), Shelf()
        self._clock = Clockwork(steps, later, tick)
        self._requests = Requests(
            session, self._roles, self._clock, self._shelf, later, tick, self._refuse
        )

    def welcome(self, host: str, wake: Callable[[], None]) -> Guest:
        """Let a program in; ``wake`` is called whenever there is something to send to it."""
        name = f"program {next(self._numbers)}"
        guest = Guest.of(name, f"a program at {host}", wake, self._now())
        self._seat.join(name, guest.called)
        self._guests.append(guest)
        limits = load_robot().limits
        welcome = told.Welcome(
            version=told.VERSION,
            studio=studio.__version__,
            name=name,
            joints=list(JOINT_NAMES),
            lower=limits.lower.tolist(),
            upper=limits.upper.tolist(),
            velocity=limits.velocity.tolist(),
            period=CONTROL_PERIOD,
        )
        guest.outbox.answer(welcome)
        return guest

    def receive(self, guest: Guest, message: str | bytes) -> None:
        """Take in a message; what it is answered goes into the guest's outbox.

        Raises
        ------
        LeaveError
            Where the guest has to be sent away: it sends too much, or never reads.
        """
        now = self._now()
        if not guest.flood.take(now):
            raise LeaveError(f"too fast: more than {FLOOD:,.0f} messages a second")
        if guest.outbox.is_full:
            raise LeaveError("does not read its answers")
        try:
            asked = read_message(message)
        except UnreadableError as error:
            if not guest.unreadable.take(now):
                raise LeaveError("too much that cannot be read: see docs/remote.md") from None
            guest.outbox.answer(told.Error(words=str(error), id=error.id, place=error.place))
            return
        number = getattr(asked, "id", None)
        if not isinstance(asked, SetJointTarget) and not guest.requests.take(now):
            self._refuse(guest, number, "too fast: wait for answers before asking again")
            return
        try:
            self._requests.serve(guest, asked)
        except (StudioError, OSError, ValueError) as error:
            self._refuse(guest, number, str(error))

    def leave(self, guest: Guest) -> None:
        """Take note that a program has gone: time goes on, and Baxter is let go."""
        self._guests.remove(guest)
        if self._seat.leave(guest.name):  # before all else that might fail: Baxter is let go
            self._requests.let_go(CLOSED)
        self._clock.end("", guest)
        self._requests.leave(guest)

    def ticked(self, now: Snapshot) -> None:
        """Offer a tick's snapshot to whoever subscribed."""
        self._tick += 1
        made: dict[Stream, Frame | None] = {}
        for guest in self._guests:
            for stream, subscription in guest.streams.items():
                if subscription.is_due(self._tick):
                    if stream not in made:
                        made[stream] = self._frame(stream, now)
                    frame = made[stream]
                    if frame is not None:
                        guest.outbox.offer(stream, frame)

    def look(self) -> None:
        """Do what is due by now, ten times a second: pass the seat on, tell roles, free files."""
        self._roles.look(self._guests)
        owner = self._clock.owner
        if owner is not None and not self._roles.controls(owner):
            self._clock.end(SEAT_LOST)
        if owner is not None and self._requests.is_linked():
            self._clock.end(LINKED)
        self._requests.tidy()

    def close(self) -> None:
        """Let go of everything: time goes on by itself, uploads are deleted."""
        self._clock.end("the studio is closing")
        self._shelf.close()

    def _frame(self, stream: Stream, now: Snapshot) -> Frame | None:
        try:
            return frame_of(stream, now, self._tick)
        except ValueError:  # a number that is not finite: of one frame, the next one may be whole
            if stream not in self._untold:
                self._untold.add(stream)
                _LOG.exception("a frame of %s cannot be told", stream)
            return None

    def _refuse(self, guest: Guest, number: int | None, words: str) -> None:
        """Answer a request with why it is impossible; what is no request, now and then."""
        if number is not None or guest.may_complain(self._now()):
            guest.outbox.answer(told.Error(words=readable(words), id=number))
