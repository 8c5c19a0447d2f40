"""Who lets time pass: usually the live loop's clock; while a program has it, its steps do.

The world stands still between them. Commands still take effect meanwhile, in no time at all. A
program that asks for no step within its patience has vanished or stalled, and loses the clock.
"""

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from studio.engine.errors import StudioError
from studio.engine.snapshot import Snapshot

MOST_STEPS = 3000  # ticks that may be asked for at once: 100 s
_LOOK_EVERY = 0.1  # [s] for commands of others than who has the clock, which nudges

Done = Callable[[Snapshot], None]  # called on the loop's thread


class Stepped(Protocol):
    """What is stepped: the session."""

    snapshot: Snapshot

    def tick(self) -> Snapshot:
        """Do one control period."""
        ...

    def hear(self) -> None:
        """Let commands take effect, without time."""
        ...


@dataclass(frozen=True)
class _Asked:
    ticks: int
    done: Done


class Steps:
    """See the module. Any thread may use it, but for `run`, which is the loop's.

    Parameters
    ----------
    now
        The time [s] by a clock that never runs back.
    """

    def __init__(self, now: Callable[[], float]) -> None:
        self._now = now
        self._condition = threading.Condition()
        self._held = False
        self._patience = 0.0  # [s]
        self._taken: Done | None = None  # told once time stands still
        self._lost: Callable[[], None] | None = None  # told where the patience is over
        self._asked: _Asked | None = None
        self._nudged = False

    @property
    def is_held(self) -> bool:
        """Whether a program has the clock."""
        return self._held

    def take(self, patience: float, taken: Done, lost: Callable[[], None]) -> None:
        """Take the clock; ``taken`` is told when the world stands still.

        Without a step for ``patience`` [s] it goes back, and ``lost`` is told.

        Raises
        ------
        StudioError
            Where it is taken already.
        """
        with self._condition:
            if self._held:
                raise StudioError("a program has the clock already")
            self._held, self._patience, self._taken, self._lost = True, patience, taken, lost
            self._condition.notify()

    def ask(self, ticks: int, done: Done) -> None:
        """Let ``ticks`` pass, then tell ``done``, also where the clock is lost meanwhile.

        Raises
        ------
        StudioError
            Where the clock runs by itself, or the last steps are not over.
        """
        if not 1 <= ticks <= MOST_STEPS:
            raise StudioError(f"steps: 1 to {MOST_STEPS} at once, not {ticks}")
        with self._condition:
            if not self._held:
                raise StudioError("the clock runs by itself: take it first, then ask for steps")
            if self._asked is not None:
                raise StudioError("the last steps are not over: wait for their answer")
            self._asked = _Asked(ticks, done)
            self._condition.notify()

    def nudge(self) -> None:
        """Let commands that were posted take effect soon."""
        with self._condition:
            self._nudged = True
            self._condition.notify()

    def give(self) -> None:
        """Give the clock back, if anybody has it; steps that go on end after the present tick."""
        with self._condition:
            self._held = False
            self._condition.notify()

    def run(
        self, session: Stepped, stopping: threading.Event, ticked: Callable[[Snapshot], None]
    ) -> None:
        """Step a session as asked, until the clock is given back or ``stopping`` is set."""
        heard = self._now()
        while self._held and not stopping.is_set():
            if self._begin(session):
                heard = self._now()
            asked = self._next()
            if asked is None:
                session.hear()
                if self._now() - heard > self._patience:
                    self._lose()
                continue
            for _ in range(asked.ticks):
                ticked(session.tick())
                if not self._held or stopping.is_set():
                    break
            with self._condition:
                self._asked = None
            asked.done(session.snapshot)
            heard = self._now()
        self._end(session)

    def _begin(self, session: Stepped) -> bool:
        """Tell whoever has taken the clock that time stands still; return whether anybody had."""
        taken, self._taken = self._taken, None
        if taken is not None:
            taken(session.snapshot)
        return taken is not None

    def _next(self) -> _Asked | None:
        """Wait for what is asked, for a nudge, or a little."""
        with self._condition:
            if self._asked is None and self._held and not self._nudged:
                self._condition.wait(_LOOK_EVERY)
            self._nudged = False
            return self._asked

    def _lose(self) -> None:
        self.give()
        lost, self._lost = self._lost, None
        if lost is not None:
            lost()

    def _end(self, session: Stepped) -> None:
        """Tell whoever waits for steps that none will come."""
        with self._condition:
            asked, self._asked = self._asked, None
        if asked is not None:
            asked.done(session.snapshot)
