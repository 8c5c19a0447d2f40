"""Whether a robot that a program drives has come to where it was sent."""

from collections.abc import Mapping

from studio.remote.errors import RefusedError
from studio.remote.link import Link
from studio.remote.told import JointStates

_CLOSE_ENOUGH = 0.02  # [rad]


def is_there(link: Link, targets: Mapping[str, float], now: JointStates) -> bool:
    """Tell whether it has come to its targets [rad], and follows from there.

    Raises
    ------
    RefusedError
        Where it was stopped on its way.
    """
    if now.stopped:
        raise RefusedError("somebody has stopped Baxter on its way there")
    joints = link.welcome.joints
    gaps = (abs(now.positions[joints.index(joint)] - angle) for joint, angle in targets.items())
    return now.driven is not None and now.driven.follows and max(gaps, default=0.0) < _CLOSE_ENOUGH


def not_there(link: Link, now: JointStates) -> str:
    """Return in words that it does not come there, and what keeps it from it."""
    why = now.guarded or "".join(list(link.complaints)[-1:]) or "it takes too long"
    return f"the robot does not come there: {why}"
