import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.rbf.basis import gaussian_design
from studio.rbf.linear import (
    bias_shares,
    effective_dof,
    removed_shares,
    ridge_weights,
    truncated_svd,
)


def ill_conditioned(neurons=40, width=25.0):
    stamps = np.arange(1.0, 143.0)[:, np.newaxis]
    return gaussian_design(stamps, np.linspace(1.0, 142.0, neurons)[:, np.newaxis], width)


def test_truncated_pseudo_inverse_is_numpys():
    design = ill_conditioned()
    targets = np.random.default_rng(0).normal(size=(142, 3))
    svd = truncated_svd(design, 1e-8)
    expected = np.linalg.pinv(design, rcond=1e-8) @ targets
    np.testing.assert_allclose(design @ ridge_weights(svd, targets, 0.0), design @ expected,
                               atol=1e-7)  # fmt: skip
    assert 1 < svd.rank < 40
    assert svd.condition > 1e16


@settings(deadline=None, derandomize=True, max_examples=30)
@given(ridge=st.floats(1e-6, 1e3), seed=st.integers(0, 50))
def test_ridge_is_least_squares_with_the_penalty_as_more_rows(ridge, seed):
    generator = np.random.default_rng(seed)
    design, targets = generator.normal(size=(12, 5)), generator.normal(size=(12, 2))
    found = ridge_weights(truncated_svd(design, 1e-12), targets, ridge)
    stacked = np.vstack([design, math.sqrt(ridge) * np.eye(5)])
    padded = np.vstack([targets, np.zeros((5, 2))])
    np.testing.assert_allclose(found, np.linalg.lstsq(stacked, padded)[0], rtol=1e-7, atol=1e-9)


def test_what_a_ridge_removes_keeps_its_digits():
    svd = truncated_svd(np.diag([1.0, 1e-3]), 1e-10)
    removed = removed_shares(svd, np.array([0.0, 1e-20, 1.0]))
    np.testing.assert_allclose(removed, [[0, 0], [1e-20, 1e-14], [0.5, 1 / (1 + 1e-6)]], rtol=1e-9)


@pytest.mark.parametrize("ridge", [0.0, 1e-6, 0.1])
def test_effective_dof_is_the_trace_of_the_hat_matrix(ridge):
    generator = np.random.default_rng(7)
    counts = generator.integers(1, 5, size=30).astype(float)
    root = np.sqrt(counts)
    inputs, centers = np.linspace(0, 1, 30)[:, np.newaxis], np.linspace(0, 1, 8)[:, np.newaxis]
    plain = gaussian_design(inputs, centers, 0.1)
    svd = truncated_svd(root[:, np.newaxis] * plain, 1e-10)
    hat = np.empty((30, 30))
    for column, target in enumerate(np.eye(30)):  # one input's target at a time
        mean = counts @ target / counts.sum()
        weights = ridge_weights(svd, (root * (target - mean))[:, np.newaxis], ridge)
        hat[:, column] = mean + (plain @ weights)[:, 0]
    assert effective_dof(svd, root, ridge) == pytest.approx(np.trace(hat), rel=1e-9)


def test_bias_shares_sum_to_how_much_of_the_bias_the_design_spans():
    svd = truncated_svd(np.ones((4, 1)), 1e-10)
    assert bias_shares(svd, np.ones(4)).sum() == pytest.approx(1.0)


def test_gaussians_that_no_sample_sees_are_left_out():
    svd = truncated_svd(np.full((3, 2), 1e-30), 1e-10)
    assert svd.rank == 0
    np.testing.assert_array_equal(ridge_weights(svd, np.ones((3, 1)), 0.0), np.zeros((2, 1)))
    assert truncated_svd(np.zeros((3, 2)), 1e-10).condition == math.inf
