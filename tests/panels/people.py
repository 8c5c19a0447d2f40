"""A person's hand on a control, without a browser: what viser calls when one is used."""

from types import SimpleNamespace
from typing import Any

import viser


def use(control: viser.GuiInputHandle[Any], value: object = True) -> None:
    """Set a control to a value as a person does: its listeners hear of a client."""
    control._impl.value = value  # as viser does before it calls
    event = SimpleNamespace(client=object(), client_id=1, target=control)
    for hear in list(control._impl.update_cb):
        hear(event)
