"""How panels listen to people."""

from collections.abc import Callable
from typing import Any

import viser

from studio.engine.commands import Command

Post = Callable[[Command], None]  # put a command into the session's inbox


def on_choice(control: viser.GuiInputHandle[Any], act: Callable[[], None]) -> None:
    """Call ``act`` when a person changes a control, not when a panel does (no client, then)."""

    @control.on_update
    def _changed(event: viser.GuiEvent[Any]) -> None:
        if event.client is not None:
            act()


def show_value(control: viser.GuiInputHandle[Any], value: object) -> None:
    """Show a value in a control; `on_choice` does not hear of it."""
    # viser puts a method between the property and its setter, so mypy sees no setter.
    control.value = value  # type: ignore[misc]
