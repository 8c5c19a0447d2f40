"""Commands as messages. Written by docs/make_remote_schema.py: change it there."""

from studio.remote.message import Message


class ForgetKept(Message, frozen=True):
    """Send the second robot away."""


class KeepToCompare(Message, frozen=True):
    """Keep what is learned now as B: a second robot does it beside whatever is learned later."""


class PlaceBlock(Message, frozen=True):
    """Put a block of the task somewhere else on the desk; the robot waits beside it anew."""

    x: float  # [m] of its center in the world
    y: float  # [m]
    block: int = 0  # which of the scene's, as they are listed


class PlaceStart(Message, frozen=True):
    """Let a rollout of the field begin elsewhere in its plane."""

    index: int  # of the start point
    u: float  # [rad] along the plane's first direction, from the goal
    v: float  # [rad] along its second


class PutBlockBack(Message, frozen=True):
    """Put the task's blocks where they were taught."""


class ShowLeg(Message, frozen=True):
    """Show the field of another leg of the motion: 0 there, 1 back."""

    leg: int
