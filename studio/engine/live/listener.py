"""Listens for publishers on a WebSocket, in a thread of its own."""

import asyncio
import json
import logging

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode

from studio.engine.live.access import Address
from studio.engine.live.doorway import Doorway, House
from studio.engine.live.reception import LARGEST_MESSAGE, Answer, FloodError, Reception
from studio.engine.live.source import LiveSource

_LOG = logging.getLogger(__name__)
MOST_CONNECTIONS = 8
_ANSWER_WITHIN = 2.0  # [s]; a publisher that does not read must not hold up its own frames for long
_ALIVE_EVERY = 10.0  # [s]; a machine that was switched off does not say goodbye
_QUEUE = 4  # messages
_NOT_READ = (CloseCode.MESSAGE_TOO_BIG, CloseCode.INVALID_DATA, CloseCode.PROTOCOL_ERROR)
_HOUSE = House(
    "publishers",
    "live streams",
    "--listen",
    MOST_CONNECTIONS,
    LARGEST_MESSAGE,
    _QUEUE,
    _ALIVE_EVERY,
)


class Listener:
    """A context manager: it listens from entering to leaving it.

    Parameters
    ----------
    source
        Where the driver's frames go.
    address
        Where to listen.
    token
        What publishers have to present. Without one, only this machine's are taken.
    next_free
        Whether to take one of the next ports where that one is taken.

    Raises
    ------
    StudioError
        Where the address is beyond this machine and there is no token, or the token is too short;
        on entering, where it can't be listened at.
    """

    def __init__(
        self,
        source: LiveSource,
        address: Address = Address(),  # noqa: B008 - frozen
        token: str | None = None,
        next_free: bool = False,
    ) -> None:
        self._source, self._reception = source, Reception(source, source.now)
        self._numbered = 0
        self._doorway = Doorway(_HOUSE, address, token, self._handle, self._tell, next_free)

    @property
    def address(self) -> Address:
        """Where it listens."""
        return self._doorway.address

    def __enter__(self) -> "Listener":
        self._doorway.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        self._doorway.__exit__()

    async def _handle(self, connection: ServerConnection) -> None:
        """Serve one publisher until it leaves."""
        self._numbered += 1
        self._tell(self.address)
        host, port = (connection.remote_address or ("gone", 0))[:2]
        publisher, greeting = self._reception.welcome(f"Publisher {self._numbered} ({host}:{port})")
        try:
            await _answer(connection, greeting)
            async for message in connection:
                answer = self._reception.receive(publisher, message)
                if answer is not None:
                    await _answer(connection, answer)
        except FloodError as error:
            await connection.close(CloseCode.POLICY_VIOLATION, str(error))
        except ConnectionClosed as closed:
            if closed.sent is not None and closed.sent.code in _NOT_READ:
                self._source.count("unreadable")
        except TimeoutError:
            await connection.close(CloseCode.POLICY_VIOLATION, "does not read its answers")
        except Exception:  # of one connection; the others, and the robot, go on
            _LOG.exception("a live connection has failed")
        finally:
            self._reception.leave(publisher)
            self._tell(self.address, leaving=1)

    def _tell(self, address: Address, leaving: int = 0) -> None:
        self._source.connect(address.url, self._doorway.connected - leaving)


async def _answer(connection: ServerConnection, answer: Answer) -> None:
    async with asyncio.timeout(_ANSWER_WITHIN):
        await connection.send(json.dumps(answer))
