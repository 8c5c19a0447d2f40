"""The tour in the page: its guide, its caption, and the button that invites to it."""

import threading
from collections.abc import Callable

import viser

from studio.engine.commands import Command
from studio.engine.snapshot import Snapshot
from studio.engine.tour import Caption, Tour
from studio.panels import markup
from studio.panels.palette import BRAND, css

TOOK_OVER = "You took over: the tour is over, and what it has made is yours."
LEFT = "You left the tour; what it has made so far is yours."
_FRAME = f"border-left:10px solid {css(BRAND)};padding:.2em .6em;font-size:max(16px,2.1vh)"

# viser's own notices, as that a machine has no graphics card, would lie over the captions. Where a
# later viser names them in another way they do again, until somebody closes them.
_NOTICES_BELOW = """<style>
.mantine-Notifications-root { margin-top: max(260px, 34vh); }
</style>"""


class Guide:
    """Whoever leads the tour; any thread may call.

    Parameters
    ----------
    post
        Where the tour's commands go.
    now
        The time [s].
    """

    def __init__(self, post: Callable[[Command], None], now: Callable[[], float]) -> None:
        self._post, self._now = post, now
        self._tour = Tour()
        self._lock = threading.Lock()

    @property
    def is_on(self) -> bool:
        """Whether somebody is on the tour."""
        return self._tour.is_on

    @property
    def farewell(self) -> str:
        """How the last tour ended."""
        return self._tour.farewell

    def begin(self) -> None:
        """Set out, or begin anew."""
        with self._lock:
            self._tour.begin()

    def interrupt(self) -> None:
        """Make room for whoever does something by hand: the tour ends, its last words go."""
        with self._lock:
            if self._tour.is_on:
                self._tour.leave(TOOK_OVER)
            else:
                self._tour.farewell = ""

    def leave(self) -> None:
        """End it where it is; after its end, take its last words away."""
        with self._lock:
            if self._tour.is_on:
                self._tour.leave(LEFT)
            else:
                self._tour.farewell = ""

    def look(self, now: Snapshot) -> Caption | None:
        """Go on as far as a snapshot allows, and return what there is to see."""
        with self._lock:
            asked = self._tour.advance(now, self._now())
            caption = self._tour.caption(now)
        for command in asked:
            self._post(command)
        return caption


class TourCaption:
    """What there is to see now, in a window of its own over the scene."""

    def __init__(self, gui: viser.GuiApi, leave: Callable[[], None]) -> None:
        self.panel = gui.add_panel(visible=False)
        with self.panel.add_tab("Tour"):
            gui.add_html(_NOTICES_BELOW)
            self._words = gui.add_html("")
            self._leave = gui.add_button(
                "Leave the tour",
                hint="What it has made so far stays",
                color="gray",
                icon=viser.Icon.DOOR_EXIT,
            )
        self._leave.on_click(lambda _: leave())

    def draw(self, caption: Caption | None, farewell: str) -> None:
        """Show the caption, or how the tour ended."""
        self._words.content = shown(caption, farewell)
        self._leave.label = "Close" if caption is None else "Leave the tour"
        self.panel.visible = bool(caption or farewell)


class TourInvitation:
    """The way into it, where a newcomer looks first."""

    def __init__(self, gui: viser.GuiApi, begin: Callable[[], None]) -> None:
        self._begin = gui.add_button(
            "Take the tour",
            hint="The paper's experiment in under two minutes, with a caption at each stage",
            icon=viser.Icon.ROUTE,
        )
        self._begin.on_click(lambda _: begin())

    def draw(self, is_on: bool) -> None:
        """Offer it to whoever is not on it."""
        self._begin.visible = not is_on


def shown(caption: Caption | None, farewell: str) -> str:
    """Return a caption, or the last words of a tour, as HTML."""
    if caption is None:
        return markup.block(markup.text(farewell), _FRAME) if farewell else ""
    stage = f"<b>Tour {caption.number}/{caption.of}</b> "
    return markup.block(stage + markup.text(caption.words), _FRAME)
