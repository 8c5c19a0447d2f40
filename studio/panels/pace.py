"""Whether the studio keeps up: how many of the ticks were made, and how many never will be."""

import viser

from studio.engine.pace import Pace
from studio.engine.robot import CONTROL_RATE
from studio.panels import markup

BEHIND = 0.95  # of the ticks that were due; below, whoever looks should know


class PaceLine:
    """One line; ``always`` in sight, or else only while the studio falls behind."""

    def __init__(self, gui: viser.GuiApi, always: bool) -> None:
        self._always = always
        self._line = gui.add_html("", visible=always)

    def draw(self, pace: Pace) -> None:
        """Show it."""
        self._line.content = markup.note(in_words(pace))
        self._line.visible = self._always or pace.share < BEHIND


def in_words(pace: Pace) -> str:
    """Return how well a loop keeps up, with a shape."""
    made = f"{CONTROL_RATE * pace.share:.0f} of {CONTROL_RATE} ticks a second"
    skipped = f"{pace.skipped:,} skipped" if pace.skipped else "none skipped"
    return f"▲ Too busy: {made}, {skipped}." if pace.share < BEHIND else f"✔ {made}, {skipped}."
