import math

import numpy as np
import pytest

from studio.rbf import NewrbRegressor, NotFittedError, mean_squared_error
from studio.rbf.basis import gaussian_design
from tests.rbf.naive import naive_picks

INDEX = np.arange(1.0, 143.0)


@pytest.mark.parametrize("duplicates", ["mask", "matlab"])
@pytest.mark.parametrize("neurons", [1, 7, 60, 200])
def test_history_is_the_truth_at_every_size(demonstrations, pool, duplicates, neurons):
    index, rows = pool(demonstrations(0))
    model = NewrbRegressor(max_neurons=neurons, duplicates=duplicates).fit(index, rows)
    last = model.history_[-1]
    np.testing.assert_allclose(last.mse, mean_squared_error(rows, model.predict(index)), rtol=1e-9)
    assert last.floor_ratio == pytest.approx(last.mse.sum() / model.floor_.sum())
    assert last.neurons == len(model.centers_) == len(model.history_)
    assert last.distinct_centers == len(np.unique(model.centers_))
    assert [step.neurons for step in model.history_] == list(range(1, last.neurons + 1))


def test_mse_never_rises_and_never_undercuts_the_floor(demonstrations, pool):
    index, rows = pool(demonstrations(1))
    for duplicates in ("mask", "matlab"):
        model = NewrbRegressor(max_neurons=150, duplicates=duplicates).fit(index, rows)
        mse = np.array([step.mse for step in model.history_])
        assert (np.diff(mse, axis=0) <= 1e-15).all()
        assert (mse >= model.floor_ * (1.0 - 1e-12)).all()


def test_weights_and_bias_are_least_squares_over_all_samples(demonstrations, pool):
    index, rows = pool(demonstrations(2))
    model = NewrbRegressor(spread=4.0, max_neurons=12).fit(index, rows)
    design = gaussian_design(index[:, np.newaxis], model.centers_, model.width_)
    expected = np.linalg.lstsq(np.column_stack([design, np.ones(len(index))]), rows)[0]
    np.testing.assert_allclose(model.weights_, expected[:-1], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(model.bias_, expected[-1], rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_picks_are_those_of_a_naive_port_over_all_samples(seed):
    generator = np.random.default_rng(seed)
    stamps = generator.permutation(40).astype(float)
    index = np.concatenate([stamps, stamps[:25]])  # some repeat, none in order
    rows = np.sin(index[:, np.newaxis] / [3.0, 5.0]) + generator.normal(size=(65, 2)) * [0.1, 2.0]
    model = NewrbRegressor(max_neurons=25).fit(index, rows)
    design = gaussian_design(index[:, np.newaxis], stamps[:, np.newaxis], model.width_)
    np.testing.assert_array_equal(model.centers_[:, 0], stamps[naive_picks(design, rows, 25)])


def test_the_first_sample_wins_a_tie():
    assert NewrbRegressor(max_neurons=1).fit([7.0, 3.0], [1.0, 1.0]).centers_[0, 0] == 7.0
    assert NewrbRegressor(max_neurons=1).fit([3.0, 7.0], [1.0, 1.0]).centers_[0, 0] == 3.0


def test_a_larger_network_begins_as_the_smaller_one():
    curve = np.sin(INDEX / 9.0)
    small = NewrbRegressor(spread=3.0, max_neurons=10).fit(INDEX, curve)
    large = NewrbRegressor(spread=3.0, max_neurons=30).fit(INDEX, curve)
    np.testing.assert_array_equal(large.centers_[:10], small.centers_)
    assert large.history_[9].mse == small.history_[9].mse


def test_growth_stops_as_soon_as_the_goal_is_met():
    model = NewrbRegressor(goal=1e-3, spread=8.0).fit(INDEX, np.sin(INDEX / 9.0))
    *before, last = model.history_
    assert model.stop_reason_ == "goal"
    assert last.mse[0] < 1e-3
    assert all(step.mse[0] >= 1e-3 for step in before)


def test_growth_stops_at_the_limit_or_when_nothing_is_left():
    limited = NewrbRegressor(max_neurons=4).fit(INDEX, INDEX)
    assert (limited.stop_reason_, len(limited.centers_)) == ("max_neurons", 4)
    all_of_them = NewrbRegressor().fit(np.tile(INDEX[:20], 2), np.arange(40.0))
    assert (all_of_them.stop_reason_, len(all_of_them.centers_)) == ("exhausted", 20)
    with_repeats = NewrbRegressor(duplicates="matlab").fit(np.tile(INDEX[:20], 2), np.arange(40.0))
    assert (with_repeats.stop_reason_, len(with_repeats.centers_)) == ("exhausted", 40)


def test_spread_keeps_the_users_unit():
    rows = np.sin(INDEX / 12.0)
    samples = NewrbRegressor(spread=2.0, max_neurons=20).fit(INDEX, rows)
    seconds = NewrbRegressor(spread=2.0 / 30.0, max_neurons=20).fit(INDEX / 30.0, rows)
    np.testing.assert_allclose(seconds.centers_ * 30.0, samples.centers_)
    np.testing.assert_allclose(seconds.predict(INDEX / 30.0), samples.predict(INDEX), atol=1e-9)
    assert samples.width_ == pytest.approx(2.0 / math.sqrt(2.0 * math.log(2.0)))
    other = NewrbRegressor(spread=2.0, max_neurons=20).fit(INDEX / 30.0, rows)
    assert np.abs(other.predict(INDEX / 30.0) - samples.predict(INDEX)).max() > 1e-3


def test_no_floor_where_no_input_repeats():
    model = NewrbRegressor(max_neurons=3).fit(INDEX, INDEX)
    assert model.floor_ is None
    assert all(step.floor_ratio is None for step in model.history_)
    constant = NewrbRegressor(max_neurons=3).fit(np.zeros(4), np.ones(4))
    np.testing.assert_array_equal(constant.floor_, [0.0])
    assert constant.history_[-1].floor_ratio is None


@pytest.mark.parametrize("duplicates", ["mask", "matlab"])
@pytest.mark.parametrize("target", [0.0, 0.1])
def test_constant_targets_and_single_samples(duplicates, target):
    model = NewrbRegressor(duplicates=duplicates)
    for inputs in (np.zeros(1), np.zeros(5), np.tile(INDEX[:6], 3)):
        predicted = model.fit(inputs, np.full(len(inputs), target)).predict(inputs)
        np.testing.assert_allclose(predicted, target, atol=1e-12)


def test_two_dimensions_are_learned():
    inputs = np.random.default_rng(0).uniform(-1.0, 1.0, size=(150, 2))
    targets = np.sin(2.0 * inputs[:, 0]) * inputs[:, 1]
    assert (
        NewrbRegressor(spread=1.0, max_neurons=40).fit(inputs, targets).score(inputs, targets)
        > 0.999
    )


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"goal": -1.0}, ValueError, "goal is a finite number at least 0"),
        ({"spread": 0.0}, ValueError, "spread is a finite number above 0"),
        ({"spread": "wide"}, TypeError, "spread is a number, not 'wide'"),
        ({"max_neurons": 0}, ValueError, "max_neurons is at least 1"),
        ({"duplicates": "allow"}, ValueError, "duplicates is one of 'mask', 'matlab'; not 'allow'"),
    ],
)
def test_settings_that_cannot_be_used_are_refused_in_words(options, error, words):
    with pytest.raises(error, match=words):
        NewrbRegressor(**options).fit(INDEX, INDEX)


def test_targets_whose_squares_overflow_are_refused():
    with pytest.raises(ValueError, match="use another unit"):
        NewrbRegressor().fit(INDEX, INDEX * 1e200)


def test_prediction_before_fit_is_refused():
    with pytest.raises(NotFittedError, match="NewrbRegressor was taught nothing yet"):
        NewrbRegressor().predict(INDEX)
