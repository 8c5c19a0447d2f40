"""The grip is learned as the arms are: one column more."""

from functools import cache

import numpy as np
import pytest

from studio.engine.demonstration import SAMPLES, Demonstration, DemonstrationSet
from studio.engine.hands import HandCommand, HandOptions, HandTrack
from studio.engine.learned_hands import CLOSED_ABOVE, grip_rows, learned_hands
from studio.engine.teaching import INDEX_TIME, LEARNERS, LearnerSettings, learn

GRIPPER = HandOptions(gripper=True)


def shown(begin: float, end: float, options: HandOptions = GRIPPER) -> Demonstration:
    """Return a demonstration of 4 s in which the hand is closed from ``begin`` to ``end`` [s]."""
    times = np.linspace(0.0, 4.0, 121)
    closed = [HandCommand((), bool(begin <= time < end)) for time in times]
    hands = HandTrack.of(options, times, closed)
    sent = np.column_stack([np.sin(times + begin + i) for i in range(4)])
    return Demonstration("shown", "left", "exact", times, sent, 0, 120, hands)


@cache
def taught() -> DemonstrationSet:
    return DemonstrationSet.of([shown(1.0 + late, 3.0 + late) for late in (0.0, 0.1, 0.15, 0.25)])


@pytest.mark.parametrize("neurons", [10, 50])
def test_one_network_of_all_columns_learns_the_same_grip(neurons: int) -> None:
    """Two roads: the grip apart, and as a fifth column beside the joints."""
    tracks = [each.hands for each in taught().demonstrations]
    whole = np.concatenate([taught().rows, grip_rows(tracks)[..., None]], axis=2)
    model = LEARNERS["rbf"](neurons).fit(np.tile(INDEX_TIME, 4), whole.reshape(4 * SAMPLES, 5))
    told = model.predict(INDEX_TIME)[:, 4]
    lesson = learn(taught(), LearnerSettings("rbf", neurons))
    sure = np.abs(told - CLOSED_ABOVE) > 1e-9
    assert sure.sum() > SAMPLES - 3
    np.testing.assert_array_equal(lesson.hands.closed[sure], told[sure] > CLOSED_ABOVE)


@pytest.mark.parametrize("name", ["rbf", "newrb"])
def test_it_closes_and_opens_once_about_when_the_demonstrations_did(name) -> None:
    hands = learn(taught(), LearnerSettings(name, 50)).hands
    closes, opens = hands.times[np.flatnonzero(np.diff(hands.closed.astype(int)))]
    assert closes == pytest.approx(1.125, abs=0.15)
    assert opens == pytest.approx(3.125, abs=0.15)


def test_a_single_neuron_cannot_tell_when() -> None:
    few, many = (learned_hands(taught(), LEARNERS["rbf"](n), INDEX_TIME) for n in (1, 50))
    meant = taught().hands.closed
    assert np.count_nonzero(few.closed != meant) > 5 * np.count_nonzero(many.closed != meant)


def test_hands_without_a_gripper_stay_what_they_were() -> None:
    level = HandOptions(wrist="level")
    plain = DemonstrationSet.of([shown(1.0, 2.0, level)])
    hands = learned_hands(plain, LEARNERS["rbf"](9), INDEX_TIME)
    np.testing.assert_array_equal(hands.closed, plain.hands.closed)
    times = np.linspace(0.0, 2.0, 61)
    none = Demonstration("bare", "left", "exact", times, np.zeros((61, 4)), 0, 60)
    assert learned_hands(DemonstrationSet.of([none]), LEARNERS["rbf"](9), INDEX_TIME) is None
