"""Only a page that the studio itself has served may steer it: other sites' are turned away.

A browser lets any page that a person visits connect to this machine, and says in ``Origin`` which
page it is. viser looks at neither that nor ``Host``, so each connection is looked at here, before
anything that it sends is.
"""

import contextlib
from urllib.parse import urlsplit

import viser
from viser.infra import WebsockClientConnection
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode

from studio.engine.live.access import is_loopback

_WHY = "this page was not served by the studio: open the address that the studio prints"


def turn_strangers_away(server: viser.ViserServer, bound: str) -> None:
    """Let pages of other sites in no more; whoever is connected already has to come again.

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
