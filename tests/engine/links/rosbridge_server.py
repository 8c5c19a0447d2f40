"""A rosbridge v2 server of our own, with a small Baxter behind it.

Built from the protocol's specification (advertise, publish, subscribe, unsubscribe, unadvertise,
call_service, status) and from the message definitions of baxter_core_msgs, sensor_msgs and
std_msgs. It is stricter than the real one: whatever does not fit is kept in ``complaints``.
"""

import contextlib
import json
import math
import socket
import threading
import time
from collections.abc import Callable

from websockets.exceptions import ConnectionClosed
from websockets.sync.server import Server, ServerConnection, serve

from studio.engine.links import baxter_messages as topics
from studio.engine.robot import ARM_JOINTS
from studio.engine.skeleton import SIDES
from tests.engine.links.arms_model import JOINTS, ArmsModel

RATE = 100.0  # [Hz]
TYPES = {
    topics.JOINT_STATES[0]: "sensor_msgs/JointState",
    topics.ROBOT_STATE[0]: "baxter_core_msgs/AssemblyState",
    "/robot/set_super_enable": "std_msgs/Bool",
    "/robot/set_super_reset": "std_msgs/Empty",
    **{f"/robot/limb/{side}/joint_command": "baxter_core_msgs/JointCommand" for side in SIDES},
    **{f"/robot/limb/{side}/set_speed_ratio": "std_msgs/Float64" for side in SIDES},
}
FIELDS = {
    "std_msgs/Bool": {"data": bool},
    "std_msgs/Float64": {"data": float},
    "std_msgs/Empty": {},
    "baxter_core_msgs/JointCommand": {"mode": int, "names": list, "command": list},
}
OTHERS = {"head_pan": 0.1, "torso_t0": 0.0, "l_gripper_l_finger_joint": 0.02, "head_nod": 0.0}


class Ear:
    """A connection's socket, from which nothing is read while the server is deaf."""

    def __init__(self, connection: socket.socket, hears: threading.Event) -> None:
        self._connection, self._hears = connection, hears

    def __getattr__(self, name: str) -> object:
        return getattr(self._connection, name)

    def recv(self, size: int) -> bytes:
        found = self._connection.recv(size)
        self._hears.wait()
        return found


class RosbridgeServer:
    """A context manager; `arms` is the robot, the rest is what may go wrong with it."""

    def __init__(self, now: Callable[[], float] = time.monotonic, haste: float = 1.0) -> None:
        self.arms = ArmsModel(0.6, now, haste)
        self._now = now
        self.button = 0  # AssemblyState.estop_button
        self.enables = True  # whether it powers its motors when asked
        self.order: Callable[[list[str]], list[str]] = lambda names: names
        self.untold: set[str] = set()
        self.changed: Callable[[str], str] = lambda text: text  # the last word on what it sends
        self.delay = 0.0  # [s] by which joint states come late
        self.silent = False
        self._hears = threading.Event()
        self._hears.set()
        self.complaints: list[str] = []
        self.heard: list[dict] = []
        self._port, self._queue = 0, []

    def __enter__(self) -> "RosbridgeServer":
        self._closing = threading.Event()
        self._connections: dict[ServerConnection, set[str]] = {}
        self._server: Server = serve(self._hear, "127.0.0.1", self._port, compression=None)
        self._port = self._server.socket.getsockname()[1]
        self._threads = [
            threading.Thread(target=self._server.serve_forever, daemon=True),
            threading.Thread(target=self._tell_until_closed, daemon=True),
        ]
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    @property
    def url(self) -> str:
        return f"rosbridge://127.0.0.1:{self._port}"

    def press(self) -> None:
        self.button, self.arms.stopped, self.arms.powered = 1, True, False

    def release(self) -> None:
        self.button = 3

    def power_off(self) -> None:
        self.arms.powered = False

    def deafen(self) -> None:
        """Read nothing any more, and go on to tell."""
        self._hears.clear()

    def hear_again(self) -> None:
        self._hears.set()

    def kill(self) -> None:
        self._closing.set()
        self._hears.set()
        self._server.shutdown()
        for connection in list(self._connections):
            connection.socket.close()

    def revive(self) -> None:
        self.__enter__()

    def send(self, text: str) -> None:
        """Send anything to everybody."""
        for connection in list(self._connections):
            with contextlib.suppress(ConnectionClosed):
                connection.send(text)

    def _hear(self, connection: ServerConnection) -> None:
        connection.socket = Ear(connection.socket, self._hears)
        self._connections[connection] = set()
        advertised: set[str] = set()
        try:
            for text in connection:
                message = json.loads(text)
                self.heard.append(message)
                self._take(connection, advertised, message)
        except (ConnectionClosed, OSError):
            pass
        finally:
            self._connections.pop(connection, None)

    def _take(self, connection: ServerConnection, advertised: set[str], message: dict) -> None:
        operation, topic = message.get("op"), message.get("topic", "")
        wrong = "type" in message and TYPES.get(topic) != message["type"]
        match operation:
            case "subscribe" | "advertise" if wrong:
                self._complain(connection, f"{topic} is no {message['type']}")
            case "subscribe":
                self._connections[connection].add(topic)
            case "unsubscribe":
                self._connections[connection].discard(topic)
            case "advertise":
                advertised.add(topic)
            case "unadvertise":
                advertised.discard(topic)
            case "publish" if topic not in advertised:
                self._complain(connection, f"{topic} was never advertised")
            case "publish":
                self._obey(connection, topic, message.get("msg"))
            case "call_service":
                answer = {"op": "service_response", "id": message.get("id"), "values": {}}
                answer |= {"service": message.get("service"), "result": False}
                connection.send(json.dumps(answer))
            case _:
                self._complain(connection, f"Unknown operation: {operation}")

    def _complain(self, connection: ServerConnection, words: str) -> None:
        self.complaints.append(words)
        connection.send(json.dumps({"op": "status", "level": "error", "msg": words}))

    def _obey(self, connection: ServerConnection, topic: str, message: dict) -> None:
        fields = FIELDS[TYPES[topic]]
        if set(message) != set(fields) or any(
            not isinstance(message[name], kind) for name, kind in fields.items()
        ):
            self._complain(connection, f"{topic}: {message} is no {TYPES[topic]}")
        elif topic.endswith("set_super_enable"):
            self.arms.powered = message["data"] and self.enables and not self.arms.stopped
        elif topic.endswith("set_super_reset"):
            self.arms.stopped = self.button == 1
            self.button = 1 if self.button == 1 else 0
        elif topic.endswith("set_speed_ratio"):
            self.arms.ratio = message["data"]
        else:
            self._command(connection, topic.split("/")[3], message)

    def _command(self, connection: ServerConnection, side: str, message: dict) -> None:
        known = {f"{side}_{joint}" for joint in ARM_JOINTS}
        fits = message["mode"] == 1 and set(message["names"]) <= known
        if not fits or len(message["names"]) != len(message["command"]):
            self._complain(connection, f"{side}: {message}")
            return
        self.arms.obey(dict(zip(message["names"], message["command"], strict=True)))

    def _tell_until_closed(self) -> None:
        while not self._closing.wait(1.0 / RATE):
            self.arms.pass_time()
            if self.silent:
                continue
            self._queue.append((self._now() + self.delay, self._joint_states()))
            while self._queue and self._queue[0][0] <= self._now():
                self._publish(topics.JOINT_STATES[0], self._queue.pop(0)[1])
            self._publish(topics.ROBOT_STATE[0], self._assembly())

    def _publish(self, topic: str, message: dict) -> None:
        text = self.changed(json.dumps({"op": "publish", "topic": topic, "msg": message}))
        for connection, wanted in list(self._connections.items()):
            if topic in wanted:
                try:
                    connection.send(text)
                except (ConnectionClosed, OSError):
                    self._connections.pop(connection, None)

    def _joint_states(self) -> dict:
        told = {**self.arms.positions, **OTHERS}
        names = [name for name in self.order([*told]) if name not in self.untold]
        now = 1e9 + self._now()
        return {
            "header": {"seq": 0, "frame_id": "", "stamp": _stamp(now)},
            "name": names,
            "position": [told[name] for name in names],
            "velocity": [0.0] * len(names),
            "effort": [0.0] * len(names),
        }

    def _assembly(self) -> dict:
        return {
            "enabled": self.arms.powered,
            "stopped": self.arms.stopped,
            "error": False,
            "estop_button": self.button,
            "estop_source": 1 if self.arms.stopped else 0,
        }


def _stamp(now: float) -> dict[str, int]:
    return {"secs": math.floor(now), "nsecs": math.floor(1e9 * (now % 1.0))}


assert set(JOINTS) == {f"{side}_{joint}" for side in SIDES for joint in ARM_JOINTS}
