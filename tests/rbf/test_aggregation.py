import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from studio.rbf.aggregation import distinct_inputs

few_inputs = hnp.arrays(np.float64, st.tuples(st.integers(1, 12), st.integers(1, 2)),
                        elements=st.sampled_from([-1.5, 0.0, 0.25, 3.0]))  # fmt: skip


@settings(deadline=None, derandomize=True)
@given(inputs=few_inputs, seed=st.integers(0, 99))
def test_nothing_is_lost(inputs, seed):
    targets = np.random.default_rng(seed).normal(size=(len(inputs), 3))
    data = distinct_inputs(inputs, targets)
    np.testing.assert_array_equal(data.inputs[data.group] * data.input_unit, inputs)
    np.testing.assert_array_equal(inputs[data.first], data.inputs * data.input_unit)
    assert data.counts.sum() == len(inputs)
    for place, point in enumerate(data.inputs * data.input_unit):
        same = (inputs == point).all(axis=1)
        assert same.sum() == data.counts[place]
        mean = data.means[place] * data.target_units
        np.testing.assert_allclose(mean, targets[same].mean(axis=0), rtol=1e-12, atol=1e-14)


@settings(deadline=None, derandomize=True)
@given(inputs=few_inputs, seed=st.integers(0, 99))
def test_squares_split_into_floor_and_error_of_the_means(inputs, seed):
    generator = np.random.default_rng(seed)
    targets = generator.normal(size=(len(inputs), 2))
    data = distinct_inputs(inputs, targets)
    answers = generator.normal(size=data.means.shape)  # any function of the input
    pooled = np.square(targets / data.target_units - answers[data.group]).mean(axis=0)
    of_means = data.counts @ np.square(data.means - answers) / len(inputs)
    np.testing.assert_allclose(pooled, data.within + of_means, rtol=1e-12)


def test_order_of_first_appearance():
    inputs = np.array([[5.0], [2.0], [5.0], [9.0], [2.0]])
    targets = np.arange(5.0)[:, np.newaxis]
    data = distinct_inputs(inputs, targets)
    appearing = data.by_first_appearance()
    np.testing.assert_array_equal(data.inputs * data.input_unit, [[2.0], [5.0], [9.0]])
    np.testing.assert_array_equal(appearing.inputs * appearing.input_unit, [[5.0], [2.0], [9.0]])
    np.testing.assert_array_equal(appearing.inputs[appearing.group] * data.input_unit, inputs)
    np.testing.assert_array_equal(appearing.counts, [2.0, 2.0, 1.0])
    np.testing.assert_array_equal(appearing.means * appearing.target_units, [[1.0], [2.5], [3.0]])


def test_units_are_powers_of_two_and_keep_every_digit():
    generator = np.random.default_rng(3)
    inputs, targets = (
        generator.normal(size=(20, 1)) * 1e-170,
        generator.normal(size=(20, 1)) * 1e180,
    )
    data = distinct_inputs(inputs, targets)
    for unit in (data.input_unit, data.target_units[0]):
        assert np.frexp(unit)[0] == 0.5
    np.testing.assert_array_equal(data.inputs[data.group] * data.input_unit, inputs)
    assert 0.1 < np.ptp(data.inputs) <= 1.0
    assert 0.1 < np.abs(data.means).max() <= 1.0


def test_constant_targets_stay_exactly_constant():
    data = distinct_inputs(np.zeros((3, 1)), np.full((3, 1), 0.1))
    assert data.means[0, 0] * data.target_units[0] == 0.1
    assert data.within[0] == 0.0


def test_floor_needs_repeated_inputs():
    inputs, targets = np.array([[0.0], [1.0]]), np.array([[1.0], [2.0]])
    assert distinct_inputs(inputs, targets).floor is None
    repeated = distinct_inputs(np.zeros((2, 1)), 8.0 * targets)
    assert repeated.floor is not None
    assert repeated.floor[0] == pytest.approx(16.0)


@pytest.mark.parametrize(("x", "y"), [(1e300, 1.0), (1.0, 1e300), (1.7e308, 1.0)])
def test_samples_beyond_float64_are_refused(x, y):
    with pytest.raises(ValueError, match="use another unit"):
        distinct_inputs(np.array([[-x], [x]]), np.array([[-y], [y]]))
