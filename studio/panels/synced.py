"""A control that shows the session's value, unless a person has only just changed it.

What was changed is on its way for a moment, and may be refused: then the session's value is shown
again. So nobody's typing is overwritten, and no control goes on showing what is not so.
"""

from collections.abc import Callable
from typing import Any

import viser

from studio.panels.inputs import on_choice, show_value


class Synced:
    """See the module.

    Parameters
    ----------
    control
        What people change.
    act
        Is called when they do.
    patience
        Drawings, 10 a second, for which a change stands that the session has not taken.
    """

    def __init__(
        self, control: viser.GuiInputHandle[Any], act: Callable[[], None], patience: int = 10
    ) -> None:
        self.control, self._act = control, act
        self._patience, self._left = patience, 0
        on_choice(control, self._changed)

    def show(self, value: object, is_same: Callable[[Any], bool] | None = None) -> None:
        """Show the session's value, if the control's is not the same."""
        shown = self.control.value
        if shown == value if is_same is None else is_same(shown):
            return
        if self._left > 0:
            self._left -= 1
        else:
            show_value(self.control, value)

    def forget(self) -> None:
        """Show the session's value from now on: the control is about something else."""
        self._left = 0

    def _changed(self) -> None:
        self._left = self._patience
        self._act()
