"""What the gatekeeper sees, keeps and decides."""

from dataclasses import dataclass

import numpy as np

from studio.engine.links.driver import Heard
from studio.engine.links.link import RobotState
from studio.engine.links.status import FIRST_RATIO, Phase
from studio.engine.links.tracking import Tracking
from studio.engine.links.way import Way
from studio.engine.skeleton import FloatArray


@dataclass(frozen=True, eq=False)
class Seen:
    """The robot, as far as it is heard."""

    state: RobotState | None = None
    age: float = np.inf  # [s]
    trouble: str = ""  # why it is not heard, in words

    @classmethod
    def of(cls, heard: Heard | None, now: float, trouble: str) -> "Seen":
        """Return what was heard last, as it is ``now`` [s]."""
        if heard is None:
            return cls(trouble=trouble)
        return cls(heard.state, heard.age(now), trouble)


@dataclass(frozen=True, eq=False)
class Memory:
    """All that is kept from one tick to the next."""

    phase: Phase = Phase.OFF
    why: str = "Not enabled."  # why it is no further, in words
    ratio: float = FIRST_RATIO
    way: Way | None = None  # from the confirmation on
    goal: FloatArray | None = None  # (D,) [rad] the start pose
    sent: FloatArray | None = None  # (D,) [rad] the last command; None where commands have paused
    wanted: FloatArray | None = None  # (D,) [rad] a tick ago, while commands flow
    tracking: Tracking | None = None  # since commands began
    ticks: int = 0  # that it has been waited for

    def top(self, way: Way) -> FloatArray:
        """Return how fast each joint (D,) may be [rad/s]."""
        return self.ratio * way.limits.velocity


@dataclass(frozen=True, eq=False)
class Outcome:
    """What one tick decided."""

    targets: dict[str, float] | None = None  # [rad] to send now; None: nothing leaves
    lag: float = 0.0  # [rad] that the farthest joint's command is behind what is wanted
    guarded: str = ""  # what the guard keeps apart, in words
