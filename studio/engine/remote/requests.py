"""Requests of programs, served: each kind by a few lines, which answer into the guest's outbox.

Whoever controls may act, everybody may read, and stop the robot.
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, Protocol
from weakref import WeakSet

import msgspec

from studio.engine import commands
from studio.engine.errors import StudioError
from studio.engine.inbox import Answer
from studio.engine.remote.clockwork import Clockwork
from studio.engine.remote.guest import MOST_WAITING, Guest, Subscription
from studio.engine.remote.large import LargeAnswers, demonstration
from studio.engine.remote.roles import Roles
from studio.engine.remote.shelf import Shelf
from studio.engine.remote.views import frame_of
from studio.engine.remote.wire import as_command, readable
from studio.engine.robot import JOINT_NAMES
from studio.engine.scene_file import scene_names
from studio.engine.snapshot import Message, Mode, Snapshot
from studio.remote import asked as wire
from studio.remote import told
from studio.remote.commands import BeginDriving, DisableLink, SetJointTarget, Stop, StopLink

LET_GO = "The program that controlled Baxter has let go of it."
STOPPED = (
    "Baxter was stopped, and no joint target counts any more: look why, then send the command "
    "begin_driving"
)
# A program that steps faster than real time would move it faster than its limits allow.
_REAL_TIME = "a robot beyond the simulator goes by real time"
_STOPPING = (Stop, StopLink, DisableLink)  # by anybody, as on the page
_CAN_BE_DRIVEN = (Mode.IDLE, Mode.TRAINING, Mode.DRIVEN)


class Hosted(Protocol):
    """What is needed of a session."""

    snapshot: Snapshot

    def post(self, command: commands.Command, answer: Answer = ...) -> None:
        """Put a command into the inbox."""
        ...


class Requests:
    """See the module; one thread uses it.

    Parameters
    ----------
    session
        Returns the session; raises StudioError where it has ended.
    roles, clock, shelf
        Who controls, who has the clock, and whose files there are.
    later
        Has something done on the thread that uses this; any thread may call it.
    tick
        The number of the newest tick.
    refuse
        Tells a guest why something cannot be, and which request it was.
    """

    def __init__(
        self,
        session: Callable[[], Hosted],
        roles: Roles,
        clock: Clockwork,
        shelf: Shelf,
        later: Callable[[Callable[[], None]], None],
        tick: Callable[[], int],
        refuse: Callable[[Guest, int | None, str], None],
    ) -> None:
        self._session, self._roles, self._clock, self._shelf = session, roles, clock, shelf
        self._later, self._tick, self._refuse = later, tick, refuse
        self._large = LargeAnswers()
        self._told_stopped: WeakSet[Guest] = WeakSet()  # since the last Stop
        self._left: list[Guest] = []  # whose files are not freed yet
        self._serving: dict[type[Any], Callable[[Guest, Any], None]] = {
            SetJointTarget: self._target,
            wire.Do: self._do,
            wire.Get: self._get,
            wire.Subscribe: self._subscribe,
            wire.Unsubscribe: self._unsubscribe,
            wire.Control: self._control,
            wire.TakeClock: self._take_clock,
            wire.Step: self._step,
            wire.GiveClock: self._give_clock,
            wire.Fetch: self._fetch,
            wire.FetchDemonstration: self._fetch_demonstration,
            wire.FetchFile: self._fetch_file,
            wire.Upload: self._upload,
        }

    def serve(self, guest: Guest, asked: Any) -> None:
        """Serve a request.

        Raises
        ------
        StudioError, OSError, ValueError
            Where it is impossible.
        """
        self._serving[type(asked)](guest, asked)

    def let_go(self, why: str) -> None:
        """Have Baxter let go, for a reason in words."""
        try:
            self._session().post(commands.LetGo(why))
        except StudioError:  # the engine has ended before its programs
            return
        self._clock.nudge()

    def is_linked(self) -> bool:
        """Tell whether a robot beyond the simulator is linked."""
        now = self._now()
        return now is not None and bool(now.link.url)

    def leave(self, guest: Guest) -> None:
        """Take note that a guest has gone: its files go as soon as nothing needs them."""
        guest.outbox.clear()
        self._left.append(guest)
        self.tidy()

    def tidy(self) -> None:
        """Free the files of those who have left, but for those that the session has to read."""
        now = self._now() if self._left else None
        if now is not None:
            needed = _needed(now)
            self._left = [
                guest
                for guest in self._left
                if guest.waiting or not self._shelf.free(guest.name, needed)
            ]

    def _now(self) -> Snapshot | None:
        """Return the newest snapshot; None where the engine has ended before its programs."""
        try:
            return self._session().snapshot
        except StudioError:
            return None

    def _target(self, guest: Guest, asked: SetJointTarget) -> None:
        self._roles.require(guest)
        _require_joints(asked)
        session = self._session()
        if self._is_stopped(guest):
            return
        if session.snapshot.mode not in _CAN_BE_DRIVEN:
            raise StudioError("somebody teaches, or something plays: send stop first")
        command = commands.SetJointTarget(asked.targets, asked.closed)
        if guest.answer is None:  # one for all of its targets, as the inbox keeps one command
            guest.answer = partial(self._on_thread, partial(self._targeted, guest))
        session.post(command, guest.answer)

    def _targeted(self, guest: Guest, said: Message | None) -> None:
        if not self._is_stopped(guest) and said is not None and said.is_error:
            self._refuse(guest, None, said.text)

    def _is_stopped(self, guest: Guest) -> bool:
        """Tell whether joint targets do not count; a guest that sends some is told so once."""
        now = self._now()
        if now is None or not now.stopped:
            self._told_stopped.discard(guest)
            return False
        if guest not in self._told_stopped:
            self._told_stopped.add(guest)
            guest.outbox.answer(told.Error(words=STOPPED))
        return True

    def _do(self, guest: Guest, asked: wire.Do) -> None:
        self._roles.require(guest, anybody=isinstance(asked.command, _STOPPING))
        if guest.waiting >= MOST_WAITING:
            raise StudioError(f"{MOST_WAITING} commands wait for a tick: wait for their answers")
        session = self._session()
        now = session.snapshot
        if isinstance(asked.command, SetJointTarget):
            _require_joints(asked.command)
            if now.stopped:
                raise StudioError(STOPPED)
        command = as_command(asked.command, lambda place: self._shelf.find(guest.name, place, now))
        if isinstance(command, commands.ConnectLink) and self._clock.owner is not None:
            raise StudioError(f"{_REAL_TIME}: give the clock back first, then connect it")
        if isinstance(command, commands.ChooseScene) and command.scene not in scene_names():
            raise StudioError(
                f"there is no scene {command.scene!r:.40}; there are {', '.join(scene_names())}"
            )
        guest.waiting += 1
        session.post(command, partial(self._on_thread, partial(self._done, guest, asked)))
        self._clock.nudge()

    def _done(self, guest: Guest, asked: wire.Do, said: Message | None) -> None:
        guest.waiting -= 1
        number, now = asked.id, self._now()
        if isinstance(asked.command, BeginDriving):
            self._told_stopped.clear()
        if said is not None and said.is_error:
            self._refuse(guest, number, said.text)
        elif isinstance(asked.command, SetJointTarget) and now is not None and now.stopped:
            self._refuse(guest, number, STOPPED)  # by a Stop before it, in the same tick
        elif number is not None:
            words = "" if said is None else said.text
            guest.outbox.answer(told.Done(id=number, words=readable(words)))

    def _get(self, guest: Guest, asked: wire.Get) -> None:
        frame = frame_of(asked.what, self._session().snapshot, self._tick())
        guest.outbox.answer(msgspec.structs.replace(frame, id=asked.id))

    def _subscribe(self, guest: Guest, asked: wire.Subscribe) -> None:
        guest.streams[asked.stream] = Subscription(asked.rate, self._tick())
        guest.outbox.forget(asked.stream)  # what comes after the answer is of this subscription
        guest.outbox.answer(told.Done(id=asked.id))

    def _unsubscribe(self, guest: Guest, asked: wire.Unsubscribe) -> None:
        guest.streams.pop(asked.stream, None)
        guest.outbox.forget(asked.stream)
        guest.outbox.answer(told.Done(id=asked.id))

    def _control(self, guest: Guest, asked: wire.Control) -> None:
        if self._roles.take(guest, asked):
            self.let_go(LET_GO)

    def _take_clock(self, guest: Guest, asked: wire.TakeClock) -> None:
        self._roles.require(guest)
        if self.is_linked():
            raise StudioError(f"{_REAL_TIME}: disconnect it first, then take the clock")
        self._clock.take(guest, asked)

    def _step(self, guest: Guest, asked: wire.Step) -> None:
        self._session()
        self._clock.step(guest, asked)

    def _give_clock(self, guest: Guest, asked: wire.GiveClock) -> None:
        self._clock.give(guest, asked.id)

    def _fetch(self, guest: Guest, asked: wire.Fetch) -> None:
        guest.outbox.answer(self._large.to(asked, self._session().snapshot))

    def _fetch_demonstration(self, guest: Guest, asked: wire.FetchDemonstration) -> None:
        guest.outbox.answer(demonstration(asked, self._session().snapshot))

    def _fetch_file(self, guest: Guest, asked: wire.FetchFile) -> None:
        guest.outbox.answer(self._shelf.part(asked, self._session().snapshot))

    def _upload(self, guest: Guest, asked: wire.Upload) -> None:
        guest.outbox.answer(self._shelf.take(guest.name, asked))

    def _on_thread(self, act: Callable[[Message | None], None], said: Message | None) -> None:
        self._later(partial(act, said))


def _needed(now: Snapshot) -> set[Path]:
    """Return the files that a session reads, is about to read, or may read again."""
    opened_from = now.export.opened_from
    return {*now.who.files, *(() if opened_from is None else (opened_from,))}


def _require_joints(asked: SetJointTarget) -> None:
    """Let only joints through, that the engine gathers no names; raise StudioError for others."""
    for name in asked.targets:
        if name not in JOINT_NAMES:
            raise StudioError(
                f"{name!r:.40} cannot be driven: the joints are {', '.join(JOINT_NAMES)}"
            )
