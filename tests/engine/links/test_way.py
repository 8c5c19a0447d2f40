"""The way of a robot's arms: whole limbs, both limits, and a guard that sees where the rest is."""

import numpy as np
import pytest

from studio.engine.links.wanted import Wanted
from studio.engine.links.way import START_SPEED, Way
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES
from tests.engine.links.rig import LEFT, ROBOT, SCENES, posed, ready


def wanted(arms: str = "left", gripper: bool = False) -> Wanted:
    return Wanted(ready(), True, "", arms, SCENES[arms], gripper)


@pytest.mark.parametrize(("arms", "count"), [("left", 7), ("right", 7), ("both", 14)])
def test_whole_limbs(arms: str, count: int) -> None:
    way = Way.of(wanted(arms), posed({}), {})
    assert len(way.joints) == count
    assert [JOINT_NAMES[column] for column in way.columns] == list(way.joints)


def test_it_fits_what_it_was_made_for() -> None:
    way = Way.of(wanted(), posed({}), {})
    assert way.fits(wanted())
    assert not way.fits(wanted("both"))
    assert not way.fits(wanted(gripper=True))


def test_the_guard_looks_anew_where_the_other_arm_was_led_elsewhere() -> None:
    """Stretched out forward, the right arm is in the left one's way."""
    way = Way.of(wanted(), posed({}), {})
    assert way.beside(posed({"left_s0": 0.5, "right_s0": -0.36})) is way
    across = posed({"right_s0": 0.785, "right_s1": -0.5, "right_e1": 0.0})
    moved = way.beside(across)
    assert moved is not way
    assert np.allclose(moved.guard.rest[:15], across)

    def reached(by: Way) -> float:
        sent = by.within(posed({"left_s1": -0.5}))
        target = sent.copy()
        target[0] = -1.5
        for _ in range(200):
            sent = by.step(sent, target, 1.0, CONTROL_PERIOD).sent
        return float(sent[0])

    assert reached(way) < reached(moved) - 0.1


def test_an_untold_head_is_no_matter() -> None:
    measured = posed({"head_pan": np.nan})
    way = Way.of(wanted(), measured, {})
    assert way.beside(measured) is way


def test_the_start_goes_straight_and_slowly() -> None:
    way = Way.of(wanted(), posed({}), {})
    sent, goal = way.within(posed({})), way.within(ready())
    step = way.start_step(sent, goal, 1.0, CONTROL_PERIOD).sent - sent
    assert np.abs(step).max() == pytest.approx(START_SPEED * CONTROL_PERIOD)
    assert np.allclose(step / np.abs(step).max(), (goal - sent) / np.abs(goal - sent).max())
    slow = way.start_step(sent, goal, 0.05, CONTROL_PERIOD).sent - sent
    limits = ROBOT.limits_of(LEFT)
    assert (np.abs(slow) <= 0.05 * limits.velocity * CONTROL_PERIOD).all()
