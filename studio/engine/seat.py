"""Who controls: one browser or program at a time; the others watch, and can ask.

A free seat is taken by whoever acts first. Who asks gets it when the holder hands it over, leaves,
or has not answered in time: somebody may have gone for coffee, and left a class without a robot.
"""

import threading

PATIENCE = 15.0  # [s] in which a holder can say no

Client = int | str  # a browser's number, or a program's name: what tells one from all others
PAGE = "another page"  # how others call a browser
WATCHING = "Another page controls Baxter: press “Ask for control” under Stop first."


class Seat:
    """See the module; any thread may ask. Times are [s] of one rising clock."""

    def __init__(self) -> None:
        self.holder: Client | None = None
        self.asking: Client | None = None
        self._asked_at = 0.0
        self._present: dict[Client, str] = {}  # what others call each
        self._lock = threading.Lock()

    @property
    def present(self) -> int:
        """How many browsers and programs there are."""
        return len(self._present)

    def join(self, client: Client, called: str = PAGE) -> None:
        """Let a browser or a program in; the others know it as ``called``."""
        with self._lock:
            self._present[client] = called

    def leave(self, client: Client) -> bool:
        """Let a client go; return whether it was the one in control."""
        with self._lock:
            self._present.pop(client, None)
            return self._free(client)

    def let_go(self, client: Client) -> bool:
        """Free the seat, whose holder stays to watch; return whether it was the one in control."""
        with self._lock:
            return self._free(client)

    def act(self, client: Client) -> str:
        """Return why a client may not act, or nothing; a free seat becomes its own."""
        with self._lock:
            if self.holder is None and client in self._present:
                self.holder = client
            if self.holder == client:
                return ""
            if self.holder is None or self.called(self.holder) == PAGE:
                return WATCHING
            who = self.called(self.holder)
            return f"{who[0].upper()}{who[1:]}{WATCHING.removeprefix('Another page')}"

    def ask(self, client: Client, now: float) -> None:
        """Note that a client asks for control; whoever asked before goes first."""
        with self._lock:
            if client == self.holder or client not in self._present:
                return
            if self.holder is None:
                self.holder = client
            elif self.asking is None:
                self.asking, self._asked_at = client, now

    def answer(self, client: Client, yes: bool) -> None:
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

    def called(self, client: Client | None) -> str:
        """Return what others call a client; nothing for nobody."""
        return "" if client is None else self._present.get(client, PAGE)

    def role(self, client: Client, now: float) -> str:
        """Return in words what a browser may do, nothing where there is no other client."""
        if self.present < 2:
            return ""
        others = self.present - 1
        watch = f"{others} other{'s' if others > 1 else ''} watch{'' if others > 1 else 'es'}"
        seconds = f"{self.left(now):.0f} s"
        holder, asking = self.holder, self.asking
        if client == holder:
            if asking is None:
                return f"You control Baxter; {watch}."
            who = self.called(asking)
            return (
                f"{who[0].upper()}{who[1:]} asks for control, and gets it in {seconds} unless you "
                "keep it."
            )
        if holder is None:
            return "Nobody controls Baxter: whoever clicks first does."
        if client == asking:
            return f"You asked for control, and get it in {seconds} unless it is kept."
        return f"You watch; {self.called(holder)} controls Baxter."

    def _free(self, client: Client) -> bool:
        """Take a client out of seat and queue; whoever asks sits down. The lock is held."""
        if self.asking == client:
            self.asking = None
        if self.holder != client:
            return False
        self.holder, self.asking = self.asking, None
        return True
