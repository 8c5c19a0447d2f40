"""A reception without sockets or threads: a session that is ticked by hand, and its guests."""

import json
from contextlib import contextmanager
from pathlib import Path

from studio.engine.links.linked import Linked
from studio.engine.live.source import LiveSource
from studio.engine.remote.guest import Guest
from studio.engine.remote.reception import Reception
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.seat import Seat
from studio.engine.session import Session
from studio.engine.stepping import Steps
from tests.remote.overheard import Overheard


class Hall:
    """See the module; time passes tick by tick. All that is said has to be documented."""

    def __init__(self, folder: Path) -> None:
        self.time, self.seat = 0.0, Seat()
        linked = Linked(lambda: self.time)
        live = LiveSource(lambda: self.time)
        self.session = Session(folder, live=live, linked=linked)
        self.steps = Steps(lambda: self.time)
        self.overheard = Overheard()
        self.reception = Reception(
            lambda: self.session, self.steps, self.seat, lambda: self.time, lambda act: act()
        )

    def enter(self) -> Guest:
        return self.reception.welcome("127.0.0.1", lambda: None)

    def ask(self, guest: Guest, message: dict | str | bytes) -> list[dict]:
        """What a guest is told at once."""
        self.send(guest, json.dumps(message) if isinstance(message, dict) else message)
        return self.told(guest)

    def send(self, guest: Guest, message: str | bytes) -> None:
        """Let a guest say something, whose answer stays in its outbox."""
        self.overheard("asked", str(message))
        self.reception.receive(guest, message)

    def do(self, guest: Guest, kind: str, **fields: object) -> dict:
        """What a command is answered once it took effect."""
        self.ask(guest, {"type": "do", "id": 77, "command": {"type": kind, **fields}})
        self.tick()
        (answer,) = [each for each in self.told(guest) if each.get("id") == 77]
        return answer

    def tick(self, ticks: int = 1) -> None:
        for _ in range(ticks):
            self.time += CONTROL_PERIOD
            self.reception.ticked(self.session.tick())

    def told(self, guest: Guest) -> list[dict]:
        """What lies in a guest's outbox, which is empty then."""
        found = []
        while (text := guest.outbox.next()) is not None:
            self.overheard("told", text)
            found.append(json.loads(text))
        return found


@contextmanager
def open_hall(folder: Path):
    hall = Hall(folder)
    try:
        yield hall
    finally:
        hall.reception.close()
        hall.session.close()
    assert hall.overheard.check() > 0
