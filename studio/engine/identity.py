"""Whether two frames show the same person: a tracker may put somebody else under a known id.

Nobody who teaches moves faster than `FASTEST`; in real recordings of a Kinect, the base of the
spine jumps by 0.18 m at most from one frame to the next. So a body that is suddenly elsewhere is
another one, whatever the sensor calls it.
"""

import math

from studio.engine.skeleton import Joint, Skeleton, Tracking

SHORTEST = 0.2  # [s]; frames that follow faster are allowed as much as this
FASTEST = 2.5  # [m/s] of the trunk: 0.5 m within `SHORTEST`
# The first that both know. Plain numbers, as numpy is slow to look enumerations up.
_TRUNK = tuple(map(int, (Joint.SPINE_BASE, Joint.SPINE_MID, Joint.SPINE_SHOULDER)))
_NOT_TRACKED = int(Tracking.NOT_TRACKED)


def is_another(before: Skeleton, now: Skeleton) -> bool:
    """Tell whether a frame shows somebody else than the one before it."""
    if now.body_id != before.body_id:
        return True
    allowed = FASTEST * max(now.time - before.time, SHORTEST)
    for joint in _TRUNK:
        if _NOT_TRACKED not in (before.tracking.item(joint), now.tracking.item(joint)):
            a, b = before.positions[joint].tolist(), now.positions[joint].tolist()
            return not math.dist(a, b) <= allowed  # nor is NaN or infinity
    return False
