"""Baxter in CoppeliaSim, V-REP's successor, by its ZeroMQ remote API (extra "coppeliasim").

The calls are those of its manual: sim.getObject by path, sim.getJointPosition,
sim.getJointInterval, sim.setJointTargetPosition, sim.getSimulationState. A running simulation
counts as enabled, a paused one as stopped. All calls of one exchange are made under
sim.acquireLock, so that its server answers them in one of its passes, which come at 20 Hz, and
not a few in each.
"""

import sys
from collections.abc import Callable, Mapping
from typing import Any

from studio.engine.links.driver import STALE
from studio.engine.links.link import ARMS_JOINTS, LinkError, Range, RobotState, positions_of
from studio.engine.robot import ARM_JOINTS, CONTROL_PERIOD, load_robot

DEFAULT_MODEL = "Baxter"
PAUSED, ADVANCING = 0x08, 0x10  # bits of sim.getSimulationState
_ANSWERS_WITHIN = 1.0  # [s]
_FORGETS_US = 2  # [s] after which its server drops whoever died with its lock
_OTHER_WAY = 0.3  # [rad] that mirrored limits may be off, to be known as such
_MISSING = "CoppeliaSim needs the extra coppeliasim: pip install 'teaching-studio[coppeliasim]'"


def paths_of(joint: str, model: str) -> tuple[str, ...]:
    """Return where a joint may be found: by the model's name for it, old or new, or by Baxter's."""
    side, _, short = joint.partition("_")
    number = ARM_JOINTS.index(short) + 1
    own = f"{side}Arm_joint{number}"
    return (f"/{model}/{own}", f"/{model}/{model}_{own}", f"/{model}_{own}", f"/{model}/{joint}")


class CoppeliaSim:
    """The link.

    Parameters
    ----------
    url, host, port
        Where CoppeliaSim's server listens; ``url`` as people typed it.
    model
        The robot's name in the scene.
    now
        Any clock [s].
    """

    def __init__(
        self, url: str, host: str, port: int, model: str, now: Callable[[], float]
    ) -> None:
        self.url, self._host, self._port = url, host, port
        self._model, self._now = model, now
        self.limits: dict[str, Range] = {}
        self._client: Any = None
        self._sim: Any = None
        self._handles: dict[str, int] = {}
        self._commanded: set[str] = set()  # joints, since they were told to hold
        self._seen: RobotState | None = None  # by `stop`, for the next `read`
        self._due = 0.0  # [s] when it is looked at next

    def open(self) -> None:
        """Connect, and find all joints of both arms; LinkError names a missing one."""
        self.close()
        library, zmq = _library()
        before = vars(sys.modules["__main__"]).get("require")
        self._client = client = library.RemoteAPIClient(self._host, self._port)
        _put_back(before)  # it leaves a function of its own there, which would keep it alive
        client.timeout = _FORGETS_US
        _never_late(client.socket, zmq)
        self._sim = self._call(client.require, "sim")
        self._handles = {joint: self._find(joint) for joint in ARMS_JOINTS}
        self.limits, self._commanded, self._seen = self._intervals(), set(), None
        self._due = self._now()

    def read(self) -> RobotState | None:
        """Return how it is, once a control period."""
        seen, self._seen = self._seen, None
        if seen is None and self._now() >= self._due:
            seen = self._look(holds=False)
        return seen

    def send(self, targets: Mapping[str, float]) -> None:
        """Set each joint's target."""
        sim, begun = self._required(), self._now()
        self._commanded |= targets.keys()
        self._call(sim.acquireLock)
        for joint, angle in targets.items():
            if self._now() - begun > STALE:
                raise LinkError(f"{self.url}: CoppeliaSim answers too slowly to be commanded")
            self._call(sim.setJointTargetPosition, self._handles[joint], float(angle))
        self._call(sim.releaseLock)

    def enable(self) -> None:
        """Let its simulation run."""
        self._call(self._required().startSimulation)

    def disable(self) -> None:
        """Pause its simulation: all stands still."""
        self._call(self._required().pauseSimulation)

    def stop(self) -> None:
        """Make the commanded joints' targets where they are: the last ones would lead them on."""
        self._seen = self._look(holds=True)  # one exchange for both, so that no state comes late

    def set_speed(self, ratio: float) -> None:
        """Nothing to tell: the gatekeeper's own cap is the speed."""

    def close(self) -> None:
        """End the connection; the simulation goes on, its targets hold."""
        client, self._client, self._sim = self._client, None, None
        if client is not None:
            client.socket.close(linger=0)

    def _look(self, holds: bool) -> RobotState:
        """Return how it is; ``holds``: and let what was commanded stay there."""
        self._due = self._now() + CONTROL_PERIOD
        sim = self._required()
        self._call(sim.acquireLock)
        state = int(self._call(sim.getSimulationState))
        told = {
            joint: float(self._call(sim.getJointPosition, handle))
            for joint, handle in self._handles.items()
        }
        if holds:
            for joint in sorted(self._commanded):
                self._call(sim.setJointTargetPosition, self._handles[joint], told[joint])
            self._commanded = set()
        self._call(sim.releaseLock)
        paused = "CoppeliaSim's simulation is paused: enabling lets it go on."
        is_paused = bool(state & PAUSED)
        return RobotState(
            positions_of(told), bool(state & ADVANCING), paused if is_paused else "", is_paused
        )

    def _find(self, joint: str) -> int:
        paths = paths_of(joint, self._model)
        for path in paths:
            handle = int(self._call(self._sim.getObject, path, {"noError": True}))
            if handle >= 0:
                return handle
        raise LinkError(
            f"{self.url}: {joint} is not in the scene; looked for {', '.join(paths)}. Drag "
            f"CoppeliaSim's Baxter into it; a name other than {self._model} goes behind the address"
        )

    def _intervals(self) -> dict[str, Range]:
        """Return each joint's own limits; raise LinkError for one that turns the other way."""
        robot, found = load_robot(), {}
        for joint, handle in self._handles.items():
            cyclic, interval = self._call(self._sim.getJointInterval, handle)
            low, high = float(interval[0]), float(interval[0]) + float(interval[1])
            ours = robot.limits_of([joint])
            lower, upper = float(ours.lower[0]), float(ours.upper[0])
            if cyclic:
                continue
            mirrored = max(abs(low + upper), abs(high + lower))
            if mirrored < _OTHER_WAY < max(abs(low - lower), abs(high - upper)):
                raise LinkError(
                    f"{self.url}: {joint} turns the other way in this model: it goes from "
                    f"{low:.2f} to {high:.2f} rad, Baxter's from {lower:.2f} to {upper:.2f}"
                )
            if min(high, upper) - max(low, lower) < (upper - lower) / 2:
                raise LinkError(
                    f"{self.url}: {joint} goes from {low:.2f} to {high:.2f} rad in this model, "
                    f"Baxter's from {lower:.2f} to {upper:.2f}: another zero, or another joint"
                )
            found[joint] = (low, high)
        return found

    def _required(self) -> Any:
        if self._sim is None:
            raise LinkError(f"{self.url}: it is not open")
        return self._sim

    def _call(self, function: Callable[..., Any], *given: object) -> Any:
        """Call something there; whatever goes wrong is the end of this connection."""
        try:
            return function(*given)
        except LinkError:
            raise
        except Exception as error:  # the client raises bare Exceptions for the server's errors
            words = str(error) or type(error).__name__
            raise LinkError(
                f"{self.url}: CoppeliaSim does not answer as expected: {words:.300}"
            ) from None


def _never_late(socket: Any, zmq: Any) -> None:
    """Connect anew, so that nothing is ever delivered late, to whoever listens there by then."""
    endpoint = socket.getsockopt(zmq.LAST_ENDPOINT)
    socket.disconnect(endpoint)
    for option in (zmq.RCVTIMEO, zmq.SNDTIMEO):
        socket.setsockopt(option, round(1000 * _ANSWERS_WITHIN))
    socket.setsockopt(zmq.LINGER, 0)
    socket.setsockopt(zmq.IMMEDIATE, 1)  # queue nothing for whoever is not there
    socket.setsockopt(zmq.RECONNECT_IVL, -1)
    socket.connect(endpoint)


def _put_back(before: object) -> None:
    names = vars(sys.modules["__main__"])
    if before is None:
        names.pop("require", None)
    else:
        names["require"] = before


def _library() -> tuple[Any, Any]:
    """Return the client's module and pyzmq; raise LinkError where they are not installed."""
    try:
        import coppeliasim_zmqremoteapi_client as library  # noqa: PLC0415 - an extra
        import zmq  # noqa: PLC0415
    except ImportError as missing:
        raise LinkError(f"{_MISSING} ({missing})") from None
    return library, zmq
