"""Whom the studio follows where several people are seen: one frame at a time, live or from a file.

The nearest person is taken and kept while seen. Who goes missing while others are in sight is
waited for: a sensor loses a person for a frame or two all the time, and the robot would otherwise
jump to somebody else's arm. The wait is as long as the gate's for a lost body, so that whoever
takes over finds the gate closed.
"""

import math
from dataclasses import dataclass

from studio.engine.skeleton import Joint, Skeleton
from studio.engine.sources.family import Frame

PATIENCE = 0.5  # [s] for which a missing person is waited for; the gate's own wait is as long
_ROUNDING = 1e-6  # [s]; stamps of n/30 s are rounded now up, now down


@dataclass(frozen=True)
class Following:
    """Who is followed and when last seen; the memory of `choose_body`."""

    body_id: str | None = None  # None: nobody yet
    seen: float = 0.0  # [s]


def choose_body(
    memory: Following | None, frame: Frame, *, only: str | None = None
) -> tuple[Following, Skeleton | None]:
    """Return the skeleton to follow in a frame, None where that person is not in it.

    Parameters
    ----------
    memory
        What the frame before returned; None at the beginning.
    frame
        All bodies of one moment.
    only
        The id of the one body to follow, for ever; by default the nearest is taken, and the next
        nearest `PATIENCE` after that one was last seen.
    """
    memory = memory or Following()
    followed = memory.body_id if only is None else only
    for skeleton in frame.bodies:
        if skeleton.body_id == followed:
            return Following(followed, frame.time), skeleton
    waits = memory.body_id is not None and frame.time - memory.seen <= PATIENCE + _ROUNDING
    if only is not None or waits or not frame.bodies:
        return memory, None
    nearest = min(frame.bodies, key=_distance)
    return Following(nearest.body_id, frame.time), nearest


def _distance(skeleton: Skeleton) -> float:
    """Return how far the body is from the sensor in the floor plane [m]."""
    x, _, z = skeleton.positions[Joint.SPINE_MID].tolist()
    return math.hypot(x, z)
