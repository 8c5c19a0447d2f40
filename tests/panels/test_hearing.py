"""Callbacks know the browser that they work for, and no other thread believes to."""

import asyncio
import threading
from types import SimpleNamespace

import pytest
import viser
from viser import _messages

from studio.panels.hearing import hear, speaker


@pytest.fixture
def server():
    made = viser.ViserServer("127.0.0.1", 0, verbose=False)
    hear(made)
    yield made
    made.stop()


def test_a_click_is_heard_as_its_browsers(server) -> None:
    """Through viser's own way from a message to a callback, as far as there is no browser."""
    heard, done = [], threading.Event()
    button = server.gui.add_button("Press")

    @button.on_click
    def _(event: viser.GuiEvent) -> None:
        heard.append((speaker(), event.client_id))
        done.set()

    for client in (4, 9):
        server._connected_clients[client] = SimpleNamespace(client_id=client)
        done.clear()
        message = _messages.GuiUpdateMessage(button._impl.uuid, {"value": True})
        asyncio.run_coroutine_threadsafe(
            server.gui._handle_gui_updates(client, message), server.get_event_loop()
        ).result()
        assert done.wait(20.0)
    server._connected_clients.clear()
    assert heard == [(4, 4), (9, 9)]
    assert speaker() is None


def test_a_command_of_the_palette_too(server) -> None:
    heard, done = [], threading.Event()
    entry = server.gui.add_command("Stop", hotkey="escape")

    @entry.on_trigger
    def _(_: viser.CommandEvent) -> None:
        heard.append(speaker())
        done.set()

    server._connected_clients[3] = SimpleNamespace(client_id=3)
    asyncio.run_coroutine_threadsafe(
        server.gui._handle_command_trigger(3, _messages.CommandTriggerMessage(entry._impl.uuid)),
        server.get_event_loop(),
    ).result()
    assert done.wait(20.0)
    server._connected_clients.clear()
    assert heard == [3]


def test_who_is_nobodys_is_so_again(server) -> None:
    threads = server.gui._thread_executor
    assert threads.submit(lambda _: speaker(), SimpleNamespace(client_id=5)).result() == 5
    assert threads.submit(speaker).result() is None
