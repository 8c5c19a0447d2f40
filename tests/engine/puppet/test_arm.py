"""The arm's laws: rigid bones, a hand where it should be, an elbow that never jumps."""

import math

import numpy as np
import pytest
from hypothesis import given, settings, strategies

from studio.engine.puppet.arm import (
    EASY_SWIVEL,
    FARTHEST,
    FLEXION,
    LARGEST_SWING,
    LEVERS,
    NEAREST,
    SWIVEL,
    allowed,
    arm_points,
    reaching,
    swivel_towards,
)
from studio.engine.standing import FOREARM, TO_HAND, UPPER_ARM

lawful = settings(deadline=None, derandomize=True, max_examples=200)
swivels = strategies.floats(*SWIVEL)
flexions = strategies.floats(*FLEXION)
number = strategies.floats(-1.0, 1.0)
anywhere = strategies.tuples(number, number, number).map(np.array)


@strategies.composite
def allowed_angles(draw) -> np.ndarray:
    turn, heading = draw(strategies.floats(0.0, LARGEST_SWING)), draw(strategies.floats(-4.0, 4.0))
    swing = (turn * math.cos(heading), turn * math.sin(heading))
    return allowed(np.array([*swing, draw(flexions), draw(swivels)]))


@given(anywhere, swivels)
@lawful
def test_bones_keep_their_lengths(hand, swivel) -> None:
    at = arm_points(reaching(hand, swivel))
    lengths = [
        np.linalg.norm(at.elbow),
        np.linalg.norm(at.wrist - at.elbow),
        np.linalg.norm(at.hand - at.wrist),
        np.linalg.norm(at.thumb - at.wrist),
        np.linalg.norm(at.tip - at.wrist),
    ]
    thumb = math.hypot(TO_HAND, 0.042)
    assert lengths == pytest.approx([UPPER_ARM, FOREARM, TO_HAND, thumb, 0.15], abs=1e-12)


@given(allowed_angles())
@lawful
def test_the_angles_of_a_hand_are_found_again(angles) -> None:
    """Two roads: from angles to the hand, and from the hand to angles."""
    hand = arm_points(angles).hand
    again = reaching(hand, float(angles[3]))
    assert arm_points(again).hand == pytest.approx(hand, abs=1e-9)
    assert again == pytest.approx(angles, abs=1e-6)


@given(anywhere, swivels)
@lawful
def test_a_hand_out_of_reach_goes_as_near_as_it_can(hand, swivel) -> None:
    reached = arm_points(reaching(hand, swivel)).hand
    distance = np.linalg.norm(reached)
    assert NEAREST - 1e-12 <= distance <= FARTHEST + 1e-12
    swing = np.hypot(*reaching(hand, swivel)[:2])
    if swing < LARGEST_SWING - 1e-9 and np.linalg.norm(hand) > 1e-6:  # on the line to it
        assert reached / distance == pytest.approx(hand / np.linalg.norm(hand), abs=1e-9)
        assert distance == pytest.approx(np.clip(np.linalg.norm(hand), NEAREST, FARTHEST))


@given(allowed_angles(), strategies.tuples(*[number] * 4).map(np.array))
@lawful
def test_no_point_moves_further_than_the_levers_say(angles, step) -> None:
    """The bound that keeps dragged hands at a person's speed; the elbow's is 1.5 times that."""
    after = allowed(angles + 0.05 * step)
    here, there = arm_points(angles), arm_points(after)
    bound = np.linalg.norm((after - angles) * LEVERS)
    assert np.linalg.norm(there.hand - here.hand) <= bound + 1e-12
    assert np.linalg.norm(there.elbow - here.elbow) <= 1.5 * bound + 1e-12


@given(allowed_angles(), strategies.floats(1e-7, 1e-4), anywhere)
@lawful
def test_a_small_drag_moves_the_arm_little(angles, size, towards) -> None:
    hand = arm_points(angles).hand
    before, after = (reaching(at, EASY_SWIVEL) for at in (hand, hand + size * towards))
    moved = np.linalg.norm(arm_points(after).elbow - arm_points(before).elbow)
    # A nearly straight arm bends 40 times as fast as its hand comes nearer: 1 / sin 5°, and more.
    assert moved <= 40.0 * size * max(np.linalg.norm(towards), 1e-3) + 1e-12


@given(anywhere, swivels)
@lawful
def test_an_elbow_goes_where_it_is_dragged(hand, swivel) -> None:
    angles = reaching(hand, swivel)
    elbow = arm_points(angles).elbow
    assert swivel_towards(reaching(hand, EASY_SWIVEL), elbow) == pytest.approx(swivel, abs=1e-6)


@given(anywhere, anywhere)
@lawful
def test_no_swivel_brings_the_elbow_nearer_to_where_it_is_dragged(hand, target) -> None:
    angles = reaching(hand, EASY_SWIVEL)
    found = swivel_towards(angles, target)
    line = arm_points(angles).hand / np.linalg.norm(arm_points(angles).hand)
    if np.linalg.norm(target - (target @ line) * line) < 0.01:
        assert found == angles[3]
        return

    def gap(swivel: float) -> float:
        return float(np.linalg.norm(arm_points(np.append(angles[:3], swivel)).elbow - target))

    assert gap(found) <= min(gap(each) for each in np.linspace(*SWIVEL, 40)) + 1e-9


def test_where_an_easy_elbow_hangs() -> None:
    forward, down, up = (np.array(v) for v in ((0.4, 0.1, 0), (0, 0.1, -0.45), (0, 0.1, 0.45)))
    assert arm_points(reaching(forward, 0.0)).elbow[2] < -0.1  # below the line
    assert arm_points(reaching(forward, EASY_SWIVEL)).elbow[1] > 0.1  # out to the left
    assert arm_points(reaching(down, 0.0)).elbow[0] < -0.1  # behind a hanging arm
    assert arm_points(reaching(up, 0.0)).elbow[0] > 0.1  # before a raised one
    thumb = arm_points(reaching(forward, 0.0))
    assert thumb.thumb[2] > thumb.hand[2]  # the palm looks inward


def test_straight_behind_the_neck_the_hand_stays_in_reach() -> None:
    middle = arm_points(np.array([0.0, 0.0, 1.0, EASY_SWIVEL])).hand
    angles = reaching(-middle, EASY_SWIVEL)
    assert np.isfinite(angles).all()
    assert np.hypot(*angles[:2]) == pytest.approx(LARGEST_SWING)
    assert np.isfinite(arm_points(reaching(np.zeros(3), EASY_SWIVEL)).hand).all()
