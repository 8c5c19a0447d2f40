import numpy as np
import pytest

from studio.rbf import NotFittedError, RBFRegressor
from studio.rbf.basis import gaussian_design

INDEX = np.arange(1.0, 143.0)
CENTERS = np.linspace(1.0, 142.0, 12)


def noisy(seed, repeats=3, noise=0.1, outputs=2):
    generator = np.random.default_rng(seed)
    inputs = np.tile(INDEX, repeats)
    curves = np.sin(inputs[:, np.newaxis] / 15.0 + np.arange(outputs))
    return inputs, curves + noise * generator.normal(size=curves.shape)


def test_without_a_ridge_it_is_the_prediction_interval_of_least_squares():
    inputs, rows = noisy(0)
    model = RBFRegressor(centers=CENTERS, width=15.0, solver="svd").fit(inputs, rows)
    design = gaussian_design(inputs[:, np.newaxis], model.centers_, 15.0)
    centered = rows - rows.mean(axis=0)
    weights, rest, _, _ = np.linalg.lstsq(design, centered, rcond=None)
    asked = gaussian_design(np.linspace(-20.0, 160.0, 70)[:, np.newaxis], model.centers_, 15.0)
    covariance = np.linalg.inv(design.T @ design)
    share = 1.0 + 1.0 / len(inputs) + np.einsum("nm,ml,nl->n", asked, covariance, asked)
    noise = np.sqrt(rest / (len(inputs) - model.effective_dof_))
    mean, std = model.predict(np.linspace(-20.0, 160.0, 70), return_std=True)
    np.testing.assert_allclose(std, np.sqrt(share)[:, np.newaxis] * noise, rtol=1e-6)
    np.testing.assert_allclose(mean, asked @ weights + rows.mean(axis=0), atol=1e-8)
    np.testing.assert_array_equal(mean, model.predict(np.linspace(-20.0, 160.0, 70)))


def test_with_a_ridge_it_is_a_gaussian_process_with_the_networks_own_kernel():
    inputs, rows = noisy(1)
    ridge = 0.3
    model = RBFRegressor(centers=CENTERS, width=15.0, solver=ridge).fit(inputs, rows)
    asked = np.linspace(-20.0, 160.0, 70)
    taught = gaussian_design(inputs[:, np.newaxis], model.centers_, 15.0)
    at = gaussian_design(asked[:, np.newaxis], model.centers_, 15.0)
    kernel = taught @ taught.T / ridge + np.eye(len(inputs))  # in units of the noise
    cross = at @ taught.T / ridge
    variance = np.square(at).sum(axis=1) / ridge - np.einsum(
        "nq,qn->n", cross, np.linalg.solve(kernel, cross.T)
    )
    share = np.sqrt(1.0 + 1.0 / len(inputs) + variance)
    _, std = model.predict(asked, return_std=True)
    np.testing.assert_allclose(std, np.multiply.outer(share, model.noise_), rtol=1e-6)


@pytest.mark.parametrize("options", [{}, {"centers": "ols"}, {"width": "dmax", "solver": "svd"}])
def test_it_covers_new_samples_as_often_as_it_says(options):
    inside = []
    for seed in range(10):
        model = RBFRegressor(25, **options).fit(*noisy(seed))
        assert model.noise_ == pytest.approx([0.1, 0.1], rel=0.15)
        fresh, rows = noisy(1000 + seed)
        mean, std = model.predict(fresh, return_std=True)
        inside.append(np.abs(rows - mean) < 1.96 * std)
    assert np.mean(inside) == pytest.approx(0.95, abs=0.01)


def test_repeated_inputs_change_nothing_but_their_number():
    inputs, rows = noisy(2)
    jitter = inputs + 1e-9 * np.arange(len(inputs))  # all distinct, and all but the same
    settings = {"centers": CENTERS, "width": 15.0, "solver": 0.1}
    repeated = RBFRegressor(**settings).fit(inputs, rows).predict(INDEX, return_std=True)
    distinct = RBFRegressor(**settings).fit(jitter, rows).predict(INDEX, return_std=True)
    np.testing.assert_allclose(repeated[1], distinct[1], rtol=1e-6)


def test_the_scale_of_inputs_and_targets_divides_out():
    inputs, rows = noisy(3)
    plain = RBFRegressor(20).fit(inputs, rows).predict(INDEX, return_std=True)[1]
    scaled = RBFRegressor(20).fit(inputs * 1e-9, rows * 1e200)
    std = scaled.predict(INDEX * 1e-9, return_std=True)[1]
    np.testing.assert_allclose(std / 1e200, plain, rtol=1e-6)


def test_shapes_and_constant_outputs():
    model = RBFRegressor(5).fit(np.tile(INDEX, 2), np.full(284, 0.1))
    assert model.noise_ == 0.0
    np.testing.assert_array_equal(model.predict(INDEX, return_std=True)[1], np.zeros(142))


def test_where_nothing_tells_noise_from_curve_it_says_so():
    model = RBFRegressor(solver="svd", width=1.0, centers=INDEX).fit(INDEX, np.sin(INDEX))
    assert model.noise_ is None
    model.predict(INDEX)
    with pytest.raises(ValueError, match="less than one degree of freedom"):
        model.predict(INDEX, return_std=True)
    with pytest.raises(ValueError, match="less than one degree of freedom"):
        RBFRegressor(5).fit([1.0], [2.0]).predict([1.0], return_std=True)
    with pytest.raises(NotFittedError):
        RBFRegressor().predict([1.0], return_std=True)
