"""What the collision guard costs in each tick, and what pybullet's search would cost instead.

Run it by ``python tests/bench/bench_guard.py``; it takes some ten seconds.
"""

from collections.abc import Callable
from time import process_time
from timeit import repeat

import numpy as np
import pybullet

from studio.engine.arms import Arms
from studio.engine.guard import Guard
from studio.engine.performance import start_world
from studio.engine.pipeline import ready_pose
from studio.engine.robot import CONTROL_PERIOD, load_robot
from studio.engine.skeleton import FloatArray

ROUNDS = 200
LOWER = (0.0, 0.03, 0.0, 0.0)  # [rad] s0, s1, e0, e1 in a tick


def main() -> None:
    """Measure and print."""
    robot = load_robot()
    links = microseconds(lambda: robot.link_poses(np.zeros(15)))
    print(f"the robot's kinematics, for comparison: {links:.0f} us")
    for arms in ("left", "both"):
        cost_of(arms)
    print(f"the same by pybullet, left: {microseconds(by_pybullet):.0f} us")


def cost_of(arms: Arms) -> None:
    """Print what a step of the guard costs where nothing is near, and where the desk is."""
    guard = Guard.for_robot(load_robot(), arms)
    ready, step = ready_pose(arms, "exact"), np.tile(LOWER, 2 if arms == "both" else 1)
    low = ready
    for _ in range(100):
        low = guard.step(low, low + step, CONTROL_PERIOD).sent

    def cost(before: FloatArray, command: FloatArray) -> float:
        return microseconds(lambda: guard.step(before, command, CONTROL_PERIOD))

    pairs = len(guard.clearance.pairs)
    free, held = cost(ready, ready - step), cost(low, low + step)
    print(f"guard, {arms}, {pairs} pairs: {free:.0f} us where it passes, {held:.0f} us at the desk")


def by_pybullet() -> None:
    """Set the arm's joints and ask for the distance of each watched pair of links once."""
    client = {"physicsClientId": WORLD._client}
    for motor in WORLD._baxter._motors[:7]:
        pybullet.resetJointState(motor.body, motor.joint, 0.0, **client)
    for (one, link), (other, second) in LINK_PAIRS:
        pybullet.getClosestPoints(one, other, 0.16, link, second, **client)


def link_pairs() -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """Return pybullet's bodies and links that the left arm's guard keeps apart."""
    client = {"physicsClientId": WORLD._client}
    bodies = sorted({motor.body for motor in WORLD._baxter._motors})
    numbers = {
        pybullet.getJointInfo(body, index, **client)[12].decode(): (body, index)
        for body in bodies
        for index in range(pybullet.getNumJoints(body, **client))
    }
    numbers["base"] = (bodies[0], -1)
    clearance = Guard.for_robot(load_robot(), "left").clearance
    pairs, parts = clearance.pairs, clearance.capsules.parts
    rounded = zip(pairs.first[: pairs.rounded], pairs.second[: pairs.rounded], strict=True)
    return sorted({(numbers[parts[i].link], numbers[parts[j].link]) for i, j in rounded})


def microseconds(work: Callable[[], object]) -> float:
    """Return the least mean processor time [µs] of five rounds."""
    return min(repeat(work, timer=process_time, number=ROUNDS, repeat=5)) / ROUNDS * 1e6


WORLD = start_world("left", "exact")
LINK_PAIRS = link_pairs()

if __name__ == "__main__":
    main()
