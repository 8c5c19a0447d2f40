import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.rbf.leastsquares import GrowingLeastSquares, orthogonalized


@settings(deadline=None, derandomize=True, max_examples=40)
@given(columns=st.integers(1, 8), seed=st.integers(0, 99))
def test_it_is_weighted_least_squares_with_a_bias_at_every_size(columns, seed):
    generator = np.random.default_rng(seed)
    root = np.sqrt(generator.integers(1, 5, size=20).astype(float))
    design = root[:, np.newaxis] * generator.normal(size=(20, columns))
    targets = root[:, np.newaxis] * generator.normal(size=(20, 2))
    fit = GrowingLeastSquares(root, targets)
    for size in range(1, columns + 1):
        fit.add(design[:, size - 1])
        whole = np.column_stack([root, design[:, :size]])
        expected = np.linalg.lstsq(whole, targets)[0]
        bias, weights = fit.solution()
        np.testing.assert_allclose(np.vstack([bias, weights]), expected, atol=1e-9)
        np.testing.assert_allclose(fit.residual, targets - whole @ expected, atol=1e-9)


def test_a_column_that_adds_nothing_gets_no_weight():
    generator = np.random.default_rng(0)
    first, targets = generator.normal(size=9), generator.normal(size=(9, 1))
    fit = GrowingLeastSquares(np.ones(9), targets)
    fit.add(first)
    before = fit.residual.copy()
    fit.add(3.0 * first - 2.0)  # a sum of the bias and the first
    np.testing.assert_array_equal(fit.residual, before)
    _, weights = fit.solution()
    assert weights.shape == (2, 1)
    assert weights[1, 0] == 0.0


def test_orthogonalized_holds_where_once_would_not():
    generator = np.random.default_rng(1)
    basis = np.linalg.qr(generator.normal(size=(30, 10)))[0]
    nearly_inside = basis @ generator.normal(size=(10, 1)) + 1e-9 * generator.normal(size=(30, 1))
    rest = orthogonalized(nearly_inside, basis)
    assert np.abs(basis.T @ rest).max() < 1e-14 * np.linalg.norm(rest)
