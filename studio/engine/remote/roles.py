"""Who controls, as programs see it: one seat with the browsers, asked for and handed over."""

from collections.abc import Callable, Sequence

from studio.engine.errors import StudioError
from studio.engine.remote.guest import Guest
from studio.engine.seat import Seat
from studio.remote.asked import Control
from studio.remote.told import Role

_ASK = '{"type": "control", "id": 1, "action": "ask"}'


class Roles:
    """See the module; one thread uses it, the seat is everybody's.

    Parameters
    ----------
    seat
        Shared with the browser's page.
    now
        The time [s].
    """

    def __init__(self, seat: Seat, now: Callable[[], float]) -> None:
        self._seat, self._now = seat, now

    def require(self, guest: Guest, anybody: bool = False) -> None:
        """Let a guest act; raise StudioError, which says who controls, where it may not.

        ``anybody`` may do it without control.
        """
        if self._seat.act(guest.name) and not anybody:
            who = self._seat.called(self._seat.holder)
            raise StudioError(f"{who} controls Baxter: ask for control first, {_ASK}")

    def controls(self, guest: Guest) -> bool:
        """Tell whether it does."""
        return self._seat.holder == guest.name

    def take(self, guest: Guest, asked: Control) -> bool:
        """Do what a guest asks, and answer it; return whether Baxter was let go by that."""
        let_go = False
        match asked.action:
            case "ask":
                self._seat.ask(guest.name, self._now())
            case "hand_over" | "keep":
                self._seat.answer(guest.name, yes=asked.action == "hand_over")
            case "let_go":
                let_go = self._seat.let_go(guest.name)
        role = self._role(guest, asked.id)
        guest.told = _without_time(role)
        guest.outbox.answer(role)
        return let_go

    def look(self, guests: Sequence[Guest]) -> None:
        """Give the seat to who has waited for long enough; tell everybody whose role changed."""
        self._seat.pass_on(self._now())
        for guest in guests:
            role = self._role(guest)
            if guest.told != _without_time(role):
                guest.told = _without_time(role)
                guest.outbox.answer(role)

    def _role(self, guest: Guest, number: int | None = None) -> Role:
        now, seat = self._now(), self._seat
        holder, asking = seat.holder, seat.asking
        return Role(
            controls=holder == guest.name,
            holder=seat.called(holder),
            asking=seat.called(asking),
            left=0.0 if asking is None else seat.left(now),
            words=seat.role(guest.name, now),
            id=number,
        )


def _without_time(role: Role) -> tuple[bool, str, str]:
    return role.controls, role.holder, role.asking
