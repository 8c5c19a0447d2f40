import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.rbf.basis import (
    extent,
    gaussian_design,
    largest_distance_width,
    mean_nearest_distance,
    nearest_center_width,
    network_output,
    spread_to_width,
)


def test_gaussian_is_equation_9_as_we_read_it():
    generator = np.random.default_rng(0)
    inputs, centers, width = generator.normal(size=(7, 3)), generator.normal(size=(4, 3)), 0.7
    design = gaussian_design(inputs, centers, width)
    for row, x in enumerate(inputs):
        for column, c in enumerate(centers):
            expected = math.exp(-(math.dist(x, c) ** 2) / (2.0 * width**2))
            assert design[row, column] == pytest.approx(expected, rel=1e-13)


@settings(deadline=None, derandomize=True)
@given(shift=st.floats(-1e6, 1e6), stretch=st.floats(1e-6, 1e6), seed=st.integers(0, 99))
def test_gaussian_is_the_same_in_every_unit(shift, stretch, seed):
    generator = np.random.default_rng(seed)
    inputs, centers = generator.uniform(size=(9, 2)), generator.uniform(size=(5, 2))
    width = generator.uniform(0.1, 2.0)
    moved = gaussian_design(
        stretch * (inputs + shift), stretch * (centers + shift), stretch * width
    )
    np.testing.assert_allclose(moved, gaussian_design(inputs, centers, width), atol=1e-7)


@pytest.mark.parametrize("unit", [2.0**-900, 2.0**900])
def test_gaussian_neither_overflows_nor_vanishes(unit):
    inputs, centers = np.array([[0.0], [1.0]]), np.array([[0.0], [2.0]])
    np.testing.assert_array_equal(
        gaussian_design(inputs * unit, centers * unit, unit), gaussian_design(inputs, centers, 1.0)
    )


def test_network_output_sums_equation_6():
    inputs, centers = np.array([[0.0], [1.0], [5.0]]), np.array([[0.5], [2.0]])
    weights, bias = np.array([[1.0, -1.0], [2.0, 0.5]]), np.array([10.0, 20.0])
    design = gaussian_design(inputs, centers, 1.5)
    expected = [
        [b + sum(row[j] * weights[j, s] for j in range(2)) for s, b in enumerate(bias)]
        for row in design
    ]
    np.testing.assert_allclose(network_output(inputs, centers, 1.5, weights, bias), expected)


@pytest.mark.parametrize("spread", [0.25, 1.0, 30.0])
def test_a_neuron_answers_one_half_at_its_spread(spread):
    answer = gaussian_design(np.array([[spread]]), np.array([[0.0]]), spread_to_width(spread))
    assert answer[0, 0] == pytest.approx(0.5, rel=1e-14)


def test_largest_distance_width_is_equation_13():
    centers = np.array([[0.0, 0.0], [3.0, 4.0], [1.0, 1.0]])
    assert largest_distance_width(centers, centers) == pytest.approx(5.0 / math.sqrt(6.0))


def test_widths_fall_back_where_centers_coincide():
    one, inputs = np.array([[1.0]]), np.array([[0.0], [8.0]])
    assert largest_distance_width(one, inputs) == pytest.approx(8.0 / math.sqrt(2.0))
    assert nearest_center_width(one, inputs) == largest_distance_width(one, inputs)
    assert largest_distance_width(one, one) == pytest.approx(1.0 / math.sqrt(2.0))


def test_nearest_distance_in_one_and_two_dimensions_agree():
    line = np.array([0.0, 1.0, 1.0, 4.0, 4.5])
    embedded = np.column_stack([line, np.full_like(line, 3.0)])
    assert mean_nearest_distance(line[:, np.newaxis]) == pytest.approx((1 + 1 + 0.5 + 0.5) / 4)
    assert mean_nearest_distance(embedded) == pytest.approx((1 + 1 + 0.5 + 0.5) / 4)
    assert nearest_center_width(embedded, embedded) == mean_nearest_distance(embedded)


def test_extent_is_the_diagonal_of_the_box():
    assert extent(np.array([[0.0, 0.0], [3.0, 1.0], [1.0, 4.0]])) == pytest.approx(5.0)
    assert extent(np.array([[2.0]])) == 0.0
