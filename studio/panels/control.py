"""One browser controls, the others watch: what each of them sees of that, and who is refused."""

import contextlib
import threading
from collections.abc import Callable

import viser

from studio.engine import commands
from studio.engine.commands import Command
from studio.engine.errors import StudioError
from studio.engine.seat import Seat
from studio.panels import markup
from studio.panels.hearing import hear, speaker
from studio.panels.inputs import Post
from studio.panels.shared import keep_shared

ORDER = -10.0  # under the state and Stop, above all else
CLOSED = "The page that controlled Baxter was closed or lost its line, so Baxter was let go."
_STOPPING = (commands.Stop, commands.StopLink, commands.DisableLink)
_TOLD_EVERY = 3.0  # [s] between two refusals of one browser, which may drag a slider


class Control:
    """See the module.

    Parameters
    ----------
    server
        Its browsers are told apart, its callbacks heard.
    post
        Where commands go that are not refused.
    now
        The time [s].
    seat
        Who controls, browsers and programs; its own where there are no programs.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        post: Post,
        now: Callable[[], float],
        seat: Seat | None = None,
    ) -> None:
        self._server, self._post, self._now = server, post, now
        self._seat = Seat() if seat is None else seat
        self._bars: dict[int, _Bar] = {}
        self._told: dict[int, float] = {}  # [s] when a browser was last refused
        self._lock = threading.Lock()  # of the bars
        hear(server)
        keep_shared(server, self._may)
        server.on_client_connect(self._join)
        server.on_client_disconnect(self._leave)

    def post(self, command: Command) -> None:
        """Pass a command on; where it comes from a browser that only watches, refuse in words.

        What stops a robot is never refused: who sees that it has to stop may be who watches.
        """
        if self.allows(anybody=isinstance(command, _STOPPING)):
            self._post(command)

    def allows(self, anybody: bool = False) -> bool:
        """Tell whether whoever is heard on this thread may act, and say so where not.

        ``anybody`` may do it without control.
        """
        client = speaker()
        return client is None or self._may(client, anybody)

    def holder(self) -> viser.ClientHandle | None:
        """Return the browser in control."""
        held = self._seat.holder
        return self._server.get_clients().get(held) if isinstance(held, int) else None

    @property
    def is_elsewhere(self) -> bool:
        """Whether a program controls, and no browser."""
        return isinstance(self._seat.holder, str)

    def draw(self) -> None:
        """Tell each browser its role."""
        now = self._now()
        self._seat.pass_on(now)
        with self._lock:
            for client, bar in self._bars.items():
                bar.draw(client, now)

    async def _join(self, client: viser.ClientHandle) -> None:
        # Awaited by viser, as a plain function is not: its first click comes after this.
        self._seat.join(client.client_id)
        bar = _Bar(client.gui, self._seat, self._now)
        with self._lock:
            self._bars[client.client_id] = bar

    def _leave(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._bars.pop(client.client_id, None)
            self._told.pop(client.client_id, None)
        if self._seat.leave(client.client_id):
            with contextlib.suppress(StudioError):  # the engine has ended before its page
                self._post(commands.LetGo(CLOSED))

    def _may(self, client: int, anybody: bool = False) -> bool:
        refusal = self._seat.act(client)
        if anybody or not refusal:
            return True
        self._refuse(client, refusal)
        return False

    def _refuse(self, client: int, words: str) -> None:
        now = self._now()
        handle = self._server.get_clients().get(client)
        if handle is None or now - self._told.get(client, -_TOLD_EVERY) < _TOLD_EVERY:
            return
        self._told[client] = now
        handle.add_notification("You are watching", words, auto_close_seconds=8.0)


class _Bar:
    """What one browser sees of who controls: nothing while it is the only one."""

    def __init__(self, gui: viser.GuiApi, seat: Seat, now: Callable[[], float]) -> None:
        self._seat = seat
        self._words = gui.add_html("", visible=False, order=ORDER)
        self._ask = gui.add_button(
            "Ask for control",
            icon=viser.Icon.HAND_STOP,
            visible=False,
            order=ORDER + 1,
            hint="Whoever controls is asked; without an answer it is yours",
        )
        self._yes = gui.add_button(
            "Hand over", icon=viser.Icon.CHECK, visible=False, order=ORDER + 2
        )
        self._no = gui.add_button(
            "Keep control", icon=viser.Icon.X, color="gray", visible=False, order=ORDER + 3
        )
        self._ask.on_click(lambda event: seat.ask(_client(event), now()))
        self._yes.on_click(lambda event: seat.answer(_client(event), True))
        self._no.on_click(lambda event: seat.answer(_client(event), False))

    def draw(self, client: int, now: float) -> None:
        """Show the role of the browser that this is."""
        words, seat = self._seat.role(client, now), self._seat
        is_asked = client == seat.holder and seat.asking is not None
        self._words.content = markup.block(f"<b>{markup.text(words)}</b>") if words else ""
        self._words.visible = bool(words)
        is_free_to_ask = seat.asking is None or seat.asking == client
        self._ask.visible = bool(words) and client != seat.holder and is_free_to_ask
        self._ask.disabled = client == seat.asking
        self._yes.visible = self._no.visible = is_asked


def _client(event: viser.GuiEvent[viser.GuiButtonHandle]) -> int:
    return -1 if event.client_id is None else event.client_id
