"""The clock in a program's hand: taken, stepped, given back, lost; one guest's at a time."""

from collections.abc import Callable

from studio.engine.errors import StudioError
from studio.engine.remote.guest import Guest
from studio.engine.remote.views import block, joint_states
from studio.engine.snapshot import Snapshot
from studio.engine.stepping import Steps
from studio.remote.asked import Step, TakeClock
from studio.remote.told import ClockLost, Done, Error, Stepped

_STALLED = "no step was asked for in {:g} s: time goes on by itself, take the clock again"
LINKED = "a robot beyond the simulator is linked, which goes by real time"
_NEVER_TAKEN = "the clock was given back before the world stood still"
SEAT_LOST = "this program does not control Baxter any more: time goes on by itself"


class Clockwork:
    """See the module; one thread uses it.

    Parameters
    ----------
    steps
        The live loop's.
    later
        Has something done on the thread that uses this.
    tick
        The number of the newest tick.
    """

    def __init__(
        self,
        steps: Steps,
        later: Callable[[Callable[[], None]], None],
        tick: Callable[[], int],
    ) -> None:
        self._steps, self._later, self._tick = steps, later, tick
        self.owner: Guest | None = None
        self._turn = 0  # raised by each `take`: what an older one still hears of is not meant
        self._taking: int | None = None  # the number of a request that is not answered yet

    def take(self, guest: Guest, asked: TakeClock) -> None:
        """Give the clock to a guest; it is told once the world stands still.

        Raises
        ------
        StudioError
            Where somebody has it.
        """
        if self.owner is not None:
            raise StudioError("a program has the clock already")
        turn, words = self._turn + 1, _STALLED.format(asked.patience)
        self._steps.take(
            asked.patience,
            lambda now: self._later(lambda: self._taken(turn, now)),
            lambda: self._later(lambda: self._lost(turn, words)),
        )
        self.owner, self._turn, self._taking = guest, turn, asked.id

    def step(self, guest: Guest, asked: Step) -> None:
        """Let ticks pass; the guest is told when they have.

        Raises
        ------
        StudioError
            Where it has not the clock, or its last steps are not over.
        """
        self._require(guest)
        self._steps.ask(
            asked.ticks, lambda now: self._later(lambda: self._tell(guest, asked.id, now))
        )

    def give(self, guest: Guest, number: int) -> None:
        """Take the clock back from a guest that gives it; raise StudioError where it has none."""
        self._require(guest)
        self.end("", guest)
        guest.outbox.answer(Done(id=number))

    def end(self, why: str, guest: Guest | None = None) -> None:
        """Let time go on by itself, if ``guest`` or whoever has the clock: it is told why."""
        owner = self.owner
        if owner is None or (guest is not None and owner is not guest):
            return
        self.owner = None
        self._steps.give()
        if self._taking is not None:
            owner.outbox.answer(Error(words=why or _NEVER_TAKEN, id=self._taking))
            self._taking = None
        elif why:
            owner.outbox.answer(ClockLost(words=why))

    def nudge(self) -> None:
        """Let commands take effect while the world stands still."""
        self._steps.nudge()

    def _require(self, guest: Guest) -> None:
        if self.owner is not guest:
            raise StudioError("this program has not the clock: send take_clock first")

    def _taken(self, turn: int, now: Snapshot) -> None:
        number, owner = self._taking, self.owner
        if turn == self._turn and owner is not None and number is not None:
            self._taking = None
            self._tell(owner, number, now)

    def _lost(self, turn: int, why: str) -> None:
        if turn == self._turn:
            self.end(why)

    def _tell(self, guest: Guest, number: int, now: Snapshot) -> None:
        tick = self._tick()
        guest.outbox.answer(
            Stepped(id=number, state=joint_states(now, tick), block=block(now, tick))
        )
