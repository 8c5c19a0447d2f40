"""A WebSocket server that takes down what a publisher sends."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from websockets.sync.server import ServerConnection, serve


@dataclass
class Listening:
    """What a server has heard."""

    port: int = 0
    messages: list[str] = field(default_factory=list)

    @property
    def url(self) -> str:
        return f"ws://127.0.0.1:{self.port}"

    def wait_for(self, count: int, seconds: float = 20.0) -> bool:
        """Wait for so many messages; return whether they came."""
        end = time.monotonic() + seconds
        while len(self.messages) < count and time.monotonic() < end:
            time.sleep(0.01)
        return len(self.messages) >= count


@contextmanager
def listening(port: int = 0, answer: str = "") -> Iterator[Listening]:
    """Listen on loopback; say ``answer`` to each publisher's first message."""
    heard = Listening()
    connections: list[ServerConnection] = []

    def handle(connection: ServerConnection) -> None:
        connections.append(connection)
        for number, message in enumerate(connection):
            heard.messages.append(str(message))
            if answer and not number:
                connection.send(answer)

    with serve(handle, "127.0.0.1", port) as server:
        heard.port = server.socket.getsockname()[1]
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield heard
        finally:
            server.shutdown()
            thread.join()
            for connection in connections:
                connection.close()
