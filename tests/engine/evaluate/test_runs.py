"""Trials are the same by one worker and by two, in any order, and those that are known stay."""

import pytest

from studio.engine.errors import StudioError
from studio.engine.evaluate.runs import Conditions, Trial, checked_count, run_trials
from tests.engine.evaluate.swings import WIDTHS, conditions, scene, swing

ASKED = [Trial(swing(), trial, conditions()) for trial in range(1, 4)]


def test_one_worker_and_two_have_the_same_outcomes() -> None:
    pytest.importorskip("joblib", reason="joblib comes with the extra compare")
    one = run_trials(ASKED, jobs=1)
    assert list(one) == [each.key for each in ASKED]
    assert {outcome.done for outcome in one.values()} == {True, False}
    assert run_trials(ASKED, jobs=2) == one
    assert run_trials(ASKED[::-1], jobs=1) == one


def test_it_tells_how_far_it_has_come() -> None:
    told = []
    run_trials(ASKED[:3], jobs=1, progress=lambda over, of: told.append((over, of)))
    assert told == [(0, 3), (1, 3), (2, 3), (3, 3)]


def test_all_motions_meet_the_same_trials() -> None:
    other, same = swing("other", -0.3), conditions()
    for trial in range(3):
        one, two = same.variation(swing(), trial), same.variation(other, trial)
        assert one.measures == two.measures
    assert same.variation(swing(), 0).measures != conditions(1).variation(swing(), 0).measures


def test_impossible_numbers_are_refused_in_words() -> None:
    with pytest.raises(StudioError, match="seed: a whole number from 0, not -1"):
        Conditions(scene(), WIDTHS, -1)
    with pytest.raises(StudioError, match="trials: 1 to 1,000,000, not 0"):
        checked_count("trials", 0)
    assert checked_count("replays", 0, least=0) == 0
