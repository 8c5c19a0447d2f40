"""A robot's address, as people type it, and the link that it means."""

from collections.abc import Callable
from urllib.parse import urlsplit

from studio.engine.errors import StudioError
from studio.engine.links.coppeliasim import DEFAULT_MODEL, CoppeliaSim
from studio.engine.links.link import RobotLink
from studio.engine.links.rosbridge import Rosbridge
from studio.engine.links.simulated import SimulatedRobot

PORTS = {"rosbridge": 9090, "coppeliasim": 23000}
EXAMPLES = "rosbridge://HOST:9090, coppeliasim://HOST:23000 or simulated://"


def link_at(url: str, now: Callable[[], float]) -> RobotLink:
    """Return the link, not open yet; ``now`` is any clock [s].

    Raises
    ------
    StudioError
        Where the address names none.
    """
    try:
        parts = urlsplit(url.strip())
        host, port = parts.hostname, parts.port
    except ValueError:
        raise _unknown(url) from None
    if parts.scheme == "simulated":
        return SimulatedRobot(url, now)
    if parts.scheme not in PORTS or not host:
        raise _unknown(url)
    port = PORTS[parts.scheme] if port is None else port
    if parts.scheme == "rosbridge":
        return Rosbridge(url, host, port, now)
    return CoppeliaSim(url, host, port, parts.path.strip("/") or DEFAULT_MODEL, now)


def _unknown(url: str) -> StudioError:
    return StudioError(f"a robot's address is {EXAMPLES}, not {url!r:.80}")
