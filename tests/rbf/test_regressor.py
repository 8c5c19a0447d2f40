import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.rbf import NotFittedError, RBFRegressor
from studio.rbf.basis import gaussian_design

INDEX = np.arange(1.0, 143.0)
SETTINGS = [
    {},
    {"centers": "random", "width": "dmax", "solver": "svd", "random_state": 1},
    {"centers": "kmeans", "width": "nearest", "solver": 1e-3, "random_state": 1},
    {"centers": "grid", "width": "gcv", "solver": "svd"},
    {"centers": "ols"},
]


def pooled_least_squares(inputs, rows, model, ridge):
    """The same fit by numpy alone, on every sample, with the penalty as further rows."""
    design = gaussian_design(inputs[:, np.newaxis], model.centers_, model.width_)
    mean = rows.mean(axis=0)
    count = design.shape[1]
    stacked = np.vstack([design, math.sqrt(ridge) * np.eye(count)])
    padded = np.vstack([rows - mean, np.zeros((count, rows.shape[1]))])
    return mean, np.linalg.lstsq(stacked, padded, rcond=None)[0]


@pytest.mark.parametrize("ridge", [0.0, 0.01, 5.0])
def test_aggregated_fit_is_the_fit_of_all_samples(demonstrations, pool, ridge):
    index, rows = pool(demonstrations(0))
    keep = np.random.default_rng(0).permutation(len(index))[:400]  # uneven counts, unsorted
    index, rows = index[keep], rows[keep]
    model = RBFRegressor(15, width=8.0, solver=ridge).fit(index, rows)
    mean, weights = pooled_least_squares(index, rows, model, ridge)
    np.testing.assert_allclose(model.bias_, mean, rtol=1e-12)
    np.testing.assert_allclose(model.weights_, weights, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("options", SETTINGS)
def test_the_unit_of_time_changes_nothing(demonstrations, pool, options):
    index, rows = pool(demonstrations(1))
    units = {"samples": (1.0, 0.0), "seconds": (1 / 30, 1234.5), "share": (1 / 141, -1 / 141)}
    answers, widths = [], []
    asked = np.linspace(1.0, 142.0, 500)
    for scale, shift in units.values():
        model = RBFRegressor(**options).fit(index * scale + shift, rows)
        answers.append(model.predict(asked * scale + shift))
        widths.append(model.width_ / scale)
    np.testing.assert_allclose(answers[1], answers[0], atol=1e-7)
    np.testing.assert_allclose(answers[2], answers[0], atol=1e-7)
    np.testing.assert_allclose(widths, widths[0])


def test_given_width_and_centers_are_in_the_users_unit():
    seconds = INDEX / 30.0
    model = RBFRegressor(centers=[0.5, 2.0, 4.0], width=0.75).fit(seconds, np.sin(seconds))
    np.testing.assert_array_equal(model.centers_, [[0.5], [2.0], [4.0]])
    assert model.width_ == 0.75
    design = gaussian_design(seconds[:, np.newaxis], model.centers_, 0.75)
    np.testing.assert_allclose(design @ model.weights_ + model.bias_, model.predict(seconds))


@pytest.mark.parametrize("factor", [1e-200, 1e-8, 1e8, 1e200])
def test_the_scale_of_inputs_and_targets_changes_nothing(factor):
    plain = RBFRegressor(12).fit(INDEX, np.sin(INDEX / 20.0)).predict(INDEX)
    scaled = RBFRegressor(12).fit(INDEX * factor, np.sin(INDEX / 20.0) * factor)
    np.testing.assert_allclose(scaled.predict(INDEX * factor) / factor, plain, atol=1e-9)
    assert scaled.score(INDEX * factor, np.sin(INDEX / 20.0) * factor) > 0.999


def test_each_output_may_have_its_own_scale():
    curves = np.column_stack([np.sin(INDEX / 20.0), 1e9 * np.cos(INDEX / 15.0), np.ones(142)])
    predicted = RBFRegressor(30).fit(INDEX, curves).predict(INDEX)
    np.testing.assert_allclose(predicted / [1.0, 1e9, 1.0], curves / [1.0, 1e9, 1.0], atol=1e-4)


@pytest.mark.parametrize("options", SETTINGS)
def test_constant_outputs_are_met_exactly(options):
    model = RBFRegressor(**options).fit(np.tile(INDEX, 3), np.full((426, 2), 0.1))
    np.testing.assert_array_equal(model.predict([-50.0, 3.3, 900.0]), np.full((3, 2), 0.1))


@pytest.mark.parametrize("options", SETTINGS)
def test_a_single_sample_is_what_is_answered_everywhere(options):
    model = RBFRegressor(**options).fit([4.0], [[0.3, -2.0]])
    np.testing.assert_array_equal(model.predict([4.0, 7.0]), [[0.3, -2.0], [0.3, -2.0]])


def test_far_from_all_centers_the_mean_is_answered():
    model = RBFRegressor(20).fit(INDEX, np.sin(INDEX / 20.0))
    assert model.predict([1e6])[0] == pytest.approx(np.sin(INDEX / 20.0).mean(), rel=1e-12)


@pytest.mark.parametrize("neurons", [1, 2, 3, 141, 142, 143, 300])
@pytest.mark.parametrize("options", SETTINGS)
def test_any_neuron_count_gives_a_sane_network(neurons, options):
    curve = np.sin(INDEX / 20.0)
    model = RBFRegressor(neurons, **options).fit(np.tile(INDEX, 2), np.tile(curve, 2))
    assert model.centers_.shape[0] <= neurons
    assert model.centers_.shape[0] == neurons or options.get("centers") == "ols"
    assert 1 <= model.rank_ <= min(neurons, 142)
    assert 1.0 <= model.effective_dof_ <= min(neurons + 1, 142) + 1e-9
    between = model.predict(np.linspace(1.0, 142.0, 1000))
    assert np.abs(between).max() < 1.5
    if neurons >= 141:
        assert model.score(INDEX, curve) > 0.99


def test_predictions_keep_the_shape_of_the_targets():
    curve = np.sin(INDEX / 20.0)
    flat = RBFRegressor(10).fit(INDEX, curve)
    deep = RBFRegressor(10).fit(INDEX[:, np.newaxis], curve[:, np.newaxis])
    assert flat.predict(INDEX).shape == (142,)
    assert deep.predict(INDEX).shape == (142, 1)
    np.testing.assert_array_equal(flat.predict(INDEX), deep.predict(INDEX)[:, 0])
    assert flat.weights_.shape == (10,)
    assert isinstance(flat.bias_, float)
    assert deep.weights_.shape == (10, 1)


def test_two_dimensions_are_learned():
    generator = np.random.default_rng(0)
    inputs = generator.uniform(-1.0, 1.0, size=(300, 2))
    targets = np.sin(2.0 * inputs[:, 0]) * inputs[:, 1]
    for centers in ("grid", "kmeans", "random"):
        model = RBFRegressor(40, centers=centers, random_state=0).fit(inputs, targets)
        asked = generator.uniform(-0.9, 0.9, size=(100, 2))
        truth = np.sin(2.0 * asked[:, 0]) * asked[:, 1]
        assert np.abs(model.predict(asked) - truth).max() < 0.05


def test_the_order_of_samples_changes_nothing(demonstrations, pool):
    index, rows = pool(demonstrations(2))
    order = np.random.default_rng(0).permutation(len(index))
    for options in SETTINGS:
        first = RBFRegressor(**options).fit(index, rows).predict(INDEX)
        second = RBFRegressor(**options).fit(index[order], rows[order]).predict(INDEX)
        np.testing.assert_allclose(first, second, atol=1e-7)


def test_refit_forgets():
    model = RBFRegressor(10).fit(np.zeros((3, 2)) + np.arange(3)[:, None], np.ones((3, 2)))
    model.fit(INDEX, INDEX)
    fresh = RBFRegressor(10).fit(INDEX, INDEX)
    assert vars(model).keys() == vars(fresh).keys()
    np.testing.assert_array_equal(model.predict(INDEX), fresh.predict(INDEX))


def test_1000_random_draws_with_duplicates_are_never_garbage(demonstrations, pool):
    # Bar 6: no LinAlgError, no NaN, and no network that does worse than the mean alone.
    index, rows = pool(demonstrations(3, samples=40))
    generator = np.random.default_rng(0)
    spread = np.square(rows - rows.mean(axis=0)).mean(axis=0)
    for draw in range(1000):
        centers = generator.choice(index, size=generator.integers(1, 61))  # repeats among them
        model = RBFRegressor(centers=centers, width="dmax", solver="svd").fit(index, rows)
        errors = np.square(model.predict(index) - rows).mean(axis=0)
        assert np.isfinite(model.weights_).all(), draw
        assert (errors <= spread * (1.0 + 1e-9)).all(), draw
        assert model.rank_ <= len(np.unique(centers))


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    inputs=st.lists(
        st.sampled_from([0.0, 1.0, 1.0 + 1e-12, 2.5, 7.0, 1e4]), min_size=1, max_size=9
    ),
    neurons=st.integers(1, 12),
    options=st.sampled_from(SETTINGS),
    width=st.sampled_from([None, 1e-9, 1.0, 1e9]),
    seed=st.integers(0, 9),
)
def test_whatever_the_samples_the_fit_is_no_worse_than_their_mean(
    inputs, neurons, options, width, seed
):
    targets = np.random.default_rng(seed).normal(size=len(inputs))
    model = RBFRegressor(neurons, **options | ({} if width is None else {"width": width}))
    model.fit(inputs, targets)
    predicted = model.predict(inputs)
    assert np.isfinite(predicted).all()
    limit = np.square(targets - targets.mean()).sum()
    assert np.square(predicted - targets).sum() <= limit * (1.0 + 1e-6) + 1e-12


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"n_neurons": 0}, ValueError, "n_neurons is at least 1, not 0"),
        ({"n_neurons": 2.5}, TypeError, "n_neurons is a whole number, not 2.5"),
        ({"width": 0.0}, ValueError, "width is a finite number above 0, not 0.0"),
        ({"width": math.nan}, ValueError, "width is a finite number above 0"),
        ({"width": "wide"}, ValueError, "width is one of 'dmax', 'nearest', 'gcv' or a positive"),
        ({"width": None}, TypeError, "width is a number, not None"),
        ({"solver": -1.0}, ValueError, "ridge as solver is a finite number at least 0, not -1.0"),
        ({"solver": "qr"}, ValueError, "solver is one of 'svd', 'gcv' or a ridge"),
        ({"rcond": 1.0}, ValueError, "rcond is below 1"),
        ({"centers": "nowhere"}, ValueError, "centers is one of"),
    ],
)
def test_settings_that_cannot_be_used_are_refused_in_words(options, error, words):
    with pytest.raises(error, match=words):
        RBFRegressor(**options).fit(INDEX, INDEX)


def test_prediction_before_fit_is_refused():
    with pytest.raises(NotFittedError, match="RBFRegressor was taught nothing yet: call fit"):
        RBFRegressor().predict(INDEX)
