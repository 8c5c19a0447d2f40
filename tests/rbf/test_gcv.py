import numpy as np
import pytest

from studio.rbf.aggregation import distinct_inputs
from studio.rbf.basis import gaussian_design
from studio.rbf.gcv import choose, gcv_scores, mean_target, width_candidates
from studio.rbf.linear import effective_dof, ridge_weights, truncated_svd

INDEX = np.arange(1.0, 143.0)[:, np.newaxis]


def test_scores_are_the_formula_written_out():
    generator = np.random.default_rng(0)
    root = np.sqrt(generator.integers(1, 4, size=40).astype(float))
    inputs, centers = np.linspace(0, 1, 40)[:, np.newaxis], np.linspace(0, 1, 9)[:, np.newaxis]
    means = np.sin(5.0 * inputs + np.arange(2.0)) + 0.1 * generator.normal(size=(40, 2))
    targets = root[:, np.newaxis] * (means - root**2 @ means / np.sum(root**2))
    design = root[:, np.newaxis] * gaussian_design(inputs, centers, 0.15)
    svd, ridges = truncated_svd(design, 1e-12), np.array([0.0, 1e-4, 1.0])
    for ridge, score in zip(ridges, gcv_scores(svd, targets, root, ridges), strict=True):
        residual = targets - design @ ridge_weights(svd, targets, ridge)
        relative = (np.square(residual).sum(axis=0) / np.square(targets).sum(axis=0)).sum()
        expected = 40 * relative / (40 - effective_dof(svd, root, ridge)) ** 2
        assert score == pytest.approx(expected, rel=1e-9)


def test_without_freedom_to_judge_by_the_score_is_infinite():
    svd = truncated_svd(np.eye(3), 1e-10)
    score = gcv_scores(svd, np.array([[1.0], [-2.0], [1.0]]), np.ones(3), np.zeros(1))
    assert score[0] == np.inf


def test_the_score_nears_its_limit_where_the_ridge_vanishes():
    # A saturated design: residual and freedom both go to zero with the ridge, their ratio does not.
    for seed in range(20):
        generator = np.random.default_rng(seed)
        design, targets = generator.normal(size=(6, 6)), generator.normal(size=(6, 1))
        targets -= targets.mean()
        svd = truncated_svd(design, 0.0)
        ridges = svd.singular[-1] ** 2 * np.array([1e-8, 1e-13])
        scores = gcv_scores(svd, targets, np.ones(6), ridges)
        assert scores[0] == pytest.approx(scores[1], rel=1e-6)


def test_repeating_all_demonstrations_changes_no_choice(demonstrations, pool):
    index, rows = pool(demonstrations(0))
    centers = INDEX[::3]
    once = distinct_inputs(index[:, np.newaxis], rows)
    thrice = distinct_inputs(np.tile(index, 3)[:, np.newaxis], np.tile(rows, (3, 1)))
    widths = width_candidates(centers / once.input_unit, once.inputs)
    first = choose(once, centers / once.input_unit, widths, None, 1e-10)
    second = choose(thrice, centers / once.input_unit, widths, None, 1e-10)
    assert first.width == second.width
    assert second.ridge == pytest.approx(3.0 * first.ridge, rel=1e-6)
    assert second.score == pytest.approx(first.score, rel=1e-6)


def test_noise_asks_for_a_smoother_curve():
    generator = np.random.default_rng(2)
    curve = np.sin(INDEX / 12.0)
    noisy = curve + 0.2 * generator.normal(size=curve.shape)

    def freedom(targets):
        data = distinct_inputs(INDEX, targets)
        choice = choose(data, data.inputs, width_candidates(data.inputs, data.inputs), None, 1e-10)
        return effective_dof(choice.svd, data.root_counts, choice.ridge)

    assert freedom(noisy) < 0.3 * len(INDEX)
    assert freedom(noisy) < freedom(curve) + 10.0


def test_a_better_width_is_found_than_either_end():
    data = distinct_inputs(INDEX, np.sin(INDEX / 5.0))
    centers = data.inputs[::4]
    widths = width_candidates(centers, data.inputs)
    best = choose(data, centers, widths, None, 1e-10)
    ends = [choose(data, centers, [end], None, 1e-10).score for end in (widths[0], widths[-1])]
    assert best.score < min(ends)


def test_width_candidates_span_spacing_to_extent():
    widths = width_candidates(INDEX[::3], INDEX)
    assert widths[0] == pytest.approx(1.4 * 3.0)
    assert widths[-1] == pytest.approx(141.0)
    np.testing.assert_array_equal(width_candidates(INDEX[:1], INDEX[:1]), [1.0])


def test_mean_target_weighs_repeats():
    data = distinct_inputs(np.array([[0.0], [0.0], [1.0]]), np.array([[1.0], [2.0], [6.0]]))
    assert mean_target(data)[0] * data.target_units[0] == pytest.approx(3.0)
