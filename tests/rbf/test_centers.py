import numpy as np
import pytest
from scipy.spatial.distance import cdist

from studio.rbf.aggregation import distinct_inputs
from studio.rbf.basis import gaussian_design
from studio.rbf.centers import (
    greedy_centers,
    grid_centers,
    kmeans_centers,
    place_centers,
    random_centers,
)
from tests.rbf.naive import naive_picks


def data_of(inputs):
    inputs = np.asarray(inputs, dtype=float)
    return distinct_inputs(inputs, np.zeros((len(inputs), 1)))


def test_grid_divides_even_stamps_evenly():
    stamps = np.arange(1.0, 143.0)[:, np.newaxis]
    np.testing.assert_allclose(grid_centers(stamps, 48)[:, 0], np.linspace(1.0, 142.0, 48))
    np.testing.assert_array_equal(grid_centers(stamps, 142), stamps)
    assert grid_centers(stamps, 1)[0, 0] == 71.5


def test_grid_follows_uneven_stamps():
    stamps = np.array([[9.0], [0.0], [1.0], [2.0], [3.0]])
    np.testing.assert_allclose(grid_centers(stamps, 3)[:, 0], [0.0, 2.0, 9.0])


def test_grid_in_the_plane_spreads_over_the_samples():
    generator = np.random.default_rng(0)
    inputs = generator.uniform(size=(200, 2))
    centers = grid_centers(inputs, 12)
    assert len(np.unique(centers, axis=0)) == 12
    assert cdist(inputs, centers).min(axis=1).max() < 0.3  # no sample is far from all of them
    assert cdist(centers, inputs).min(axis=1).max() == 0.0  # and each is one
    apart = cdist(centers, centers) + 9.0 * np.eye(12)
    assert apart.min() > 0.15


@pytest.mark.parametrize("rule", ["grid", "kmeans", "random"])
@pytest.mark.parametrize("features", [1, 2])
def test_more_centers_than_distinct_inputs(rule, features):
    data = data_of(np.repeat(np.random.default_rng(1).normal(size=(5, features)), 3, axis=0))
    centers = place_centers(rule, data, 13, 0)
    assert centers.shape == (13, features)
    assert np.isfinite(centers).all()
    inside = (centers >= data.inputs.min(axis=0)) & (centers <= data.inputs.max(axis=0))
    assert inside.all()


def test_greedy_centers_are_those_of_a_naive_search_over_all_samples():
    generator = np.random.default_rng(5)
    inputs = np.repeat(np.arange(30.0), generator.integers(1, 5, size=30))[:, np.newaxis]
    targets = np.sin(inputs / 4.0 + np.arange(2.0)) + 0.1 * generator.normal(size=(len(inputs), 2))
    data = distinct_inputs(inputs, targets)
    scaled, width = inputs / data.input_unit, 1.5 / data.input_unit
    design = gaussian_design(scaled, data.inputs, width)
    centered = targets - targets.mean(axis=0)
    naive = naive_picks(design, centered, 20)
    np.testing.assert_array_equal(greedy_centers(data, 20, width), data.inputs[naive])


def test_greedy_centers_end_where_wide_gaussians_have_no_more_to_add():
    inputs = np.arange(50.0)[:, np.newaxis]
    data = distinct_inputs(inputs, np.sin(inputs / 9.0))
    found = greedy_centers(data, 50, 20.0 / data.input_unit)
    assert 3 < len(found) < 25
    assert len(np.unique(found)) == len(found)


def test_random_centers_are_distinct_inputs_while_they_last():
    inputs = np.arange(10.0)[:, np.newaxis]
    drawn = random_centers(inputs, 10, np.random.default_rng(0))
    np.testing.assert_array_equal(np.sort(drawn, axis=0), inputs)
    again = random_centers(inputs, 25, np.random.default_rng(0))[:, 0]
    assert set(np.unique(again, return_counts=True)[1]) == {2, 3}


@pytest.mark.parametrize("rule", ["kmeans", "random"])
def test_the_seed_decides(rule):
    data = data_of(np.random.default_rng(2).normal(size=(60, 1)))
    first, same, other = (place_centers(rule, data, 10, seed) for seed in (5, 5, 6))
    np.testing.assert_array_equal(first, same)
    assert not np.array_equal(first, other)


def test_kmeans_finds_separate_clusters_and_weighs_repeats():
    clusters = np.array([[0.0], [0.2], [0.2], [0.2], [10.0], [10.4], [20.0]])
    centers = kmeans_centers(data_of(clusters), 3, np.random.default_rng(0))
    scaled = np.sort(centers[:, 0]) * data_of(clusters).input_unit
    np.testing.assert_allclose(scaled, [0.15, 10.2, 20.0])


def test_kmeans_settles_where_no_center_wants_to_move():
    data = data_of(np.random.default_rng(4).normal(size=(80, 2)))
    centers = kmeans_centers(data, 7, np.random.default_rng(1))
    nearest = cdist(data.inputs, centers).argmin(axis=1)
    for place, center in enumerate(centers):
        np.testing.assert_allclose(data.inputs[nearest == place].mean(axis=0), center, atol=1e-12)


def test_own_centers_are_taken_in_the_unit_of_the_inputs():
    data = data_of([[0.0], [100.0]])
    placed = place_centers([10.0, 30.0], data, 99, None)
    np.testing.assert_array_equal(placed * data.input_unit, [[10.0], [30.0]])


@pytest.mark.parametrize(
    ("rule", "words"),
    [
        ("ring", "centers is one of 'grid', 'kmeans', 'random', 'ols' or an"),
        ([[1.0, 2.0]], "2 features, but X has 1"),
        ([np.nan], "given centers cannot be used: X must be finite"),
        ([], "given centers cannot be used: found 0 samples"),
    ],
)
def test_centers_that_cannot_be_used_are_refused_in_words(rule, words):
    with pytest.raises(ValueError, match=words):
        place_centers(rule, data_of([[0.0], [1.0]]), 3, None)
