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


@dataclass(frozen=True, eq=False)
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
        self._heard = 0.0  # [s] when whoever has the clock was heard last
        self._asked: _Asked | None = None
        self._over: list[Done] = []  # of steps that are over or dropped, and not answered
        self._nudged = False

    @property
    def is_held(self) -> bool:
        """Whether a program has the clock."""
        return self._held

    @property
    def is_due(self) -> bool:
        """Whether `run` has something to do."""
        return self._held or bool(self._over)

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
            self._heard = self._now()
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
        """Give the clock back, if anybody has it; steps that go on end after the present tick.

        Whoever waits for time to stand still is not told any more.
        """
        with self._condition:
            self._held, self._taken = False, None
            self._drop()
            self._condition.notify()

    def run(
        self, session: Stepped, stopping: threading.Event, ticked: Callable[[Snapshot], None]
    ) -> None:
        """Step a session as asked, until the clock is given back or ``stopping`` is set."""
        while self._held and not stopping.is_set():
            self._begin(session)
            asked = self._next()
            if asked is None:
                session.hear()
                self._lose_if_silent()
            else:
                for _ in range(asked.ticks):
                    ticked(session.tick())
                    if self._asked is not asked or stopping.is_set():  # it was dropped
                        break
                with self._condition:
                    if self._asked is asked:
                        self._heard = self._now()
                        self._drop()
            self._answer(session)
        with self._condition:
            if stopping.is_set():
                self._drop()
        self._answer(session)

    def _begin(self, session: Stepped) -> None:
        """Tell whoever has taken the clock that time stands still; its patience begins now."""
        with self._condition:
            taken, self._taken = self._taken, None
            self._heard = self._heard if taken is None else self._now()
        if taken is not None:
            taken(session.snapshot)

    def _next(self) -> _Asked | None:
        """Wait for what is asked, for a nudge, or a little."""
        with self._condition:
            if self._asked is None and self._held and not self._nudged:
                self._condition.wait(_LOOK_EVERY)
            self._nudged = False
            return self._asked

    def _lose_if_silent(self) -> None:
        with self._condition:  # all at once: by the next moment somebody else may have taken it
            is_heard = self._now() - self._heard <= self._patience
            if is_heard or not self._held or self._asked is not None:
                return
            self.give()
            lost, self._lost = self._lost, None
        if lost is not None:
            lost()

    def _drop(self) -> None:
        """Let no step more pass of those that were asked for; the lock is held."""
        if self._asked is not None:
            self._over.append(self._asked.done)
        self._asked = None

    def _answer(self, session: Stepped) -> None:
        """Tell whoever waits for steps that no more will come."""
        with self._condition:
            over, self._over = self._over, []
        for done in over:
            done(session.snapshot)
