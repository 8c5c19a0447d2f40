"""A stand-in for CoppeliaSim's ZeroMQ remote API server, with a small Baxter in its scene.

Built from the published protocol: a REP socket, CBOR, a request's func and args answered by ret or
err; zmqRemoteApi.require and .info, by which its client learns what there is; and the functions of
its manual that concern joints and the simulation's state. The genuine Python client talks to it.
"""

# ruff: noqa: N802 - the functions have the simulator's names

import threading
import time
from collections.abc import Callable

import cbor2
import zmq

from studio.engine.links.coppeliasim import ADVANCING, PAUSED
from studio.engine.robot import ARM_JOINTS, load_robot
from studio.engine.skeleton import SIDES
from tests.engine.links.arms_model import JOINTS, ArmsModel

STEP = 0.05  # [s] of simulated time, as is usual there
HANDLES = {joint: 15 + 3 * number for number, joint in enumerate(JOINTS)}


class CoppeliaSimServer:
    """A context manager; `arms` is the robot, the rest is what may go wrong with it."""

    def __init__(self, now: Callable[[], float] = time.monotonic, haste: float = 1.0) -> None:
        self.arms = ArmsModel(None, now, haste)
        self._now = now
        self.state, self.locked, self.stepping = 0, 0, False
        self.paths = {f"/Baxter/{old_name(joint)}": joint for joint in JOINTS}
        limits = load_robot().limits_of(JOINTS)
        ranges = zip(limits.lower.tolist(), limits.upper.tolist(), strict=True)
        self.intervals = {
            joint: [False, [low, up - low]] for joint, (low, up) in zip(JOINTS, ranges, strict=True)
        }
        self.silent, self.garbage = False, False
        self.complaints: list[str] = []
        self._port = 0

    def __enter__(self) -> "CoppeliaSimServer":
        self._closing = threading.Event()
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.REP)
        self._socket.setsockopt(zmq.LINGER, 0)
        self._port = self._port or self._socket.bind_to_random_port("tcp://127.0.0.1")
        if self._socket.getsockopt(zmq.LAST_ENDPOINT) == b"":
            self._socket.bind(f"tcp://127.0.0.1:{self._port}")
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    @property
    def url(self) -> str:
        return f"coppeliasim://127.0.0.1:{self._port}"

    def press(self) -> None:
        self.state = PAUSED
        self.arms.powered = False

    def power_off(self) -> None:
        self.state = 0
        self.arms.powered = False

    def kill(self) -> None:
        self._closing.set()
        self._thread.join()

    def revive(self) -> None:
        self.__enter__()

    def _serve(self) -> None:
        due = self._now()
        while not self._closing.is_set():
            if self._socket.poll(2):
                self._answer(self._socket.recv())
            if self._now() >= due and not self.locked:
                due += STEP
                self.arms.pass_time()
        self._socket.close()
        self._context.term()

    def _answer(self, raw: bytes) -> None:
        while self.silent and not self._closing.wait(0.01):
            pass
        if self.garbage:
            self._socket.send(b"\xff\x00 no cbor")
            return
        request = cbor2.loads(raw)
        if "uuid" not in request or len(request.get("args", ())) != request.get("argsL"):
            self.complaints.append(f"{request}")
        try:
            name = request["func"]
            function = getattr(self, "_" + name.replace(".", "_"))
            answer = {"ret": function(*request["args"])}
        except Exception as error:  # as its server does
            answer = {"err": f"{type(error).__name__}: {error} (in function '{name}')"}
            self.complaints.append(answer["err"])
        self._socket.send(cbor2.dumps(answer))

    def _zmqRemoteApi_require(self, name: str) -> list:
        return []

    def _zmqRemoteApi_info(self, name: str) -> list:
        functions = [key for key in dir(self) if key.startswith(f"_{name}_")]
        return [{key.removeprefix(f"_{name}_"): {"func": {}} for key in functions}]

    def _sim_getObject(self, path: str, options: dict | None = None) -> list:
        if path in self.paths:
            return [HANDLES[self.paths[path]]]
        if (options or {}).get("noError"):
            return [-1]
        raise LookupError(f"Object does not exist: {path}")

    def _sim_getJointPosition(self, handle: int) -> list:
        return [self.arms.positions[joint_of(handle)]]

    def _sim_getJointInterval(self, handle: int) -> list:
        return self.intervals[joint_of(handle)]

    def _sim_setJointTargetPosition(self, handle: int, angle: float) -> list:
        if self.locked < 1:
            self.complaints.append("a target outside a lock would wait for the next step")
        self.arms.obey({joint_of(handle): angle})
        return []

    def _sim_getSimulationState(self) -> list:
        return [self.state]

    def _sim_startSimulation(self) -> list:
        self.state = ADVANCING | 1
        self.arms.powered = True
        return [1]

    def _sim_pauseSimulation(self) -> list:
        self.state = PAUSED
        self.arms.powered = False
        return [1]

    def _sim_setStepping(self, enabled: bool) -> list:
        self.stepping, before = enabled, self.stepping
        return [int(before)]

    def _sim_acquireLock(self) -> list:
        self.locked += 1
        return []

    def _sim_releaseLock(self) -> list:
        self.locked -= 1
        return []


def joint_of(handle: int) -> str:
    return {number: joint for joint, number in HANDLES.items()}[handle]


def old_name(joint: str) -> str:
    """V-REP's name of a joint, as Baxter's model has it."""
    side, _, short = joint.partition("_")
    return f"{side}Arm_joint{ARM_JOINTS.index(short) + 1}"


assert set(JOINTS) == {f"{side}_{joint}" for side in SIDES for joint in ARM_JOINTS}
