"""The robot behind both stand-ins: it integrates targets as time passes, or drops out."""

import threading
import time
from collections.abc import Callable

from studio.engine.robot import ARM_JOINTS, load_robot
from studio.engine.skeleton import SIDES

JOINTS = tuple(f"{side}_{joint}" for side in SIDES for joint in ARM_JOINTS)
TOP_SPEED = dict(zip(JOINTS, load_robot().limits_of(JOINTS).velocity.tolist(), strict=True))


class ArmsModel:
    """Fourteen joints, whose motors turn ``haste`` times as fast as a robot's.

    ``drops_out`` [s] without a command it holds where it is; None: never.
    """

    def __init__(
        self,
        drops_out: float | None = None,
        now: Callable[[], float] = time.monotonic,
        haste: float = 1.0,
    ) -> None:
        self._now, self._haste = now, haste
        self.lock = threading.RLock()
        self.positions = dict.fromkeys(JOINTS, 0.0)
        self.targets: dict[str, float] = {}
        self.ratio, self.powered, self.stopped = 1.0, False, False
        self.signs = dict.fromkeys(JOINTS, 1.0)
        self.commands: list[tuple[float, dict[str, float]]] = []
        self._drops_out, self._then = drops_out, now()
        self._origin: dict[str, tuple[float, float]] = {}

    def obey(self, targets: dict[str, float]) -> None:
        with self.lock:
            self.commands.append((self._now(), targets))
            self.targets |= targets
            for joint, angle in targets.items():
                if angle == self.positions[joint]:  # it stands, whichever way it turns
                    self._origin[joint] = (angle, angle)
                self._origin.setdefault(joint, (angle, self.positions[joint]))

    def lead(self, positions: dict[str, float]) -> None:
        """Be led there by somebody, while nothing is commanded."""
        with self.lock:
            self.positions |= positions
            self.targets, self._origin = {}, {}

    def pass_time(self) -> None:
        """Move on to this moment, no faster than the motors turn."""
        with self.lock:
            now = self._now()
            elapsed, self._then = now - self._then, now
            since = now - self.commands[-1][0] if self.commands else 0.0
            late = self._drops_out is not None and since > self._drops_out
            if not self.powered or self.stopped or late:
                self.targets, self._origin = {}, {}
                return
            for joint, angle in self.targets.items():
                told, was = self._origin[joint]
                goal = was + self.signs[joint] * (angle - told)
                most = self.ratio * TOP_SPEED[joint] * self._haste * elapsed
                gap = goal - self.positions[joint]
                self.positions[joint] += max(-most, min(most, gap))
