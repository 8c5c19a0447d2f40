"""Who controls: one browser at a time; the others watch, and can ask.

A free seat is taken by whoever acts first. Who asks gets it when the holder hands it over, leaves,
or has not answered in time: somebody may have gone for coffee, and left a class without a robot.
"""

import threading

PATIENCE = 15.0  # [s] in which a holder can say no

WATCHING = "Another page controls Baxter: press “Ask for control” under Stop first."


class Seat:
    """See the module; any thread may ask. Browsers are numbers, times [s] of one rising clock."""

    def __init__(self) -> None:
        self.holder: int | None = None
        self.asking: int | None = None
        self._asked_at = 0.0
        self._present: set[int] = set()
        self._lock = threading.Lock()

    @property
    def present(self) -> int:
        """How many browsers there are."""
        return len(self._present)

    def join(self, client: int) -> None:
        """Let a browser in."""
        with self._lock:
            self._present.add(client)

    def leave(self, client: int) -> bool:
        """Let a browser go; return whether it was the one in control."""
        with self._lock:
            self._present.discard(client)
            if self.asking == client:
                self.asking = None
            if self.holder != client:
                return False
            self.holder, self.asking = self.asking, None
            return True

    def act(self, client: int) -> str:
        """Return why a browser may not act, or nothing; a free seat becomes its own."""
        with self._lock:
            if self.holder is None and client in self._present:
                self.holder = client
            return "" if self.holder == client else WATCHING

    def ask(self, client: int, now: float) -> None:
        """Note that a browser asks for control; whoever asked before goes first."""
        with self._lock:
            if client == self.holder or client not in self._present:
                return
            if self.holder is None:
                self.holder = client
            elif self.asking is None:
                self.asking, self._asked_at = client, now

    def answer(self, client: int, yes: bool) -> None:
        """Take the holder's yes or no to whoever asks."""
        with self._lock:
            if client == self.holder and self.asking is not None:
                if yes:
                    self.holder = self.asking
                self.asking = None

    def pass_on(self, now: float) -> bool:
        """Give the seat to whoever has waited long enough; return whether it was given."""
        with self._lock:
            if self.asking is None or now - self._asked_at < PATIENCE:
                return False
            self.holder, self.asking = self.asking, None
            return True

    def left(self, now: float) -> float:
        """Return how long the holder still has to answer [s]."""
        return max(0.0, PATIENCE - (now - self._asked_at))

    def role(self, client: int, now: float) -> str:
        """Return in words what a browser may do, nothing where there is no other one."""
        if self.present < 2:
            return ""
        others = self.present - 1
        watch = f"{others} other{'s' if others > 1 else ''} watch{'' if others > 1 else 'es'}"
        seconds = f"{self.left(now):.0f} s"
        if client == self.holder:
            if self.asking is None:
                return f"You control Baxter; {watch}."
            return f"Another page asks for control, and gets it in {seconds} unless you keep it."
        if self.holder is None:
            return "Nobody controls Baxter: whoever clicks first does."
        if client == self.asking:
            return f"You asked for control, and get it in {seconds} unless it is kept."
        return "You watch; another page controls Baxter."
