"""A dropdown of the listed demonstrations; wherever there is one, it shows the same choice."""

import viser

from studio.engine import commands
from studio.engine.snapshot import Snapshot
from studio.panels.inputs import Post, on_choice, show_value
from studio.panels.readiness import described

_NONE = "none yet"


class DemonstrationChooser:
    """See the module."""

    def __init__(self, gui: viser.GuiApi, label: str, post: Post) -> None:
        self._post = post
        self._numbers: dict[str, int] = {}  # by what is shown of each
        self._drawn: object = None
        self._dropdown = gui.add_dropdown(label, (_NONE,), disabled=True)
        on_choice(self._dropdown, self._choose)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        numbers = {described(entry): entry.number for entry in now.entries}
        # Only what has changed, or has been refused: a choice just made is on its way.
        state = (numbers, now.chosen, now.message.number)
        if state == self._drawn:
            return
        self._drawn = state
        names = tuple(numbers) or (_NONE,)
        if tuple(self._numbers) != tuple(numbers) or not numbers:
            self._numbers = numbers
            self._dropdown.options = names
        show_value(self._dropdown, names[max(now.chosen, 0)])
        self._dropdown.disabled = not now.entries

    def _choose(self) -> None:
        number = self._numbers.get(self._dropdown.value)
        if number is not None:  # renamed or deleted since
            self._post(commands.Choose(number))
