"""Wilson's interval and McNemar's test against scipy's own, and against what they promise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import binom, binomtest

from studio.engine.evaluate.interval import mcnemar, rate_of, wilson


@settings(deadline=None, derandomize=True, max_examples=200)
@given(st.integers(1, 2000), st.floats(0.0, 1.0))
def test_it_is_scipys_wilson_interval(trials: int, share: float) -> None:
    successes = round(share * trials)
    low, high = wilson(successes, trials)
    theirs = binomtest(successes, trials).proportion_ci(method="wilson")
    assert (low, high) == pytest.approx((theirs.low, theirs.high), abs=1e-12)
    assert 0.0 <= low <= successes / trials <= high <= 1.0


@pytest.mark.parametrize("trials", [20, 100, 1000])
def test_it_covers_the_true_rate_as_often_as_it_says(trials: int) -> None:
    """Exactly, by the binomial distribution; on the average over rates, as Wilson's does."""
    intervals = np.array([wilson(k, trials) for k in range(trials + 1)])
    covered = []
    for rate in np.linspace(0.02, 0.98, 97):
        inside = (intervals[:, 0] <= rate) & (rate <= intervals[:, 1])
        covered.append(binom.pmf(np.flatnonzero(inside), trials, rate).sum())
    assert np.mean(covered) == pytest.approx(0.95, abs=0.01)
    assert min(covered) > 0.83


def test_nothing_and_all_and_no_trials() -> None:
    assert rate_of(0, 10).low == 0.0
    assert rate_of(0, 10).high > 0.2
    assert rate_of(10, 10).high == 1.0
    assert (rate_of(0, 0).low, rate_of(0, 0).high, rate_of(0, 0).value) == (0.0, 1.0, 0.0)


@settings(deadline=None, derandomize=True, max_examples=100)
@given(st.integers(0, 60), st.integers(0, 60))
def test_mcnemar_is_the_binomial_test_of_the_differing_trials(one: int, other: int) -> None:
    expected = binomtest(one, one + other).pvalue if one + other else 1.0
    assert mcnemar(one, other) == pytest.approx(expected, abs=1e-12)
    assert mcnemar(one, other) == mcnemar(other, one)


def test_it_is_exact_where_floats_would_overflow() -> None:
    assert 0.0 < mcnemar(900, 1100) < 1e-4


def test_a_rate_is_said() -> None:
    assert rate_of(87, 100).words == "87 % (79 to 92.2 %), 87 of 100"
