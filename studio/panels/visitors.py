"""Only a page that the studio itself has served may steer it, and is heard from the first click.

A browser lets any page that a person visits connect to this machine, and says in ``Origin`` which
page it is. viser looks at neither that nor ``Host``, so each connection is looked at here, before
anything that it sends is. Other sites' are turned away.
"""

import contextlib
from urllib.parse import urlsplit

import viser
from viser import _messages
from viser.infra import ClientId, WebsockClientConnection
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode

from studio.engine.live.access import is_loopback

_WHY = "this page was not served by the studio: open the address that the studio prints"
_NOWHERE = _messages.ViewerCameraMessage(
    wxyz=(1.0, 0.0, 0.0, 0.0),
    position=(0.0, 0.0, 0.0),
    fov=1.0,
    near=0.1,
    far=100.0,
    image_height=1,
    image_width=1,
    look_at=(0.0, 0.0, 1.0),
    up_direction=(0.0, 0.0, 1.0),
)


def receive(server: viser.ViserServer, bound: str) -> None:
    """Let in our own pages alone; whoever is connected already has to come again.

    ``bound`` is the address that the studio listens on.
    """
    # viser has no public way to a connection's request, nor to its server before that has begun.
    sockets = server._websock_server

    async def check(visitor: WebsockClientConnection) -> None:
        connection = sockets._live_connections[visitor.client_id]
        asked = connection.request
        headers = Headers() if asked is None else asked.headers
        origins, hosts = headers.get_all("Origin"), headers.get_all("Host")
        if asked is None or is_stranger(origins, hosts, bound):
            await connection.close(CloseCode.POLICY_VIOLATION, _WHY)
            with contextlib.suppress(ConnectionClosed):
                while True:  # what it has sent already is never handled
                    await connection.recv()
            return
        # viser drops all that a page asks for before it has told its camera, with its first
        # picture: seconds after its buttons are there, without a graphics card. Until then it has
        # one that looks nowhere.
        await visitor._handle_incoming_message(ClientId(visitor.client_id), _NOWHERE)

    sockets.on_client_connect(check)
    sockets.disconnect_all_clients()


def is_stranger(origins: list[str], hosts: list[str], bound: str) -> bool:
    """Tell whether a page of another site asks, by all ``Origin`` and ``Host`` of its request.

    Where the server is ``bound`` to this machine alone, it has to be called by a name of this
    machine: another name that leads here is some site's. Programs send no ``Origin``, and may ask.
    """
    if not origins:
        return False
    if len(origins) > 1 or len(hosts) != 1:
        return True
    try:
        page, asked = urlsplit(origins[0]), urlsplit(f"//{hosts[0]}")
        name = asked.hostname or ""
    except ValueError:
        return True
    if not name or page.netloc.lower() != asked.netloc.lower():
        return True
    return is_loopback(bound) and not is_loopback(name)
