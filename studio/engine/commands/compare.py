"""How people compare: where the block stands, what is kept beside, where rollouts begin."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PlaceBlock:
    """Put the task's block somewhere else on the desk; the robot waits beside it anew."""

    x: float  # [m] of its center in the world
    y: float  # [m]


@dataclass(frozen=True)
class PutBlockBack:
    """Put the task's block where it was taught."""


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
