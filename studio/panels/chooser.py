"""A dropdown of the listed demonstrations; two panels have one, and both show the same choice."""

import viser

from studio.engine import commands
from studio.engine.snapshot import Snapshot
from studio.panels.inputs import Post, on_choice, show_value
from studio.panels.readiness import described

_NONE = "none yet"


class DemonstrationChooser:
    """See the module."""

    def __init__(self, gui: viser.GuiApi, label: str, post: Post) -> None:
        self._names: tuple[str, ...] = (_NONE,)
        self._drawn: object = None
        self._dropdown = gui.add_dropdown(label, self._names, disabled=True)
        on_choice(self._dropdown, lambda: post(commands.Choose(self.index)))

    @property
    def index(self) -> int:
        """Which one the dropdown shows, counted from 0."""
        return self._names.index(self._dropdown.value)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        names = tuple(described(now.entries, i) for i in range(len(now.entries))) or (_NONE,)
        # Only what has changed, or has been refused: a choice just made is on its way.
        state = (names, now.chosen, now.message.number)
        if state == self._drawn:
            return
        self._drawn = state
        if names != self._names:
            self._names = names
            self._dropdown.options = names
        show_value(self._dropdown, names[max(now.chosen, 0)])
        self._dropdown.disabled = not now.entries
