"""What all browsers share is changed by the one that controls, and by no other.

viser sets a control to what any browser sends, and tells all the others, before a callback can
refuse; a dragged node follows any pointer. So a change is looked at here before viser takes it.
Buttons and palette go through: what they ask for is refused, or not, as a command.
"""

from collections.abc import Callable
from typing import Any

import viser
from viser import _messages
from viser.infra import ClientId, Message


def keep_shared(server: viser.ViserServer, may_change: Callable[[int], bool]) -> None:
    """Take changes from those browsers alone that ``may_change``, by their numbers.

    The others are shown again what holds.
    """
    # viser has no other way in: a callback comes too late.
    sockets = server._websock_server
    take, draggers = sockets._handle_incoming_message, set[int]()

    async def look_first(client: ClientId, message: Message) -> None:
        if isinstance(message, _messages.SceneNodeDragMessage):
            if not _goes_on(draggers, client, message.phase, may_change):
                return
        elif isinstance(message, _messages.GuiUpdateMessage):
            control = _control(server.gui, message.uuid)
            if control is not None and not may_change(client):
                _show_again(server, client, control, message)
                return
        await take(client, message)

    sockets._handle_incoming_message = look_first  # type: ignore[assignment, method-assign]


def _goes_on(
    draggers: set[int], client: int, phase: str, may_change: Callable[[int], bool]
) -> bool:
    """Tell whether a drag is to be heard of: where it was allowed to begin, its end always is."""
    if phase == "end":
        went_on = client in draggers
        draggers.discard(client)
        return went_on
    if not may_change(client):
        return False
    draggers.add(client)
    return True


def _control(gui: viser.GuiApi, uuid: str) -> Any:
    """Return the state of a control that all share and that holds a value; None of others."""
    handle = gui._gui_input_handle_from_uuid.get(uuid)
    return None if handle is None or handle._impl.is_button else handle._impl


def _show_again(
    server: viser.ViserServer, client: int, control: Any, change: _messages.GuiUpdateMessage
) -> None:
    browser = server.get_clients().get(client)
    if browser is not None:
        held = {name: getattr(control, name) for name in change.updates}
        browser._websock_connection.queue_message(_messages.GuiUpdateMessage(change.uuid, held))
