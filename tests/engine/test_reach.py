"""Wanted angles lie inside the limits, keep the forearm, and change sides only for good reason."""

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.reach import Reach
from studio.engine.retarget import DRIVEN_JOINTS, solve_arm
from studio.engine.robot import load_robot
from studio.engine.skeleton import SIDES, Side
from tests.engine.test_retarget import DIRECTIONS, unit


def reach_of(side: Side = "left", mapping="exact") -> Reach:
    return Reach.for_robot(load_robot(), side, mapping)


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
        memory, wanted = reach.step(memory, u, _forearm_with(e0), i / 30)
        found.append(wanted[2])
    return found


@cache
def _circle() -> tuple[np.ndarray, np.ndarray]:
    """Return angles on the circle of forearms bent by 90°, and the e0 of each."""
    angles = np.linspace(-math.pi, math.pi, 721)
    forearms = [(0.0, math.cos(angle), math.sin(angle)) for angle in angles]
    return angles, np.array([solve_arm((1.0, 0.0, 0.0), f, "left", "exact")[2] for f in forearms])


def _forearm_with(e0: float) -> tuple[float, float, float]:
    """Return a forearm across u = (1, 0, 0) whose e0 is as given, to half a degree."""
    angles, e0s = _circle()
    angle = angles[np.argmin(np.abs(np.angle(np.exp(1j * (e0s - e0)))))]
    return (0.0, math.cos(angle), math.sin(angle))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("hertz", [0.1, 0.4, 1.0])
def test_a_forearm_waving_about_180_degrees_never_changes_sides(sign: float, hertz: float) -> None:
    swing = [30 * math.sin(2 * math.pi * hertz * i / 30) for i in range(300)]
    wave = [sign * math.radians(180 + degrees) for degrees in swing]
    assert np.abs(np.diff(roll_through([sign * 2.5, *wave]))).max() < math.pi


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("speed", [10.0, 20.0, 60.0])  # [deg/s]
def test_a_forearm_well_past_180_degrees_changes_sides_within_a_second(
    sign: float, speed: float
) -> None:
    roll = [sign * math.radians(min(150 + speed * i / 30, 270)) for i in range(480)]
    found = roll_through(roll)
    past = next(i for i, e0 in enumerate(roll) if abs(e0) > math.radians(240))
    changed = next(i for i in range(1, len(found)) if abs(found[i] - found[i - 1]) > math.pi)
    assert past < changed <= past + 30
    assert found[-1] == pytest.approx(-sign * math.radians(90), abs=0.02)


def test_back_before_half_a_second_is_over_nothing_changes() -> None:
    there = [150 + 60 * i / 30 for i in range(50)]  # to 248°, at 60°/s
    roll = [math.radians(degrees) for degrees in [*there, *reversed(there)]]
    assert max(there) > 245
    assert np.abs(np.diff(roll_through(roll))).max() < math.pi


def test_a_straight_arm_holds_its_roll() -> None:
    reach = reach_of()
    u = (1.0, 0.0, 0.0)
    memory, bent = reach.step(None, u, tuple(unit(np.array([1.0, 0.0, 1.0]))), 0.0)
    for sway in (0.05, -0.05):
        memory, straight = reach.step(memory, u, tuple(unit(np.array([1.0, sway, 0.0]))), 0.1)
        assert straight[2] == pytest.approx(bent[2])


def upper_arm_near_vertical(turn: float, tilt: float) -> tuple[float, float, float]:
    """Return an upper arm ``tilt`` off straight up, pointing ``turn`` from the mount's forward."""
    turn += 0.7854
    return (math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), math.cos(tilt))


@pytest.mark.parametrize("mapping", ["exact", "paper"])
def test_s0_turns_the_slower_the_nearer_the_upper_arm_is_to_vertical(mapping) -> None:
    """Against the law itself: 1.5 rad/s · min(1, h / 0.35)², h the upper arm's shadow."""
    reach, forearm = reach_of(mapping=mapping), (0.6, 0.0, 0.8)
    for tilt in (0.0, 0.02, 0.1, 0.2, 0.5, 1.2):
        memory, _ = reach.step(None, upper_arm_near_vertical(0.0, tilt), forearm, 0.0)
        upper_arm = upper_arm_near_vertical(1.5, tilt)
        shadow = math.cos(solve_arm(upper_arm, forearm, "left", mapping)[1])
        before = memory.s0
        memory, wanted = reach.step(memory, upper_arm, forearm, 1 / 30)
        assert abs(wanted[0] - before) <= 1.5 * min(1.0, shadow / 0.35) ** 2 / 30 + 1e-12
        assert memory.s0 == wanted[0]


def test_while_s0_is_slowed_the_forearm_still_points_where_the_persons_does() -> None:
    reach = reach_of()
    forearm = tuple(unit(np.array([0.9, 0.1, 0.2])))
    memory, before = reach.step(None, upper_arm_near_vertical(0.0, 0.3), forearm, 0.0)
    upper_arm = upper_arm_near_vertical(1.2, 0.3)
    _, free = reach.step(None, upper_arm, forearm, 0.0)
    _, wanted = reach.step(memory, upper_arm, forearm, 1 / 30)
    assert abs(free[0] - before[0]) > 0.2
    assert abs(wanted[0] - before[0]) < 0.06
    assert forearm_error(wanted, forearm, "left") < 1e-6
