"""The studio's page: a viser server, the panels on it, and the thread that draws snapshots."""

import contextlib
import io
import threading

import viser

from studio.engine.clock import LiveLoop
from studio.engine.commands import Command
from studio.engine.errors import StudioError
from studio.engine.snapshot import Snapshot
from studio.panels.compare import ComparePanel
from studio.panels.gate import GatePanel
from studio.panels.learn import LearnPanel
from studio.panels.meshes import FINE
from studio.panels.palette import BRAND
from studio.panels.plots import EvidencePanel
from studio.panels.scene import SceneView
from studio.panels.source import SourcePanel
from studio.panels.status import MessagePanel, StatusPanel
from studio.panels.teach import TeachPanel
from studio.panels.uploads import Uploads
from studio.panels.visitors import turn_strangers_away

TITLE = "Baxter's teaching studio"
FRAME = 1.0 / 30.0  # [s] between two pictures of the scene
PANEL_EVERY = 3  # pictures between two of the panels: 10 Hz
STEPS_WIDTH, EVIDENCE_WIDTH = 372, 310  # [px]; at 1366 px half of the page is left for the scene

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
    """

    def __init__(
        self, loop: LiveLoop, host: str = "127.0.0.1", port: int = 8080, detail: float = FINE
    ) -> None:
        self._loop = loop
        with _quiet():
            self._server = viser.ViserServer(host, port, label=TITLE, verbose=False)
        turn_strangers_away(self._server)
        self._uploads = Uploads()
        self._lay_out(self._server.gui)
        self.scene = SceneView(self._server, detail)
        self._closing = threading.Event()
        self._drawing = threading.Thread(target=self._draw_until_closed, name="drawing")
        self._drawing.start()

    @property
    def url(self) -> str:
        """The page's address; the port is the one that was free, not always the one asked for."""
        host = self._server.get_host()
        shown = "localhost" if host in ("0.0.0.0", "::") else host
        return f"http://{shown}:{self._server.get_port()}"

    def close(self) -> None:
        """Take the page away."""
        self._closing.set()
        self._drawing.join()
        self.scene.wait()
        with _quiet():
            self._server.stop()
        self._uploads.close()

    def __enter__(self) -> "App":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _lay_out(self, gui: viser.GuiApi) -> None:
        """Dock the steps to the left, under what is always in sight; the evidence to the right."""
        gui.configure_theme(brand_color=BRAND, show_logo=False, show_share_button=False)
        status, gate = StatusPanel(gui, self._post), GatePanel(gui)
        self._messages = MessagePanel(gui)
        steps, evidence = gui.add_panel(), gui.add_panel()
        with steps.add_tab("1 Source"):
            source = SourcePanel(gui, self._post, self._uploads)
        with steps.add_tab("2 Teach"):
            teach = TeachPanel(gui, self._post)
        with steps.add_tab("3 Learn"):
            learn = LearnPanel(gui, self._post)
        with steps.add_tab("4 Compare"):
            compare = ComparePanel(gui, self._post)
        with evidence.add_tab("Evidence") as tab:
            plots = EvidencePanel(gui, tab)
        self._panels = (status, gate, self._messages, source, teach, learn, compare, plots)
        gui.main_panel.dock_left()
        gui.main_panel.set_width(STEPS_WIDTH)
        steps.dock_below(gui.main_panel)
        evidence.dock_right()
        evidence.set_width(EVIDENCE_WIDTH)

    def _post(self, command: Command) -> None:
        # Where the engine has ended, the page says so already.
        with contextlib.suppress(StudioError):
            self._loop.session.post(command)

    def _draw_until_closed(self) -> None:
        pictures = 0
        while not self._closing.wait(FRAME):
            try:
                now = self._loop.session.snapshot
            except StudioError as error:
                self._messages.fail(str(error))
                return
            # Nothing but drawing in here: all broadcasts wait until it is through.
            with self._server.atomic():
                self._draw(now, panels=pictures % PANEL_EVERY == 0)
            pictures += 1

    def _draw(self, now: Snapshot, panels: bool) -> None:
        self.scene.draw(now)
        if not panels:
            return
        for panel in self._panels:
            panel.draw(now)
        if self.scene.lacks_meshes:
            self._messages.notify(_NO_MESHES)


def _quiet() -> contextlib.redirect_stdout[io.StringIO]:
    """Swallow viser's banners: standard output belongs to what a command prints."""
    return contextlib.redirect_stdout(io.StringIO())
