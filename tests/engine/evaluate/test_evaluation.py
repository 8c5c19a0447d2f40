"""Rates, pairs and parts of made-up outcomes; and one evaluation that is really done."""

from itertools import pairwise

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.evaluate.evaluation import evaluate, paired, pooled
from studio.engine.evaluate.interval import wilson
from studio.engine.evaluate.runs import Trial
from tests.engine.evaluate.made_up import evaluation, made_up
from tests.engine.evaluate.swings import conditions, swing


def test_an_evaluation_is_the_trials_one_by_one() -> None:
    other = swing("other", -0.3)
    found = evaluate(swing(), [other], conditions(), 3, 1, jobs=1)
    assert found.tested.outcomes == tuple(Trial(swing(), i, conditions()).run() for i in range(3))
    (beside,) = found.replays
    assert beside.outcomes == (Trial(other, 0, conditions()).run(),)
    assert found.tested.rate.trials == 3


def test_a_rate_counts_and_failures_are_told_by_their_number() -> None:
    shown = made_up("model", "++-+-")
    assert (shown.rate.successes, shown.rate.trials) == (3, 5)
    assert shown.failures == (("the block still stands", 2),)


def test_pairs_are_of_the_same_trials_alone() -> None:
    found = paired(made_up("one", "++--+++"), made_up("other", "+-+-"))
    assert (found.both, found.only_first, found.only_second, found.neither) == (1, 1, 1, 1)
    assert found.chance == 1.0
    clear = paired(made_up("one", "+" * 12), made_up("other", "-" * 12))
    assert clear.chance == pytest.approx(2 / 2**12)


def test_the_demonstrations_rate_counts_trials_and_not_replays() -> None:
    rate, low, high = pooled([made_up("a", "++++"), made_up("b", "++--")])
    assert rate == 0.75
    assert (low, high) == wilson(3.0, 4)
    assert pooled([]) == (0.0, 0.0, 1.0)


def test_parts_share_the_trials_and_show_what_hurts() -> None:
    found = evaluation()
    trials = range(len(found.tested.outcomes))
    drawn = [found.conditions.variation(swing("model"), trial).measures for trial in trials]
    for name, parts in found.parts.items():
        values = np.array([each[name] for each in drawn])
        assert sum(part.rate.trials for part in parts) == len(values)
        for part in parts:
            inside = [
                outcome.done
                for outcome, value in zip(found.tested.outcomes, values, strict=True)
                if part.low <= value <= part.high
            ]
            assert (part.rate.successes, part.rate.trials) == (sum(inside), len(inside))
        assert all(one.high < two.low for one, two in pairwise(parts))
    assert [part.rate.trials for part in found.parts["block x [cm]"]] == [4, 4, 4]


def test_impossible_numbers_of_trials_are_refused() -> None:
    with pytest.raises(StudioError, match="trials: 1 to"):
        evaluate(swing(), (), conditions(), 0, 0)
    with pytest.raises(StudioError, match="replays: 0 to"):
        evaluate(swing(), (), conditions(), 1, -1)
