"""What the studio needs of a robot, wherever it is: in this process, in a simulator, or real.

The laws of every link, held by `tests/engine/links/`:

1. **Joints go by name**, in both directions: no link trusts an order.
2. **A link decides nothing.** It passes on what it is given and tells what it hears. Whether
   anything may be sent is decided in one place, `gatekeeper.step`, before every single
   command.
3. **What is not known is told as not known**: a joint that the robot does not tell is NaN, a
   state that did not come is None, and neither is ever made up from what was commanded.
4. **A link that is lost says so** by `LinkError`, and never sends again what it could not send,
   nor leaves it to anybody who might: whoever opens it anew begins with nothing.
5. **A link may block**; so only its own thread calls it (`driver.LinkThread`), never a tick.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.robot import ARM_JOINTS, JOINT_NAMES
from studio.engine.skeleton import SIDES, FloatArray

# A link has to tell all joints of both arms, for the guard has to know where they are.
ARMS_JOINTS = tuple(f"{side}_{joint}" for side in SIDES for joint in ARM_JOINTS)

Range = tuple[float, float]  # [rad] the lowest and the highest angle


class LinkError(StudioError):
    """A robot cannot be reached, or not any more; the message names its address and the cure."""


@dataclass(frozen=True, eq=False)
class RobotState:
    """A robot at one moment, as it tells itself."""

    positions: FloatArray  # (15,) [rad] in the order of JOINT_NAMES; NaN where it does not tell
    enabled: bool  # its motors have power and take commands
    stop: str = ""  # which emergency stop holds it, and what ends that, in words
    resets: bool = False  # what asserted the stop is released: enabling the robot ends it
    fault: str = ""  # what else is wrong, in words: it may move nevertheless
    stamp: float | None = None  # [s] by the robot's own clock; None where it tells no time

    @property
    def untold(self) -> tuple[str, ...]:
        """The joints of both arms that it does not tell."""
        known = dict(zip(JOINT_NAMES, self.positions.tolist(), strict=True))
        return tuple(name for name in ARMS_JOINTS if not np.isfinite(known[name]))


class RobotLink(Protocol):
    """A robot that takes joint targets and tells joint states; see the module for its laws.

    All methods but `close` raise `LinkError` where the robot cannot be reached any more.
    """

    url: str  # its address, as people typed it

    @property
    def limits(self) -> Mapping[str, Range]:
        """The position limits that the robot itself has, by joint, once it is open, if any."""
        ...

    def open(self) -> None:
        """Connect, and begin to listen; whatever was sent or heard before is forgotten."""
        ...

    def read(self) -> RobotState | None:
        """Return how it is, or None where nothing new came since the last call."""
        ...

    def send(self, targets: Mapping[str, float]) -> None:
        """Send targets [rad] by joint, whole arms at a time; nothing repeats them."""
        ...

    def enable(self) -> None:
        """Ask it to power its motors; `read` tells whether it did."""
        ...

    def disable(self) -> None:
        """Ask it to take the power off its motors, at once."""
        ...

    def stop(self) -> None:
        """Hold still where it is, its motors powered: commands have ended, maybe in mid-motion.

        It goes once behind the last command, and is nothing that a robot has to be enabled for.
        """
        ...

    def set_speed(self, ratio: float) -> None:
        """Tell it which share of its top speed it may use, above 0 to 1."""
        ...

    def close(self) -> None:
        """Let it alone; may be called twice, and whatever state the link is in."""
        ...


def positions_of(told: Mapping[str, float]) -> FloatArray:
    """Return all joints (15,) [rad] of those that were told by name, the others NaN."""
    return np.array([told.get(name, np.nan) for name in JOINT_NAMES], dtype=float)
