"""The robot behind both stand-ins: it integrates targets in real time, or drops out."""

import threading
import time

from studio.engine.robot import ARM_JOINTS, load_robot
from studio.engine.skeleton import SIDES

JOINTS = tuple(f"{side}_{joint}" for side in SIDES for joint in ARM_JOINTS)
TOP_SPEED = dict(zip(JOINTS, load_robot().limits_of(JOINTS).velocity.tolist(), strict=True))


class ArmsModel:
    """Fourteen joints. ``drops_out`` [s] without a command it holds where it is; None: never."""

    def __init__(self, drops_out: float | None = None) -> None:
        self.lock = threading.RLock()
        self.positions = dict.fromkeys(JOINTS, 0.0)
        self.targets: dict[str, float] = {}
        self.ratio, self.powered, self.stopped = 1.0, False, False
        self.signs = dict.fromkeys(JOINTS, 1.0)
        self.commands: list[tuple[float, dict[str, float]]] = []
        self._drops_out, self._then = drops_out, time.monotonic()
        self._origin: dict[str, tuple[float, float]] = {}

    def obey(self, targets: dict[str, float]) -> None:
        with self.lock:
            self.commands.append((time.monotonic(), targets))
            self.targets |= targets
            for joint, angle in targets.items():
                self._origin.setdefault(joint, (angle, self.positions[joint]))

    def pass_time(self) -> None:
        """Move on to this moment, no faster than the motors turn."""
        with self.lock:
            now = time.monotonic()
            elapsed, self._then = now - self._then, now
            since = now - self.commands[-1][0] if self.commands else 0.0
            late = self._drops_out is not None and since > self._drops_out
            if not self.powered or self.stopped or late:
                self.targets, self._origin = {}, {}
                return
            for joint, angle in self.targets.items():
                told, was = self._origin[joint]
                goal = was + self.signs[joint] * (angle - told)
                most = self.ratio * TOP_SPEED[joint] * elapsed
                gap = goal - self.positions[joint]
                self.positions[joint] += max(-most, min(most, gap))
