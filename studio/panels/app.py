"""The studio's page: a viser server, what lies on it, and the thread that draws snapshots."""

import contextlib
import io
import threading
from collections.abc import Callable
from functools import partial

import viser

from studio.engine.clock import LiveLoop, now
from studio.engine.commands import Command
from studio.engine.errors import StudioError
from studio.engine.seat import Seat
from studio.engine.snapshot import Snapshot
from studio.engine.uploads import Uploads
from studio.panels.arcs import ArcsView
from studio.panels.control import Control
from studio.panels.delivery import Delivery
from studio.panels.first_page import TITLE
from studio.panels.front import Front
from studio.panels.handles import Handles
from studio.panels.meshes import FINE
from studio.panels.page import Page
from studio.panels.scene import SceneView
from studio.panels.tour import Guide
from studio.panels.visitors import receive

FRAME = 1.0 / 30.0  # [s] between two pictures of the scene
HEAD_START = 1.0  # [s] for the meshes, three times what they need when they lie in the cache
PANEL_EVERY = 3  # pictures between two of the panels: 10 Hz

_NO_MESHES = (
    "Baxter is drawn in simple shapes, since its meshes were not found: pip install "
    "example-robot-data brings them."
)


class App:
    """The page of a running loop. A context manager; `url` is where it is.

    Parameters
    ----------
    loop
        A loop that runs, and goes on running for as long as the page is there.
    host, port
        Where to listen; the next free port is taken where this one is busy. Anything but loopback
        lets others in, without a password.
    detail
        How fine Baxter is drawn [m]; 0.02 is plain, and ten times lighter for a browser that draws
        without a graphics card.
    seat
        Who controls, where programs may as well as browsers.

    Raises
    ------
    StudioError
        Where the page cannot be served at that address.
    """

    def __init__(
        self,
        loop: LiveLoop,
        host: str = "127.0.0.1",
        port: int = 8080,
        detail: float = FINE,
        seat: Seat | None = None,
    ) -> None:
        self._loop, self._host = loop, host
        with _quiet():
            self._server = viser.ViserServer("127.0.0.1", 0, label=TITLE, verbose=False)
        receive(self._server, host)
        try:
            self._front = Front(self._server.get_event_loop(), host, port, self._server.get_port())
        except StudioError:
            self._stop_server()
            raise
        self._uploads = Uploads()
        self._guide = Guide(self._send, now)
        self._control = Control(self._server, self._by_hand, now, seat)
        post = self._control.post
        # A browser hears of everything in the order in which it was made: of the robot first.
        self.scene = SceneView(self._server, detail, post)
        self.scene.wait(HEAD_START)
        self._handles = Handles(self._server.scene, post)
        self._arcs = ArcsView(self._server.scene)
        self._delivery = Delivery(self._hand_over, self._attempt)
        self.page = Page(
            self._server.gui,
            post,
            self._control.allows,
            self._guide,
            self._uploads,
            self._arcs,
            self._delivery.take,
        )
        self._closing = threading.Event()
        self._drawing = threading.Thread(target=self._draw_until_closed, name="drawing")
        self._drawing.start()

    @property
    def url(self) -> str:
        """The page's address; the port is the one that was free, not always the one asked for."""
        shown = "localhost" if self._host in ("0.0.0.0", "::") else self._host
        return f"http://{shown}:{self._front.port}"

    def close(self) -> None:
        """Take the page away."""
        self._closing.set()
        self._drawing.join()
        self._delivery.close()
        self.scene.wait()
        self._front.close()
        self._stop_server()
        self._uploads.close()

    def __enter__(self) -> "App":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _stop_server(self) -> None:
        with _quiet():
            self._server.stop()

    def _by_hand(self, command: Command) -> None:
        """Pass on what a person asks for, who thereby leaves the tour."""
        self._guide.interrupt()
        self._send(command)

    def _send(self, command: Command) -> None:
        # Where the engine has ended, the page says so already.
        with contextlib.suppress(StudioError):
            self._loop.session.post(command)

    def _hand_over(self, name: str, content: bytes) -> None:
        """Send a file to the browser in control, or to all where nobody is."""
        if self._control.is_elsewhere:  # the program that asked for it fetches it
            return
        to = self._control.holder() or self._server
        to.send_file_download(name, content, save_immediately=True)

    def _attempt(self, work: Callable[[], None]) -> None:
        self.page.trouble.attempt(work)

    def _draw_until_closed(self) -> None:
        pictures = 0
        while not self._closing.wait(FRAME):
            try:
                snapshot = self._loop.session.snapshot
            except StudioError as error:
                self.page.messages.fail(str(error))
                return
            # Nothing but drawing in here: all broadcasts wait until it is through.
            with self._server.atomic():
                self._attempt(partial(self._draw, snapshot, pictures % PANEL_EVERY == 0))
            pictures += 1

    def _draw(self, snapshot: Snapshot, panels: bool) -> None:
        """Draw each part, whatever becomes of the others."""
        for part in (self.scene, self._handles, self._arcs):
            self._attempt(partial(part.draw, snapshot))
        if not panels:
            return
        self._attempt(partial(self.page.draw, snapshot, self._attempt))
        self._attempt(partial(self.scene.shade, self.page.is_dark))
        self._attempt(self._draw_surroundings)
        self.page.trouble.draw()

    def _draw_surroundings(self) -> None:
        """Show what is not the session's: how well it keeps up, who controls, what is missing."""
        self.page.tell_pace(self._loop.pace)
        self._control.draw()
        if self._control.is_elsewhere:
            self._guide.interrupt()
        if self.scene.lacks_meshes:
            self.page.messages.notify(_NO_MESHES)


def _quiet() -> contextlib.redirect_stdout[io.StringIO]:
    """Swallow viser's banners: standard output belongs to what a command prints."""
    return contextlib.redirect_stdout(io.StringIO())
