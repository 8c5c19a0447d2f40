"""Over real connections: what a browser that only watches changes, it finds as it was."""

import contextlib
import io
from functools import partial

import msgspec
import pytest
import viser
import zstandard
from viser import _messages
from websockets.sync.client import connect

from studio.panels.control import Control
from studio.panels.dragging import Drag, in_the_picture
from studio.panels.visitors import receive

MOMENT = 20.0  # [s] a busy machine may take


class Page:
    """A browser's connection, without the browser."""

    def __init__(self, connection) -> None:
        self._connection = connection

    def changes(self, control, value: object) -> None:
        self._send(_messages.GuiUpdateMessage(control._impl.uuid, {"value": value}))

    def drags(self, phase: str, x: float) -> None:
        place, on_screen = (x, 0.0, 0.0), (0.5, 0.5)
        self._send(
            _messages.SceneNodeDragMessage(
                phase, "/ball", None, place, on_screen, place, on_screen, "left", None
            )
        )

    def hears(self, control) -> object:
        """Wait for the next value that it is told of a control, and return it."""
        while True:
            for message in _messages_in(self._connection.recv(timeout=MOMENT)):
                if message["type"] == "GuiUpdateMessage" and message["uuid"] == control._impl.uuid:
                    return message["updates"]["value"]

    def _send(self, message) -> None:
        self._connection.send(msgspec.msgpack.encode(message.as_serializable_dict()))


def _messages_in(frame: bytes) -> list[dict]:
    """Return what stands in a frame: its two lengths, then packed messages."""
    packed = frame[16 : 16 + int.from_bytes(frame[8:16], "little")]
    return msgspec.msgpack.decode(zstandard.decompress(packed))["messages"]


@pytest.fixture
def server():
    with contextlib.redirect_stdout(io.StringIO()):
        made = viser.ViserServer("127.0.0.1", 0, verbose=False)
        receive(made, "127.0.0.1")
        yield made
        made.stop()


@pytest.fixture
def pages(server):
    url, speaks = f"ws://127.0.0.1:{server.get_port()}", f"viser-v{viser.__version__}"
    open_one = partial(connect, url, subprotocols=[speaks], proxy=None, max_size=None)
    with open_one() as first, open_one() as second:
        yield Page(first), Page(second)


def test_a_watchers_change_is_undone_on_its_own_page(server, pages) -> None:
    Control(server, lambda _: None, lambda: 0.0)
    box = server.gui.add_checkbox("Strip names", False)
    first, second = pages
    first.changes(box, True)
    assert second.hears(box) is True
    second.changes(box, False)
    assert second.hears(box) is True
    assert box.value
    first.changes(box, False)
    assert second.hears(box) is False
    assert not box.value


def test_a_watcher_drags_nothing(server, pages) -> None:
    Control(server, lambda _: None, lambda: 0.0)
    ball, dropped = server.scene.add_icosphere("/ball", radius=0.1), []
    Drag(ball, {None: in_the_picture}, lambda place, is_over: dropped.append((place[0], is_over)))
    mark = server.gui.add_number("Mark", 0)  # what is heard is in order
    first, second = pages
    first.drags("start", 1.0)
    first.drags("update", 2.0)
    first.changes(mark, 1)
    assert second.hears(mark) == 1
    for phase in ("start", "update", "end"):
        second.drags(phase, 9.0)
    second.changes(mark, 7)
    assert second.hears(mark) == 1
    first.drags("end", 3.0)
    first.changes(mark, 2)
    assert second.hears(mark) == 2
    assert [end for _, end in dropped] == [False, False, True]
    assert all(place < 9.0 for place, _ in dropped)
