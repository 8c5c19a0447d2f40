from itertools import islice

import numpy as np
import pytest

from studio.rbf.basis import gaussian_design, spread_to_width
from studio.rbf.leastsquares import orthogonalized
from studio.rbf.selection import deflated_picks, independent_picks, scores
from tests.rbf.naive import naive_picks

INDEX = np.arange(1.0, 143.0)[:, np.newaxis]


def curves(seed):
    generator = np.random.default_rng(seed)
    phases = generator.uniform(0.0, 6.0, size=3)
    return np.sin(INDEX / 15.0 + phases) + 0.1 * generator.normal(size=(142, 3))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("spread", [0.5, 1.0, 1.5])
def test_picks_are_those_of_a_naive_port(seed, spread):
    # Bar 2: on unique inputs, well conditioned (up to 1e5 here), both must pick alike to the end.
    design, targets = gaussian_design(INDEX, INDEX, spread_to_width(spread)), curves(seed)
    energies = np.square(targets).sum(axis=0)
    naive = naive_picks(design, targets, 60)
    assert list(islice(independent_picks(design, targets, energies), 60)) == naive
    once_each = np.ones(142)
    assert list(islice(deflated_picks(design, targets, energies, once_each), 60)) == naive


def test_all_independent_candidates_are_picked_once():
    design, targets = gaussian_design(INDEX, INDEX, spread_to_width(1.0)), curves(0)
    picks = list(independent_picks(design, targets, np.square(targets).sum(axis=0)))
    assert sorted(picks) == list(range(142))


def test_dependent_candidates_are_never_picked():
    design, targets = gaussian_design(INDEX, INDEX, 20.0), curves(1)
    picks = list(independent_picks(design, targets, np.square(targets).sum(axis=0)))
    assert 5 < len(picks) < 40
    chosen = design[:, picks] / np.linalg.norm(design[:, picks], axis=0)
    basis = np.linalg.qr(chosen[:, :-1])[0]
    assert np.linalg.norm(orthogonalized(chosen[:, -1:], basis)) > 1e-10  # the last still added
    assert np.linalg.svd(chosen, compute_uv=False)[-1] > 1e-14


def test_the_first_among_equals_wins():
    design, targets = np.eye(3), np.ones((3, 1))
    assert next(independent_picks(design, targets, np.array([3.0]))) == 0
    assert next(deflated_picks(design, targets, np.array([3.0]), np.ones(3))) == 0


def test_deflated_duplicates_stay_in_the_race_until_used_up():
    inputs, targets = INDEX[:10], curves(2)[:10]
    design = np.repeat(gaussian_design(inputs, inputs, 1.0), 3, axis=0)
    rows = np.repeat(targets, 3, axis=0)
    energies, copies = np.square(rows).sum(axis=0), np.full(10, 3.0)
    picks = list(deflated_picks(design, rows, energies, copies))
    assert len(picks) == 30
    assert sorted(picks) == sorted(list(range(10)) * 3)
    np.testing.assert_array_equal(copies, 3.0)  # the caller's own are left alone


def test_empty_columns_and_outputs_score_nothing():
    np.testing.assert_array_equal(
        scores(np.array([0.0, 4.0]), np.array([[0.0, 0.0], [2.0, 0.0]]), np.array([1.0, 0.0])),
        [0.0, 1.0],
    )
