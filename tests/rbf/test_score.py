import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.metrics import r2_score

from studio.rbf import largest_error, mean_squared_error, pooled_variance_floor, r_squared


@settings(deadline=None, derandomize=True)
@given(count=st.integers(2, 5), samples=st.integers(1, 9), seed=st.integers(0, 99))
def test_error_is_floor_plus_error_of_the_mean_curve(count, samples, seed):
    generator = np.random.default_rng(seed)
    demonstrations = generator.normal(size=(count, samples, 3))
    curve = generator.normal(size=(samples, 3))  # any function of time
    over_all = np.square(demonstrations - curve).mean(axis=(0, 1))
    of_mean = mean_squared_error(demonstrations.mean(axis=0), curve)
    floor = pooled_variance_floor(demonstrations)
    assert floor.reason == ""
    np.testing.assert_allclose(over_all, floor.value + of_mean, rtol=1e-12)


@pytest.mark.parametrize(
    ("demonstrations", "stamps", "words"),
    [
        (np.zeros((1, 5, 2)), None, "a single demonstration"),
        ([np.zeros((5, 2)), np.zeros((6, 2))], None, "do not share their stamps"),
        (np.zeros((2, 3, 1)), [[0.0, 1.0, 2.0], [0.0, 1.0, 2.5]], "do not share their stamps"),
    ],
)
def test_without_shared_stamps_there_is_no_floor_but_a_reason(demonstrations, stamps, words):
    floor = pooled_variance_floor(demonstrations, stamps)
    assert floor.value is None
    assert words in floor.reason


@pytest.mark.parametrize("stamps", [None, [0.0, 1.0, 2.0], [[0.0, 1.0, 2.0], [0.0, 1.0, 2.0]]])
def test_shared_stamps_give_a_floor(stamps):
    demonstrations = np.array([[[0.0], [1.0], [2.0]], [[2.0], [1.0], [4.0]]])
    value = pooled_variance_floor(demonstrations, stamps).value
    np.testing.assert_allclose(value, [(1 + 0 + 1) / 3])


@pytest.mark.parametrize(
    ("demonstrations", "stamps", "words"),
    [
        ([], None, "shape"),
        (np.zeros((3, 4)), None, "shape"),
        ([np.zeros((4, 2)), np.zeros((4, 3))], None, "the same number of columns"),
        ([[[np.nan]], [[0.0]]], None, "must be finite"),
        (np.zeros((2, 3, 1)), [0.0, 1.0], "stamps have shape"),
    ],
)
def test_demonstrations_that_are_none_are_refused(demonstrations, stamps, words):
    with pytest.raises(ValueError, match=words):
        pooled_variance_floor(demonstrations, stamps)


def test_errors_by_hand():
    targets, predictions = [[0.0, 1.0], [2.0, 3.0]], [[1.0, 1.0], [2.0, 0.0]]
    np.testing.assert_array_equal(mean_squared_error(targets, predictions), [0.5, 4.5])
    np.testing.assert_array_equal(largest_error(targets, predictions), [1.0, 3.0])
    with pytest.raises(ValueError, match="must match"):
        mean_squared_error([1.0], [[1.0]])


@settings(deadline=None, derandomize=True)
@given(
    seed=st.integers(0, 999), outputs=st.integers(1, 3), constant=st.booleans(), exact=st.booleans()
)
def test_r_squared_is_scikit_learns(seed, outputs, constant, exact):
    generator = np.random.default_rng(seed)
    targets = generator.normal(size=(7, outputs))
    if constant:
        targets[:, 0] = 2.0
    predictions = targets.copy() if exact else targets + generator.normal(size=targets.shape)
    assert r_squared(targets, predictions) == pytest.approx(r2_score(targets, predictions))


@pytest.mark.parametrize("factor", [1e-200, 1e200])
def test_r_squared_knows_no_scale(factor):
    targets, predictions = np.array([1.0, 2.0, 4.0]), np.array([1.5, 2.0, 3.5])
    expected = r_squared(targets, predictions)
    assert r_squared(targets * factor, predictions * factor) == pytest.approx(expected)
