"""One address: our page first, all else to viser, byte for byte, and no crash whoever calls."""

import contextlib
import gzip
import http.client
import socket
from collections import deque

import pytest
import viser
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from studio.engine.errors import StudioError
from studio.panels.first_page import NO_WEBGL, TITLE, checked
from studio.panels.front import Front

PATIENCE = 20.0  # [s]


@pytest.fixture(scope="module")
def server():
    made = viser.ViserServer("127.0.0.1", 0, verbose=False)
    made.gui.add_markdown("hello")
    yield made
    made.stop()


@pytest.fixture
def front(server):
    made = Front(server.get_event_loop(), "127.0.0.1", 0, server.get_port())
    yield made
    made.close()


def get(port: int, path: str, **headers: str) -> tuple[http.client.HTTPResponse, bytes]:
    line = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    try:
        line.request("GET", path, headers=headers)
        answer = line.getresponse()
        return answer, answer.read()
    finally:
        line.close()


def test_the_page_looks_at_the_browser_before_all_else(front: Front, server) -> None:
    answer, page = get(front.port, "/?fixedDpr=1")
    _, plain = get(server.get_port(), "/")
    assert answer.status == 200
    text = page.decode()
    assert text.index('"webgl2"') < text.index("<title>") < text.index("data-p=")
    assert f"<title>{TITLE}</title>" in text
    assert text == checked(plain.decode())
    packed, content = get(front.port, "/", **{"Accept-Encoding": "gzip"})
    assert packed.getheader("Content-Encoding") == "gzip"
    assert gzip.decompress(content) == page


def test_who_cannot_draw_is_told_what_helps(front: Front) -> None:
    answer, page = get(front.port, "/no-webgl")
    assert answer.status == 200
    assert page.decode() == NO_WEBGL
    for words in ("WebGL 2", "another browser", "graphics acceleration", "Try again"):
        assert words in NO_WEBGL
    assert "<script" not in NO_WEBGL


def test_all_else_is_visers(front: Front, server) -> None:
    for path in ("/nowhere.js", "/..%2fsecret", "/index.html"):
        through, content = get(front.port, path)
        straight, same = get(server.get_port(), path)
        assert (through.status, content) == (straight.status, same)


def test_a_websocket_speaks_through_it_both_ways(front: Front, server) -> None:
    subprotocol = f"viser-v{viser.__version__}"
    with connect(
        f"ws://127.0.0.1:{front.port}", subprotocols=[subprotocol], max_size=None
    ) as socket_:
        first = socket_.recv(timeout=PATIENCE)
        assert isinstance(first, bytes)
        server.gui.add_markdown("later")  # and another message
        assert socket_.recv(timeout=PATIENCE)
        assert len(server._websock_server._live_connections) == 1


def test_a_busy_port_is_left_alone(server) -> None:
    with socket.socket() as busy:
        busy.bind(("127.0.0.1", 0))
        busy.listen()
        taken = busy.getsockname()[1]
        front = Front(server.get_event_loop(), "127.0.0.1", taken, server.get_port())
        assert front.port > taken
        front.close()


def test_an_address_of_somebody_else_is_said(server) -> None:
    with pytest.raises(StudioError, match="cannot be served here"):
        Front(server.get_event_loop(), "192.0.2.1", 8080, server.get_port())


@pytest.mark.parametrize(
    "sent", [b"", b"\r\n\r\n", b"\xff\xfe\r\n\r\n", b"GET /\r\n\r\n", b"x" * 200_000]
)
def test_nonsense_is_answered_or_hung_up_on(front: Front, sent: bytes) -> None:
    with (
        socket.create_connection(("127.0.0.1", front.port), timeout=PATIENCE) as line,
        contextlib.suppress(OSError),  # it may have hung up long before we are through
    ):
        line.sendall(sent)
        line.shutdown(socket.SHUT_WR)
        while line.recv(1 << 16):
            pass
    assert get(front.port, "/no-webgl")[0].status == 200


def test_closing_hangs_up(server) -> None:
    front = Front(server.get_event_loop(), "127.0.0.1", 0, server.get_port())
    with connect(
        f"ws://127.0.0.1:{front.port}",
        subprotocols=[f"viser-v{viser.__version__}"],
        max_size=None,
    ) as talk:
        talk.recv(timeout=PATIENCE)
        front.close()
        with pytest.raises(ConnectionClosed):
            deque(iter(lambda: talk.recv(timeout=PATIENCE), None))
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", front.port), timeout=PATIENCE)


def test_a_page_that_is_no_page_stays_as_it_is() -> None:
    assert checked("nothing") == "nothing"
