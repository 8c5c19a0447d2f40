"""What can be found out of a linked robot before it is used: `studio link check`.

It looks, and moves nothing; `moving_check.py` is the half that moves, through the gatekeeper like
everything else, and only after a person has confirmed it.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from studio.engine.links.driver import STALE, LinkThread
from studio.engine.links.link import ARMS_JOINTS, RobotState
from studio.engine.robot import CONTROL_RATE, JOINT_NAMES, load_robot

CONNECTS_WITHIN, LISTENS = 8.0, 2.0  # [s]
SLOWEST = 10.0  # [Hz] of states: with fewer, one that is lost makes them stale
_OUTSIDE = 0.05  # [rad] by which a joint may be measured beyond its limits
# What a person should see where a joint's angle rises; `tests/engine/links/test_check.py` asks the
# robot's kinematics.
RISES = {
    "s0": "the arm swings counterclockwise, seen from above",
    "s1": "the arm goes down",
    "e0": "the arm rolls clockwise, seen from its shoulder",
    "e1": "the forearm bends; with the elbow's roll at 0, down",
    "w0": "the forearm rolls clockwise, seen from the elbow",
    "w1": "the hand bends; with the forearm's roll at 0, down",
    "w2": "the hand rolls clockwise, seen from the wrist",
}


@dataclass(frozen=True)
class Finding:
    """One step's result."""

    name: str
    passed: bool | None  # None: nobody can tell from here, or it was not tried
    words: str


@dataclass(frozen=True, eq=False)
class Looking:
    """What the check needs: the robot's thread, a clock [s], and a way to let a tick pass."""

    thread: LinkThread
    now: Callable[[], float]
    tick: Callable[[], None]

    def wait_for(self, reached: Callable[[], bool], seconds: float) -> bool:
        """Let ticks pass until something is so; return whether it became so in time."""
        end = self.now() + seconds
        while not reached():
            if self.now() > end:
                return False
            self.tick()
        return True


def look(looking: Looking) -> Iterator[Finding]:
    """Look at a robot, and move nothing; the first finding that fails may be the last."""
    thread, begun = looking.thread, looking.now()
    if not looking.wait_for(lambda: thread.is_open, CONNECTS_WITHIN):
        yield Finding("connection", False, thread.trouble or "it does not answer")
        return
    yield Finding("connection", True, f"answers after {looking.now() - begun:.1f} s")
    if not looking.wait_for(lambda: thread.heard is not None, CONNECTS_WITHIN):
        words = thread.trouble or "it tells neither joints nor state: see that the robot is on"
        yield Finding("states", False, words)
        return
    yield _states(looking)
    heard = thread.heard
    if heard is None:
        yield Finding("joints", False, f"lost meanwhile: {thread.trouble}")
        return
    yield _joints(heard.state)
    yield _limits(thread, heard.state)
    yield _stops(heard.state)
    yield Finding("order and sign", None, f"compare with the robot: {_angles(heard.state)}")


def _states(looking: Looking) -> Finding:
    """Count states for a while, and see how late they come."""
    thread, stamps, worst = looking.thread, set(), 0.0
    for _ in range(round(LISTENS * CONTROL_RATE)):
        heard = thread.heard
        if heard is not None:
            stamps.add(heard.at)
            worst = max(worst, heard.age(looking.now()))
        looking.tick()
    rate = len(stamps) / LISTENS
    words = f"{rate:.0f} a second seen at {CONTROL_RATE} Hz, {1000 * worst:.0f} ms old at most"
    is_well = rate >= SLOWEST and worst < STALE
    return Finding(
        "states",
        is_well,
        words
        if is_well
        else f"{words}; needed: {SLOWEST:.0f}, and "
        f"{1000 * STALE:.0f} ms: a cable instead of radio, or a machine less busy",
    )


def _joints(state: RobotState) -> Finding:
    if state.untold:
        return Finding("joints", False, f"does not tell {', '.join(state.untold)}")
    return Finding("joints", True, f"all {len(ARMS_JOINTS)} of both arms, by name")


def _limits(thread: LinkThread, state: RobotState) -> Finding:
    """Compare what is measured with our limits, and the robot's own limits with ours."""
    robot = load_robot()
    outside = [
        f"{name} at {angle:.2f} rad"
        for name, angle, low, high in zip(
            JOINT_NAMES,
            state.positions.tolist(),
            robot.limits.lower.tolist(),
            robot.limits.upper.tolist(),
            strict=True,
        )
        if angle < low - _OUTSIDE or angle > high + _OUTSIDE
    ]
    if outside:
        return Finding("limits", False, f"beyond the limits: {', '.join(outside)}")
    told = (
        f"its own {len(thread.limits)} are kept, too"
        if thread.limits
        else "it tells none of its own"
    )
    return Finding("limits", True, f"all joints are within the studio's; {told}")


def _stops(state: RobotState) -> Finding:
    power = "its motors have power" if state.enabled else "its motors have no power"
    if state.stop:
        return Finding("emergency stop", False, state.stop)
    return Finding("emergency stop", True, f"none holds it; {power}. {state.fault}".strip())


def _angles(state: RobotState) -> str:
    degrees = np.degrees(state.positions)
    told = zip(JOINT_NAMES, degrees.tolist(), strict=True)
    return ", ".join(f"{name} {angle:+.0f}°" for name, angle in told if name in ARMS_JOINTS)
