"""What lies where on the page: what is always in sight, the steps, the evidence, the timeline."""

from collections.abc import Callable
from functools import partial
from typing import Protocol

import viser

from studio.engine.pace import Pace
from studio.engine.snapshot import Snapshot
from studio.engine.tour import Step
from studio.engine.uploads import Uploads
from studio.panels.arcs import ArcsView
from studio.panels.compare import ComparePanel
from studio.panels.exports import Deliver, ExportPanel
from studio.panels.gate import GatePanel
from studio.panels.hotkeys import Hotkeys, keys_as_html
from studio.panels.inputs import Post
from studio.panels.learn import LearnPanel
from studio.panels.pace import PaceLine
from studio.panels.plots import EvidencePanel
from studio.panels.robot_link import RobotLine
from studio.panels.source import SourcePanel
from studio.panels.status import MessagePanel, StatusPanel
from studio.panels.steps import Steps
from studio.panels.teach import TeachPanel
from studio.panels.timeline import TimelinePanel
from studio.panels.tour import Guide, TourCaption, TourInvitation
from studio.panels.trouble import Attempt, TroubleLine
from studio.panels.view import ViewPanel

STEPS_WIDTH, STATE_WIDTH, FLOATING_WIDTH = 372, 372, 420  # [px]; half of 1366 is the scene's
_STEP_OF: dict[Step, str] = {
    "source": "1 Source",
    "teach": "2 Teach",
    "learn": "3 Learn",
    "compare": "4 Compare",
}
CAPTION_WIDTH = 350  # [px]; left of it are the browser's own notices
EXPORT = "5 Export"
# On a projector of 1024 pixels what floats would cover the evidence; viser cannot say "at most".
_NARROW = f"""<style>@media (max-width: {2 * STEPS_WIDTH + STATE_WIDTH + 80}px) {{
[data-floating-window] {{
  width: calc(100vw - {STEPS_WIDTH + STATE_WIDTH + 20}px) !important; min-width: 240px;
  left: {STEPS_WIDTH + 10}px !important; }}
}}</style>"""


class Panel(Protocol):
    """What shows a snapshot."""

    def draw(self, now: Snapshot) -> None:
        """Show it."""
        ...


class Page:
    """See the module.

    Parameters
    ----------
    gui
        Of all browsers.
    post
        Where people's commands go.
    may_act
        Tells whether whoever is heard may act, and says so where not.
    guide
        Leads the tour.
    uploads, arcs
        What panels share with others.
    deliver
        Sends files to whoever asked for them, without waiting for it.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        post: Post,
        may_act: Callable[[], bool],
        guide: Guide,
        uploads: Uploads,
        arcs: ArcsView,
        deliver: Deliver,
    ) -> None:
        self._may_act, self._guide = may_act, guide
        self._stage = 0  # of the tour, whose step was opened last
        status, gate = StatusPanel(gui, post), GatePanel(gui, post)
        self._caption = TourCaption(gui, self._leave)
        self.messages, robot = MessagePanel(gui), RobotLine(gui)
        self.trouble, late = TroubleLine(gui), PaceLine(gui, always=False)
        self._add_steps(gui, post, uploads, arcs, deliver)
        evidence, playing = gui.add_panel(), gui.add_panel()
        with evidence.add_tab("Evidence") as tab:
            plots = EvidencePanel(gui, tab)
        with evidence.add_tab("Keys and view"):
            self._paces = (late, PaceLine(gui, always=True))
            self._view = ViewPanel(gui)
        with playing.add_tab("Timeline"):
            gui.add_html(_NARROW)
            timeline = TimelinePanel(gui, post)
        hotkeys = self._add_hotkeys(gui, post)
        self._always = (status, gate, self.messages, robot, plots, timeline, hotkeys)
        self._steps_panel.dock_left()
        self._steps_panel.set_width(STEPS_WIDTH)
        gui.main_panel.dock_right()
        gui.main_panel.set_width(STATE_WIDTH)
        evidence.dock_below(gui.main_panel)
        playing.float(x=12, y=-12, width=FLOATING_WIDTH)
        self._caption.panel.float(x=-12, y=12, width=CAPTION_WIDTH)

    def draw(self, now: Snapshot, attempt: Attempt = lambda work: work()) -> None:
        """Show a snapshot; of the steps only the open one, and the last one for what it sends.

        Each panel is an ``attempt`` of its own.
        """
        attempt(partial(self._draw_tour, now))
        for panel in self._always:
            attempt(partial(panel.draw, now))
        for name, step in self._panels.items():
            if self.steps.is_open(name):
                attempt(partial(step.draw, now))
        attempt(partial(self._export.send, now))

    def _draw_tour(self, now: Snapshot) -> None:
        caption = self._guide.look(now)
        if caption is not None and caption.number != self._stage:
            self.steps.open(_STEP_OF[caption.step])
        self._stage = 0 if caption is None else caption.number
        self._caption.draw(caption, self._guide.farewell)
        self._invitation.draw(caption is not None)

    @property
    def is_dark(self) -> bool:
        """Whether the page is one for a dark room."""
        return self._view.is_dark

    def tell_pace(self, pace: Pace) -> None:
        """Show whether the studio keeps up."""
        for line in self._paces:
            line.draw(pace)

    def _add_steps(
        self, gui: viser.GuiApi, post: Post, uploads: Uploads, arcs: ArcsView, deliver: Deliver
    ) -> None:
        self._steps_panel = gui.add_panel()
        with self._steps_panel.add_tab("Steps"):
            self.steps = Steps(gui, (*_STEP_OF.values(), EXPORT), self._may_act)
        with self.steps["1 Source"]:
            self._invitation = TourInvitation(gui, self._begin)
            source = SourcePanel(gui, post, uploads, arcs, self._may_act)
        with self.steps["2 Teach"]:
            teach = TeachPanel(gui, post)
        with self.steps["3 Learn"]:
            learn = LearnPanel(gui, post)
        with self.steps["4 Compare"]:
            compare = ComparePanel(gui, post)
        with self.steps[EXPORT]:
            self._export = ExportPanel(gui, post, uploads, deliver)
        panels: tuple[Panel, ...] = (source, teach, learn, compare, self._export)
        self._panels = dict(zip((*_STEP_OF.values(), EXPORT), panels, strict=True))

    def _add_hotkeys(self, gui: viser.GuiApi, post: Post) -> Hotkeys:
        opening = {name: self._opening(name) for name in self._panels}
        page = {"Take the tour": self._begin, **opening, "Dark or light": self._change_theme}
        hotkeys = Hotkeys(gui, post, page, (self._export.order,))
        self._view.explain(keys_as_html(hotkeys.actions))
        return hotkeys

    def _opening(self, name: str) -> Callable[[], None]:
        def open_it() -> None:
            if self._may_act():
                self.steps.open(name)

        return open_it

    def _change_theme(self) -> None:
        if self._may_act():
            self._view.toggle()

    def _begin(self) -> None:
        if self._may_act():
            self._guide.begin()

    def _leave(self) -> None:
        if self._may_act():
            self._guide.leave()
