"""Who may send frames, and from where: address, token, and browsers' pages of other sites."""

import hmac
import ipaddress
import re
import socket
from dataclasses import dataclass
from urllib.parse import parse_qs, urlsplit

from studio.engine.errors import StudioError

STREAM_PORT = 8765  # where the studio takes live streams, and where our publishers send them
LOOPBACK = "127.0.0.1"
SHORTEST_TOKEN = 8  # characters; nobody should guess it by hand
_LAST_PORT = 65535
_HOST_AND_PORT = re.compile(r"(\[(?P<numbers>[^\[\]]+)\]|(?P<name>[^:\[\]]+)):(?P<port>[0-9]{1,5})")


@dataclass(frozen=True)
class Address:
    """Where to listen for live streams."""

    host: str = LOOPBACK
    port: int = STREAM_PORT  # 0: any that is free

    @classmethod
    def parse(cls, text: str, option: str = "--listen") -> "Address":
        """Return the address that ``HOST:PORT`` names; raise StudioError where it names none.

        ``option`` is the command line's that says it.
        """
        found = _HOST_AND_PORT.fullmatch(text)
        port = -1 if found is None else int(found["port"])
        if found is None or port > _LAST_PORT:
            # With two colons or more one cannot tell where a bare address ends.
            sixth = f" (IPv6 in brackets: [::1]:{STREAM_PORT})" if text.count(":") > 1 else ""
            raise StudioError(
                f"{option}: expected HOST:PORT, such as {LOOPBACK}:{STREAM_PORT}{sixth}, "
                f"found {text!r:.80}"
            )
        return cls(found["numbers"] or found["name"], port)

    def __str__(self) -> str:
        """Return HOST:PORT."""
        return f"{f'[{self.host}]' if ':' in self.host else self.host}:{self.port}"

    @property
    def url(self) -> str:
        """The address to send to; of all this machine's, the one by its name."""
        host = socket.gethostname() if self.host in ("0.0.0.0", "::") else self.host
        return f"ws://{Address(host, self.port)}"


def is_loopback(host: str) -> bool:
    """Tell whether a host's name or number means this very machine."""
    if host.lower() == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def check_address(address: Address, token: str | None, option: str = "--listen") -> None:
    """Raise StudioError where strangers could move the robot: beyond loopback without a token."""
    if token is not None and len(token) < SHORTEST_TOKEN:
        raise StudioError(f"--token: {SHORTEST_TOKEN} characters or more, so that none guesses it")
    if token is None and not is_loopback(address.host):
        raise StudioError(
            f"{option} {address}: beyond this machine a token is needed, since whoever connects "
            f"moves the robot: add --token with {SHORTEST_TOKEN} characters or more (or set "
            f"STUDIO_TOKEN, which others cannot see), or listen on {LOOPBACK}:{address.port}"
        )


def check_url(url: str) -> None:
    """Raise StudioError where frames cannot be sent to ``url``, the value of ``--to``."""
    try:
        parts = urlsplit(url)
        is_one = parts.scheme in ("ws", "wss") and bool(parts.hostname) and parts.port != 0
    except ValueError:  # such as a port that is no number
        is_one = False
    if not is_one:
        raise StudioError(f"--to: expected an address such as {Address().url}, found {url!r:.80}")


def refusal(path: str, authorization: str, origin: str | None, token: str | None) -> str:
    """Return why a connection may not be made, or nothing.

    Parameters
    ----------
    path : str
        Of the request, with its query.
    authorization, origin
        These headers of the request; the first empty, the second None where they are absent.
    token : str or None
        What has to be presented, if anything.
    """
    if token is not None:
        given = parse_qs(urlsplit(path).query).get("token", [""])[0]
        if authorization.lower().startswith("bearer "):
            given = authorization[len("bearer ") :].strip()
        # In constant time: how long the answer takes must not tell how much of it is right.
        # A header's bytes beyond ASCII come as surrogates; they are the token's in UTF-8.
        if hmac.compare_digest(given.encode(errors="surrogateescape"), token.encode()):
            return ""
        return "this studio wants its token: ws://.../?token=... or Authorization: Bearer ..."
    # A browser lets any page that a person visits connect to this machine, and says in Origin
    # which page it is. Without a token to know, no other site's page may move the robot; programs
    # that are no browsers send no Origin.
    if origin is not None and not is_loopback(_host_of(origin)):
        return "a page of another site may connect only where the studio has a token"
    return ""


def _host_of(origin: str) -> str:
    try:
        return urlsplit(origin).hostname or ""
    except ValueError:
        return ""
