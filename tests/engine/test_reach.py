"""Wanted angles lie inside the limits, keep the forearm, and change sides only for good reason."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.pipeline import Pipeline
from studio.engine.reach import Reach
from studio.engine.retarget import DRIVEN_JOINTS
from studio.engine.robot import load_robot
from studio.engine.skeleton import SIDES, Side
from tests.engine.test_retarget import DIRECTIONS, unit


def reach_of(side: Side = "left", mapping="exact") -> Reach:
    return Pipeline.for_robot(load_robot(), side, mapping).reach


@settings(deadline=None, derandomize=True)
@given(arms=st.lists(st.tuples(DIRECTIONS, DIRECTIONS), min_size=1, max_size=20),
       side=st.sampled_from(SIDES), mapping=st.sampled_from(["exact", "paper"]))  # fmt: skip
def test_never_outside_the_limits(arms, side: Side, mapping) -> None:
    reach, memory = reach_of(side, mapping), None
    limits = load_robot().limits_of([f"{side}_{joint}" for joint in DRIVEN_JOINTS])
    for i, (u, f) in enumerate(arms):
        memory, wanted = reach.step(
            memory, tuple(unit(np.array(u))), tuple(unit(np.array(f))), i / 30
        )
        assert (limits.lower <= wanted).all()
        assert (wanted <= limits.upper).all()


def forearm_error(angles, forearm, side: Side) -> float:
    """Return by how much the robot's forearm misses the person's [rad]."""
    robot = load_robot()
    body = np.zeros(15)
    body[[robot.joint_index(f"{side}_{joint}") for joint in DRIVEN_JOINTS]] = angles
    elbow, wrist = (robot.forward_kinematics(f"{side}_{link}", body)[:3, 3] for link in
                    ("lower_elbow", "lower_forearm"))  # fmt: skip
    return math.acos(np.clip(unit(wrist - elbow) @ forearm, -1.0, 1.0))


def test_a_hanging_arm_keeps_its_forearm_better_than_by_clamping() -> None:
    """Arms at the side, forearm anywhere in front: 37 % of real arm frames are like this."""
    reach, rng = reach_of(), np.random.default_rng(6)
    limits = load_robot().limits_of([f"left_{joint}" for joint in DRIVEN_JOINTS])
    from studio.engine.retarget import solve_arm  # noqa: PLC0415

    solved, clamped = [], []
    for _ in range(300):
        u = tuple(unit(np.array([0.0, 0.0, -1.0]) + 0.15 * rng.normal(size=3)))
        f = tuple(unit(np.array([1.0, -0.3, 0.0]) + 0.4 * rng.normal(size=3)))
        solved.append(forearm_error(reach.step(None, u, f, 0.0)[1], f, "left"))
        naive = np.clip(solve_arm(u, f, "left", "exact"), limits.lower, limits.upper)
        clamped.append(forearm_error(naive, f, "left"))
    assert np.median(solved) < 1e-6
    assert np.median(solved) < 0.05 * np.median(clamped)


def roll_through(e0s: list[float]) -> list[float]:
    """Return the wanted e0 for a forearm that rolls through these angles, 30 a second."""
    reach, memory, found = reach_of(), None, []
    u = (1.0, 0.0, 0.0)
    for i, e0 in enumerate(e0s):
        f = _forearm_with(u, e0)
        memory, wanted = reach.step(memory, u, f, i / 30)
        found.append(wanted[2])
    return found


def _forearm_with(u, e0: float):
    """Return a forearm bent by 90° whose e0 is as given, found on the circle around ``u``."""
    from studio.engine.retarget import solve_arm  # noqa: PLC0415

    def miss(angle: float) -> float:
        f = (0.0, math.cos(angle), math.sin(angle))
        return abs(math.remainder(solve_arm(u, f, "left", "exact")[2] - e0, 2 * math.pi))

    angle = min(np.linspace(-math.pi, math.pi, 721), key=miss)
    return (0.0, math.cos(angle), math.sin(angle))


def test_a_forearm_waving_about_180_degrees_never_changes_sides() -> None:
    wave = [math.radians(175 + 30 * math.sin(2 * math.pi * 0.4 * i / 30)) for i in range(300)]
    assert np.abs(np.diff(roll_through(wave))).max() < math.pi


def test_a_forearm_well_past_180_degrees_changes_sides_within_a_second() -> None:
    roll = [math.radians(min(150 + 20 * i / 30, 270)) for i in range(240)]
    found = roll_through(roll)
    past = next(i for i, e0 in enumerate(roll) if e0 > math.radians(240))
    changed = next(i for i in range(1, len(found)) if abs(found[i] - found[i - 1]) > math.pi)
    assert past < changed <= past + 30
    assert found[-1] == pytest.approx(math.radians(270 - 360), abs=0.02)


def test_a_straight_arm_holds_its_roll() -> None:
    reach = reach_of()
    u = (1.0, 0.0, 0.0)
    memory, bent = reach.step(None, u, tuple(unit(np.array([1.0, 0.0, 1.0]))), 0.0)
    for sway in (0.05, -0.05):
        memory, straight = reach.step(memory, u, tuple(unit(np.array([1.0, sway, 0.0]))), 0.1)
        assert straight[2] == pytest.approx(bent[2])
