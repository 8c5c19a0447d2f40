"""Percentiles by two roads, and only of the last frames."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import StudioError
from studio.engine.live.latency import LINKS, WINDOW, Delays, LatencyChain, Spread

spreads = st.none() | st.builds(Spread, st.floats(0.0, 10.0), st.floats(0.0, 10.0))
chains = st.builds(LatencyChain, **dict.fromkeys(LINKS, spreads))


@settings(deadline=None, derandomize=True)
@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=500))
def test_percentiles_are_those_of_the_window(delays: list[float]) -> None:
    noted = Delays()
    for delay in delays:
        noted.add(delay)
    window = np.array(delays[-WINDOW:])
    spread = noted.spread()
    assert spread is not None
    assert spread.p50 == np.percentile(window, 50, method="inverted_cdf")
    assert np.percentile(window, 98, method="lower") <= spread.p99 <= window.max()
    above = noted.spread(above_least=True)
    assert above is not None
    assert 0.0 <= above.p50 <= above.p99 <= window.max() - window.min()


def test_nothing_measured_is_nothing() -> None:
    noted = Delays()
    noted.add(1.0)
    noted.clear()
    assert noted.spread() is None


@settings(deadline=None, derandomize=True)
@given(chains)
def test_a_chain_comes_back_from_json(chain: LatencyChain) -> None:
    assert LatencyChain.of_dict(json.loads(json.dumps(chain.to_dict()))) == chain


@pytest.mark.parametrize(
    "told",
    [[1.0], [1.0, 2.0, 3.0], [1.0, float("nan")], [1.0, 10**400], [True, 1.0], 1.0, "ab", {}],
)
def test_what_is_no_spread_is_refused(told: object) -> None:
    with pytest.raises(StudioError, match="delays of total"):
        LatencyChain.of_dict({"total": told})


@settings(deadline=None, derandomize=True)
@given(st.lists(chains, min_size=1, max_size=9))
def test_over_a_run_usual_is_the_median_and_rare_the_worst(told: list[LatencyChain]) -> None:
    whole = LatencyChain.over(told)
    for link in LINKS:
        known = [each for each in (getattr(chain, link) for chain in told) if each is not None]
        spread = getattr(whole, link)
        if not known:
            assert spread is None
            continue
        usual = np.array([each.p50 for each in known])
        assert spread.p50 == np.percentile(usual, 50, method="inverted_cdf")
        assert spread.p99 == max(each.p99 for each in known)
