"""What a session shows of the robot it is linked to."""

from dataclasses import dataclass
from enum import StrEnum

from studio.engine.skeleton import FloatArray

FIRST_RATIO, LEAST_RATIO = 0.3, 0.05  # of the robot's top speed


class Phase(StrEnum):
    """How far the way to following has been gone."""

    OFF = "off"  # nobody has enabled it here
    ENABLING = "enabling"  # it was asked to, and has not said that it is
    WAITING = "waiting"  # enabled; a person has to confirm the first move
    STARTING = "starting"  # on its slow way to the start pose
    READY = "ready"  # there, or following


@dataclass(frozen=True, eq=False)
class LinkStatus:
    """All that panels may draw of it."""

    url: str = ""  # empty where no robot is to be linked
    is_connected: bool = False  # it is heard, and newly enough
    words: str = ""  # how it stands, and what to do about it
    phase: Phase = Phase.OFF
    ratio: float = FIRST_RATIO  # of its top speed
    is_enabled: bool = False  # as it says itself
    stop: str = ""  # which emergency stop holds it, in words
    resets: bool = False  # whether enabling ends that
    is_moving: bool = False  # a command left in this tick
    lag: float = 0.0  # [rad] that its command is behind what is shown
    guarded: str = ""  # what the guard keeps apart there, in words
    measured: FloatArray | None = None  # (15,) [rad] where it is; NaN where it does not tell


NO_LINK = LinkStatus()
