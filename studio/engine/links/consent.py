"""What people ask of the gatekeeper: to enable, to start, to stop, and how fast."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.links.driver import STALE
from studio.engine.links.link import Range, RobotState
from studio.engine.links.memory import Memory, Seen
from studio.engine.links.status import LEAST_RATIO, Phase
from studio.engine.links.tracking import Tracking
from studio.engine.links.wanted import Wanted
from studio.engine.links.way import Way

OUTSIDE = 0.05  # [rad] that a measured joint may be beyond its limits where it starts
CONFIRM = (
    "Confirm first that nobody is within the arms' reach, that the desk is clear, and that the "
    "emergency stop is at hand"
)

DRIVEN = "A program drives the page's robot, and no other follows it there: stop it first"


def enable(memory: Memory, seen: Seen) -> Memory:
    """Return the memory after a person asked to enable; raise StudioError in words where not."""
    state = _required(seen)
    if state.stop and not state.resets:
        raise StudioError(state.stop)
    if memory.phase not in (Phase.OFF, Phase.ENABLING):
        return memory
    return Memory(Phase.ENABLING, "Waits for the robot to power its motors.", memory.ratio)


def confirm(
    memory: Memory, seen: Seen, wanted: Wanted, own: Mapping[str, Range], confirmed: bool
) -> Memory:
    """Return the memory after a person let the robot go to where the page's robot is.

    Raises
    ------
    StudioError
        Where it was not confirmed, a program drives the page's robot, or this one is not enabled,
        does not tell all joints of its arms, or is outside its limits.
    """
    if memory.phase in (Phase.OFF, Phase.ENABLING):
        raise StudioError(f"Enable the robot first: {memory.why}")
    if wanted.driven:
        raise StudioError(DRIVEN)
    if not confirmed:
        raise StudioError(CONFIRM)
    state = _required(seen)
    if state.untold:
        raise StudioError(f"The robot does not tell where {', '.join(state.untold)} is")
    way = Way.of(wanted, state.positions, own)
    here, sent = state.positions[way.columns], way.within(state.positions)
    worst = int(np.argmax(np.abs(here - sent)))
    if abs(here[worst] - sent[worst]) > OUTSIDE:
        raise StudioError(
            f"{way.joints[worst]} is at {here[worst]:.2f} rad, beyond its limit of "
            f"{sent[worst]:.2f}: lead the arm back by hand first"
        )
    tracking = Tracking.begin(sent)
    goal, why = way.within(wanted.positions), "Goes to the start pose."
    return Memory(Phase.STARTING, why, memory.ratio, way, goal, sent, None, tracking)


def stop(memory: Memory, why: str) -> Memory:
    """Return the memory of a robot that has to be enabled and confirmed anew."""
    return Memory(why=why, ratio=memory.ratio)


def at_ratio(memory: Memory, ratio: float) -> Memory:
    """Return the memory with another share of the top speed; raise StudioError for no share."""
    if not LEAST_RATIO <= ratio <= 1.0:
        raise StudioError(f"speed ratio: {LEAST_RATIO:g} to 1, not {ratio!r}")
    return replace(memory, ratio=ratio)


def _required(seen: Seen) -> RobotState:
    if seen.state is None or seen.age > STALE:
        raise StudioError(f"The robot is not heard: {seen.trouble or 'connect it first'}")
    return seen.state
