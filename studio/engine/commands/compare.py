"""How people compare: where the block stands, what is kept beside, where rollouts begin."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PlaceBlock:
    """Put a block of the task somewhere else on the desk; the robot waits beside it anew."""

    x: float  # [m] of its center in the world
    y: float  # [m]
    block: int = 0  # which of the scene's, as they are listed


@dataclass(frozen=True)
class PutBlockBack:
    """Put the task's blocks where they were taught."""


@dataclass(frozen=True)
class KeepToCompare:
    """Keep what is learned now as B: a second robot does it beside whatever is learned later."""


@dataclass(frozen=True)
class ForgetKept:
    """Send the second robot away."""


@dataclass(frozen=True)
class PlaceStart:
    """Let a rollout of the field begin elsewhere in its plane."""

    index: int  # of the start point
    u: float  # [rad] along the plane's first direction, from the goal
    v: float  # [rad] along its second


@dataclass(frozen=True)
class ShowLeg:
    """Show the field of another leg of the motion: 0 there, 1 back."""

    leg: int


CompareCommand = PlaceBlock | PutBlockBack | KeepToCompare | ForgetKept | PlaceStart | ShowLeg
