import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline

from studio.rbf import NewrbRegressor, RBFRegressor, smoothness

INDEX = np.arange(1.0, 143.0)


def spline_of(taught):
    return make_smoothing_spline(INDEX, taught.mean(axis=0))


def test_the_spline_itself_is_as_smooth_as_itself(demonstrations):
    taught = demonstrations(0)
    spline = spline_of(taught)
    found = smoothness(lambda x: spline(x[:, 0]), taught)
    assert found.ratio == pytest.approx(1.0, rel=1e-6)
    assert found.deviation.max() < 1e-7


def test_another_demonstration_or_stamp_is_held_against_another_spline(demonstrations):
    """A spline is kept for the next question; it may not answer for other demonstrations."""
    taught = demonstrations(0)
    for shift in (0.0, 1e-5, 0.0):
        shifted = taught + shift * INDEX[:, np.newaxis]
        spline = spline_of(shifted)
        assert smoothness(lambda x, s=spline: s(x[:, 0]), shifted).deviation.max() < 1e-7
        later = smoothness(lambda x, s=spline: s(x[:, 0] - 7.0), shifted, INDEX + 7.0)
        assert later.deviation.max() < 1e-7


def test_a_known_ripple_is_measured(demonstrations):
    taught = demonstrations(1)
    spline = spline_of(taught)
    found = smoothness(lambda x: spline(x[:, 0]) + 0.02 * np.sin(2.0 * np.pi * x), taught)
    np.testing.assert_allclose(found.deviation, 0.02, rtol=0.03)
    expected = 0.02 * (2.0 * np.pi) ** 2 / np.sqrt(2.0)
    np.testing.assert_allclose(found.acceleration, expected, rtol=0.02)


def test_the_unit_of_time_changes_no_ratio(demonstrations, pool):
    taught = demonstrations(2)
    index, rows = pool(taught)
    ratios = []
    for unit in (1.0, 1.0 / 30.0):
        model = RBFRegressor(20).fit(index * unit, rows)
        ratios.append(smoothness(model.predict, taught, INDEX * unit).ratio)
    assert ratios[0] == pytest.approx(ratios[1], rel=1e-4)


def test_newrb_ripples_where_the_default_does_not(demonstrations, pool):
    taught = demonstrations(3)
    smooth = smoothness(RBFRegressor(50).fit(*pool(taught)).predict, taught)
    rippled = smoothness(NewrbRegressor(max_neurons=142).fit(*pool(taught)).predict, taught)
    assert smooth.ratio < 1.1
    assert smooth.deviation.max() < 0.01
    assert rippled.ratio > 3.0


def test_curves_that_stand_still_are_smooth():
    still = np.full((2, 20, 1), 0.3)
    assert smoothness(lambda x: np.full(len(x), 0.3), still).ratio == 1.0
    assert smoothness(np.sin, still).ratio == np.inf


@pytest.mark.parametrize(
    ("curve", "arguments", "words"),
    [
        (np.sin, (np.ones((2, 4, 1)),), "5 or more rising stamps"),
        (np.sin, (np.ones((2, 6, 1)), np.ones(6)), "5 or more rising stamps"),
        (np.sin, ([np.ones((6, 1)), np.ones((7, 1))],), "stamps must be shared"),
        (np.sin, (np.ones((2, 6, 2)),), "2 finite outputs"),
        (lambda x: x * np.nan, (np.ones((2, 6, 1)),), "1 finite outputs"),
    ],
)
def test_what_cannot_be_compared_is_refused_in_words(curve, arguments, words):
    with pytest.raises(ValueError, match=words):
        smoothness(curve, *arguments)
