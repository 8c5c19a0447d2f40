"""Pages of other sites, in the same browser, are turned away before they see or steer anything."""

import contextlib
import io
import threading

import msgspec
import pytest
import viser
from viser import _messages
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from studio.panels.visitors import is_stranger, receive


@pytest.mark.parametrize(
    ("origin", "host"),
    [
        ("http://localhost:8080", "localhost:8080"),
        ("http://127.0.0.1:8080", "127.0.0.1:8080"),
        ("http://[::1]:8080", "[::1]:8080"),
        ("http://LOCALHOST:8080", "localhost:8080"),
        ("https://localhost", "localhost"),
    ],
)
def test_our_own_pages_are_let_in(origin: str, host: str) -> None:
    for bound in ("127.0.0.1", "localhost", "0.0.0.0"):
        assert not is_stranger([origin], [host], bound)


@pytest.mark.parametrize(
    ("origin", "host"),
    [
        ("https://example.org", "localhost:8080"),
        ("http://localhost:8081", "localhost:8080"),  # another server on this machine
        ("http://localhost:8080.example.org", "localhost:8080"),
        ("null", "localhost:8080"),
        ("", ""),
        ("http://[", "["),
        ("file://", "localhost:8080"),
        ("http://rebound.example.org:8080", "rebound.example.org:8080"),
    ],
)
def test_pages_of_other_sites_are_not(origin: str, host: str) -> None:
    assert is_stranger([origin], [host], "127.0.0.1")


def test_beyond_this_machine_any_name_may_be_ours_but_not_another_page() -> None:
    assert not is_stranger(["http://lab:8080"], ["lab:8080"], "0.0.0.0")
    assert is_stranger(["http://other:8080"], ["lab:8080"], "0.0.0.0")


def test_programs_are_let_in_and_doubled_headers_are_not() -> None:
    assert not is_stranger([], ["localhost:8080"], "127.0.0.1")
    ours = "http://localhost:8080"
    assert is_stranger([ours, ours], ["localhost:8080"], "127.0.0.1")
    assert is_stranger([ours], ["localhost:8080"] * 2, "127.0.0.1")
    assert is_stranger([ours], [], "127.0.0.1")


@pytest.fixture
def server():
    with contextlib.redirect_stdout(io.StringIO()):
        made = viser.ViserServer("127.0.0.1", 0, verbose=False)
        receive(made, "127.0.0.1")
        made.gui.add_button("steers")
        yield made
        made.stop()


def visit(server: viser.ViserServer, origin: str | None):
    return connect(
        f"ws://127.0.0.1:{server.get_port()}",
        origin=origin,
        subprotocols=[f"viser-v{viser.__version__}"],
        proxy=None,
        max_size=None,
    )


def test_a_strangers_connection_ends_and_it_is_shown_nothing(server) -> None:
    with visit(server, "https://example.org") as page:
        with contextlib.suppress(ConnectionClosed):
            page.send(b"steer")
        with pytest.raises(ConnectionClosed) as closed:
            page.recv(timeout=10.0)
    assert closed.value.rcvd.code == 1008
    assert "not served by the studio" in closed.value.rcvd.reason
    for origin in (None, f"http://127.0.0.1:{server.get_port()}"):
        with visit(server, origin) as page:
            assert page.recv(timeout=10.0) != b""


def test_a_click_before_the_first_picture_is_heard(server) -> None:
    heard = threading.Event()
    button = server.gui.add_button("Record")
    button.on_click(lambda _: heard.set())
    click = _messages.GuiUpdateMessage(button._impl.uuid, {"value": True})
    with visit(server, None) as page:
        page.send(msgspec.msgpack.encode(click.as_serializable_dict()))
        assert heard.wait(20.0)
