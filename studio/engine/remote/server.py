"""Lets programs in on a WebSocket: the sockets of `reception`, in a thread of their own."""

import asyncio
import contextlib
import logging
from collections.abc import Callable
from functools import partial

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode

from studio.engine import commands
from studio.engine.clock import LiveLoop, now
from studio.engine.live.access import LOOPBACK, Address
from studio.engine.live.doorway import Doorway, House
from studio.engine.remote.guest import Guest
from studio.engine.remote.reading import LARGEST_MESSAGE
from studio.engine.remote.reception import LeaveError, Reception
from studio.engine.seat import Seat
from studio.engine.snapshot import Snapshot

_LOG = logging.getLogger(__name__)
REMOTE_PORT = 8766  # where programs reach the studio, unless told otherwise
MOST_PROGRAMS = 8
_SEND_WITHIN = 5.0  # [s]; who reads nothing for so long is gone
_ALIVE_EVERY = 5.0  # [s]
_QUEUE = 16  # messages
_LOOK_EVERY = 0.1  # [s]
Overheard = Callable[[str, str], None]  # "asked" or "told", and the message

_HOUSE = House(
    who="programs",
    what="programs",
    option="--remote",
    most=MOST_PROGRAMS,
    largest=LARGEST_MESSAGE,
    queue=_QUEUE,
    alive_every=_ALIVE_EVERY,
)


class RemoteServer:
    """A context manager: programs are let in from entering to leaving it.

    Parameters
    ----------
    loop
        A loop that runs, and goes on running for as long as this is entered.
    seat
        Who controls, shared with the browser's page.
    address, token
        Where to listen, and what has to be presented there. Without a token only this machine's
        programs are let in.
    overhear
        Is told every message that comes or goes, whatever it is, on the server's thread.

    Raises
    ------
    StudioError
        As `Doorway` does.
    """

    def __init__(
        self,
        loop: LiveLoop,
        seat: Seat,
        address: Address = Address(LOOPBACK, REMOTE_PORT),  # noqa: B008 - frozen
        token: str | None = None,
        overhear: Overheard | None = None,
    ) -> None:
        self._loop, self._overhear = loop, overhear
        self._look_failed = False  # which is said once
        self._doorway = Doorway(
            _HOUSE, address, token, self._handle, lambda _: None, beside=self._look
        )
        self._reception = Reception(
            lambda: loop.session, loop.steps, seat, now, self._doorway.later
        )

    @property
    def address(self) -> Address:
        """Where it listens."""
        return self._doorway.address

    def __enter__(self) -> "RemoteServer":
        self._doorway.__enter__()
        self._loop.watch(self._ticked)
        return self

    def __exit__(self, *_: object) -> None:
        self._doorway.__exit__()
        self._reception.close()

    def _ticked(self, snapshot: Snapshot) -> None:
        """Hear of a tick, on the loop's thread."""
        if self._loop.steps.is_held:  # who asks for a tick is alive
            self._loop.session.post(commands.SetJointTarget())
        self._doorway.later(partial(self._reception.ticked, snapshot))

    async def _look(self) -> None:
        while True:
            await asyncio.sleep(_LOOK_EVERY)
            self._look_once()

    def _look_once(self) -> None:
        try:
            self._reception.look()
        except Exception:  # of one look: control is handed over by the next ones
            if not self._look_failed:
                _LOG.exception("what is due ten times a second has failed")
            self._look_failed = True

    async def _handle(self, connection: ServerConnection) -> None:
        """Serve one program until it leaves."""
        host = str((connection.remote_address or ("an unknown place", 0))[0])
        waiting = asyncio.Event()
        guest = self._reception.welcome(host, waiting.set)
        sending = asyncio.create_task(self._send(connection, guest, waiting))
        try:
            async for message in connection:
                if self._overhear is not None:
                    self._overhear("asked", str(message))
                self._reception.receive(guest, message)
        except LeaveError as error:
            await connection.close(CloseCode.POLICY_VIOLATION, str(error))
        except ConnectionClosed:
            pass
        except Exception:  # of one connection; the others, and the robot, go on
            _LOG.exception("a program's connection has failed")
            await connection.close(CloseCode.INTERNAL_ERROR, "the studio has failed")
        finally:
            sending.cancel()
            self._reception.leave(guest)
            with contextlib.suppress(asyncio.CancelledError):
                await sending

    async def _send(
        self, connection: ServerConnection, guest: Guest, waiting: asyncio.Event
    ) -> None:
        """Send what lies in the guest's outbox, as fast as it reads."""
        try:
            while await waiting.wait():
                waiting.clear()
                while (text := guest.outbox.next()) is not None:
                    await self._tell(connection, text)
        except ConnectionClosed:
            pass
        except TimeoutError:
            await connection.close(CloseCode.POLICY_VIOLATION, "does not read its answers")
        except Exception:  # as in `_handle`, which would wait for messages for ever
            _LOG.exception("an answer to a program cannot be sent")
            await connection.close(CloseCode.INTERNAL_ERROR, "the studio has failed")

    async def _tell(self, connection: ServerConnection, text: str) -> None:
        if self._overhear is not None:
            self._overhear("told", text)
        async with asyncio.timeout(_SEND_WITHIN):
            await connection.send(text)
