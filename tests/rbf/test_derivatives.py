import numpy as np
import pytest

from studio.rbf import NotFittedError, RBFRegressor
from studio.rbf.derivatives import gaussian_derivative

INDEX = np.arange(1.0, 143.0)


def differences(function, at, order, step):
    """Central differences of any order, of fourth-order accuracy."""
    if order == 0:
        return function(at)

    def lower(x):
        return differences(function, x, order - 1, step)

    near = lower(at + step) - lower(at - step)
    far = lower(at + 2.0 * step) - lower(at - 2.0 * step)
    return (8.0 * near - far) / (12.0 * step)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_derivatives_are_the_limit_of_differences(demonstrations, pool, order):
    model = RBFRegressor(30).fit(*pool(demonstrations(0)))
    asked = np.linspace(-10.0, 150.0, 200)
    exact = model.derivative(asked, order)
    found = differences(model.predict, asked, order, step=0.2 * order)
    assert exact.shape == (200, 3)
    np.testing.assert_allclose(found, exact, atol=1e-4 * np.abs(exact).max())


def test_the_first_derivatives_are_those_of_the_formula():
    inputs, centers, width = np.linspace(-3.0, 3.0, 50)[:, np.newaxis], np.array([[0.5]]), 0.7
    u = (inputs - centers) / width
    bell = np.exp(-0.5 * u**2)
    for order, expected in [(1, -u * bell), (2, (u**2 - 1) * bell), (3, -(u**3 - 3 * u) * bell)]:
        found = gaussian_derivative(inputs, centers, width, order)
        np.testing.assert_allclose(found, expected, atol=1e-12)


def test_the_jacobian_is_the_limit_of_differences():
    generator = np.random.default_rng(0)
    inputs = generator.uniform(-1.0, 1.0, size=(200, 2))
    targets = np.column_stack([np.sin(2.0 * inputs[:, 0]) * inputs[:, 1], inputs[:, 0] ** 2])
    model = RBFRegressor(30).fit(inputs, targets)
    jacobian = model.derivative(inputs[:20])
    assert jacobian.shape == (20, 2, 2)
    for column in range(2):
        step = 1e-4 * np.eye(2)[column]
        moved = model.predict(inputs[:20] + step) - model.predict(inputs[:20] - step)
        np.testing.assert_allclose(jacobian[:, :, column], moved / 2e-4, atol=1e-5)
    flat = RBFRegressor(30).fit(inputs, targets[:, 0])
    assert flat.derivative(inputs[:20]).shape == (20, 2)


@pytest.mark.parametrize("scale", [1e-60, 1e-3, 1e9])
def test_the_unit_of_time_divides_out(scale):
    plain = RBFRegressor(20).fit(INDEX, np.sin(INDEX / 20.0))
    scaled = RBFRegressor(20).fit(INDEX * scale, np.sin(INDEX / 20.0))
    for order in (1, 2):
        np.testing.assert_allclose(
            scaled.derivative(INDEX * scale, order) * scale**order,
            plain.derivative(INDEX, order),
            atol=1e-9,
        )


def test_shapes_are_those_of_the_targets_and_far_away_nothing_changes():
    model = RBFRegressor(20).fit(INDEX, np.sin(INDEX / 20.0))
    assert model.derivative(INDEX).shape == (142,)
    np.testing.assert_array_equal(model.derivative([-1e7, 1e7, 1e200], 3), 0.0)


def test_what_cannot_be_answered_is_refused_in_words():
    with pytest.raises(NotFittedError):
        RBFRegressor().derivative(INDEX)
    model = RBFRegressor(5).fit(INDEX * 1e-200, np.sin(INDEX))
    with pytest.raises(ValueError, match="another unit"):
        model.derivative(INDEX * 1e-200, 2)
    with pytest.raises(ValueError, match="order is at least 1, not 0"):
        model.derivative(INDEX, 0)
    plane = RBFRegressor(5).fit(np.random.default_rng(0).normal(size=(20, 2)), np.arange(20.0))
    with pytest.raises(ValueError, match="order 1 only, not 2"):
        plane.derivative([[0.0, 0.0]], 2)
