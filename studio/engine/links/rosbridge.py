"""A real Baxter, or its Gazebo twin, through rosbridge: position mode, limb by limb.

roslibpy (the extra "ros") speaks the rosbridge v2 protocol. It runs on asyncio here, not on
twisted, whose reactor cannot be started twice in a process; and it does not connect again by
itself: a connection that comes back is for people to enable anew.

One command is on its way at most: the next is sent once that one has been read. Where the robot's
side reads no more, the link is lost as soon as a state would be stale (`receipts.Receipts`).
"""

import logging
import math
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from studio.engine.links.baxter_messages import (
    ENABLE,
    JOINT_STATES,
    RESET,
    ROBOT_STATE,
    Assembly,
    assembly,
    command_topic,
    joint_command,
    joint_reading,
    speed_topic,
)
from studio.engine.links.driver import STALE
from studio.engine.links.link import LinkError, Range, RobotState, positions_of
from studio.engine.links.receipts import Receipts
from studio.engine.skeleton import SIDES

_CONNECTS_WITHIN, _CLOSES_WITHIN = 3.0, 1.0  # [s]
_THROTTLE = 20  # [ms] between two states of a topic: Baxter sends 100 a second
_LARGEST = 1 << 20  # bytes of a message; a joint state takes 1 kB
_MISSING = "a robot through rosbridge needs the extra ros: pip install 'teaching-studio[ros]'"


@dataclass
class _Heard:
    """What the network's thread leaves for the link's; under the link's lock."""

    joints: dict[str, tuple[float, float]]  # by name: angle [rad], and when [s] it came
    assembly: Assembly | None = None
    stamp: float | None = None
    news_of_joints: bool = False
    news_of_assembly: bool = False


class Rosbridge:
    """The link.

    Parameters
    ----------
    url, host, port
        Where rosbridge listens; ``url`` as people typed it.
    now
        Any clock [s].
    """

    limits: Mapping[str, Range] = {}  # Baxter tells none here; the studio's own are its maker's

    def __init__(self, url: str, host: str, port: int, now: Callable[[], float]) -> None:
        self.url, self._host, self._port, self._now = url, host, port, now
        self._lock, self._heard = threading.Lock(), _Heard({})
        self._ros: Any = None
        self._receipts: Receipts | None = None
        self._topics: dict[str, Any] = {}

    def open(self) -> None:
        """Connect, listen to joints and state, and announce what may be sent; send nothing."""
        self.close()
        roslibpy, select_factory = _library()
        select_factory("asyncio").set_max_retries(0)
        self._heard = _Heard({})
        self._ros = ros = roslibpy.Ros(self._host, self._port, transport="asyncio")
        try:
            ros.run(timeout=_CONNECTS_WITHIN)
        except TimeoutError:
            raise LinkError(
                f"{self.url}: no rosbridge answers there: on the robot's network run "
                "`roslaunch rosbridge_server rosbridge_websocket.launch`"
            ) from None
        ros.factory.on_ready(self._connected)
        for (name, kind), hear in ((JOINT_STATES, self._joints), (ROBOT_STATE, self._state)):
            topic = roslibpy.Topic(
                ros, name, kind, throttle_rate=_THROTTLE, queue_length=1, reconnect_on_close=False
            )
            topic.subscribe(hear)
        outward = [ENABLE, RESET, *map(command_topic, SIDES), *map(speed_topic, SIDES)]
        self._topics = {
            name: roslibpy.Topic(ros, name, kind, queue_size=1, reconnect_on_close=False)
            for name, kind in outward
        }
        for topic in self._topics.values():
            topic.advertise()

    def read(self) -> RobotState | None:
        """Return the newest state once both joints and robot were heard since the last time."""
        self._require()
        with self._lock:
            heard, whole = self._heard, self._heard.assembly
            if whole is None or not (heard.news_of_joints and heard.news_of_assembly):
                return None
            heard.news_of_joints = heard.news_of_assembly = False
            oldest = self._now() - STALE  # grippers and head may come in messages of their own
            told = {
                name: angle if at >= oldest else math.nan
                for name, (angle, at) in heard.joints.items()
            }
            stamp = heard.stamp
        return RobotState(
            positions_of(told), whole.enabled, whole.stop, whole.resets, whole.fault, stamp
        )

    def send(self, targets: Mapping[str, float]) -> None:
        """Send each limb that is wholly among ``targets`` its command, or none while one waits."""
        if not self._require().is_waiting:
            commands = {command_topic(side)[0]: joint_command(side, targets) for side in SIDES}
            self._publish({topic: told for topic, told in commands.items() if told is not None})

    def enable(self) -> None:
        """Reset a stop that is released, and ask for power."""
        with self._lock:
            known = self._heard.assembly
        if known is not None and known.resets:
            self._publish({RESET[0]: {}})
        self._publish({ENABLE[0]: {"data": True}})

    def disable(self) -> None:
        """Ask to take the power off."""
        self._publish({ENABLE[0]: {"data": False}})

    def stop(self) -> None:
        """Nothing to tell: Baxter holds still by itself where no command comes."""

    def set_speed(self, ratio: float) -> None:
        """Tell both limbs."""
        self._publish({speed_topic(side)[0]: {"data": ratio} for side in SIDES})

    def close(self) -> None:
        """End the connection; Baxter holds still where it is."""
        ros, self._ros, self._topics = self._ros, None, {}
        receipts, self._receipts = self._receipts, None
        if ros is None:
            return
        if not ros.is_connected:
            ros.on_ready(ros.close)  # should it connect so late, then only to be closed
        elif receipts is None or receipts.come():
            with suppress(TimeoutError):
                ros.close(timeout=_CLOSES_WITHIN)
        else:
            receipts.abort()

    def _connected(self, protocol: Any) -> None:
        """Let a connection end itself over a message that no robot sends, and ask for receipts."""
        protocol.maxMessagePayloadSize = _LARGEST
        self._receipts = Receipts(protocol, self._now)

    def _publish(self, messages: dict[str, dict[str, object]]) -> None:
        """Send messages by their topics."""
        receipts = self._require()
        pairs = [(self._topics[topic], message) for topic, message in messages.items()]

        def publish() -> None:
            for topic, message in pairs:
                topic.publish(message)

        receipts.send(publish)

    def _require(self) -> Receipts:
        if self._ros is None or self._receipts is None or not self._ros.is_connected:
            raise LinkError(f"{self.url}: rosbridge has ended the connection")
        if self._receipts.is_late:
            raise LinkError(
                f"{self.url}: rosbridge does not read what is sent to it. Where the robot has to "
                "lose its power now, use its emergency stop"
            )
        return self._receipts

    def _joints(self, message: object) -> None:
        """Take joints, on the network's thread; a message without any of ours is no news."""
        reading = joint_reading(message)
        if reading is None or not reading.positions:
            return
        at = self._now()
        with self._lock:
            self._heard.joints |= {name: (angle, at) for name, angle in reading.positions.items()}
            self._heard.stamp, self._heard.news_of_joints = reading.stamp, True

    def _state(self, message: object) -> None:
        found = assembly(message)
        if found is not None:
            with self._lock:
                self._heard.assembly, self._heard.news_of_assembly = found, True


def _library() -> tuple[Any, Any]:
    """Return roslibpy and its choice of transports; raise LinkError where it is not installed."""
    try:
        import roslibpy  # noqa: PLC0415 - an extra
        from roslibpy.comm import select_factory  # noqa: PLC0415
    except ImportError as missing:
        raise LinkError(f"{_MISSING} ({missing})") from None
    # It writes a traceback for each message that it does not understand, garbage included.
    logging.getLogger("roslibpy").setLevel(logging.CRITICAL + 1)
    return roslibpy, select_factory
