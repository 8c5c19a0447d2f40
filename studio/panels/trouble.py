"""What went wrong on the page's own side, in words; whatever else is to be done goes on.

A fault in one panel would otherwise end the thread that draws all of them, and every page would
stand still without a word.
"""

import queue
from collections.abc import Callable

import viser

from studio.engine.errors import StudioError
from studio.engine.faults import Faults
from studio.panels import markup

SHOWN = 300  # drawings, half a minute, after the newest trouble
_GOES_ON = (
    "the robot and whatever is recorded go on, but something on this page may be missing or old: "
    "reload it"
)

Attempt = Callable[[Callable[[], None]], None]  # do something that may fail


class TroubleLine:
    """See the module. Any thread may attempt something; one draws."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._line = gui.add_html("", visible=False)
        self._faults = Faults(_GOES_ON)
        self._told: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._left = 0  # drawings for which the newest is still shown

    def attempt(self, work: Callable[[], None]) -> None:
        """Do some work; an error is told instead of raised, a fault of ours logged, too."""
        try:
            work()
        except StudioError as error:
            self._told.put(str(error))
        except Exception as fault:
            self._told.put(self._faults.in_words(fault))

    def draw(self) -> None:
        """Show what was told lately."""
        while not self._told.empty():
            self._line.content, self._line.visible = markup.problem(self._told.get()), True
            self._left = SHOWN
        if self._left:
            self._left -= 1
            self._line.visible = self._left > 0
