import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.rbf.diffeomorphism import STEEPEST, Diffeomorphism


def chain_of(seed, links, dimension, steepest):
    generator = np.random.default_rng(seed)
    widths = 10.0 ** generator.uniform(-1.5, 1.0, links)
    directions = generator.normal(size=(links, dimension))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    lengths = generator.uniform(0.0, steepest, links) * widths / STEEPEST
    return Diffeomorphism(
        generator.normal(size=(links, dimension)), lengths[:, np.newaxis] * directions, widths
    )


CHAINS = {
    "seed": st.integers(0, 10_000),
    "links": st.integers(1, 20),
    "dimension": st.integers(1, 7),
}


@settings(deadline=None, derandomize=True, max_examples=60)
@given(**CHAINS, steepest=st.sampled_from([0.3, 0.8, 0.95]))
def test_the_inverse_undoes_the_map_both_ways(seed, links, dimension, steepest):
    chain = chain_of(seed, links, dimension, steepest)
    points = np.random.default_rng(seed + 1).normal(scale=2.0, size=(40, dimension))
    # A step back may amplify rounding by 1 / (1 - steepness), and steps multiply.
    allowed = 1e-13 * np.prod(1.0 / (1.0 - chain.steepness))
    np.testing.assert_allclose(chain.inverse(chain.forward(points)), points, atol=allowed)
    np.testing.assert_allclose(chain.forward(chain.inverse(points)), points, atol=1e-12 + allowed)


@settings(deadline=None, derandomize=True, max_examples=40)
@given(**CHAINS)
def test_vectors_are_pushed_as_differences_say(seed, links, dimension):
    chain = chain_of(seed, links, dimension, 0.9)
    generator = np.random.default_rng(seed + 1)
    points, vectors = generator.normal(size=(2, 10, dimension))
    step = 1e-6 * chain.widths.min()
    ahead, behind = chain.forward(points + step * vectors), chain.forward(points - step * vectors)
    moved, pushed = chain.push_forward(points, vectors)
    np.testing.assert_array_equal(moved, chain.forward(points))
    np.testing.assert_allclose(pushed, (ahead - behind) / (2.0 * step), rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("dimension", [1, 2, 5])
def test_the_steepness_is_the_slope_that_space_has_at_most(dimension):
    """Along the shift, one width from the center: there the Gaussian falls fastest."""
    shift = np.zeros((1, dimension))
    shift[0, 0] = 0.9 / STEEPEST
    chain = Diffeomorphism(np.zeros((1, dimension)), shift, np.ones(1))
    along = np.zeros((2001, dimension))
    along[:, 0] = np.linspace(-4.0, 4.0, 2001)
    moved = chain.forward(along)[:, 0]
    slopes = np.diff(moved) / np.diff(along[:, 0])
    assert slopes.min() == pytest.approx(1.0 - chain.steepness[0], abs=1e-3)
    assert slopes.max() == pytest.approx(1.0 + chain.steepness[0], abs=1e-3)


@pytest.mark.parametrize(
    ("centers", "shifts", "widths", "words"),
    [
        ([[0.0]], [[1.0 / STEEPEST]], [1.0], "translation 0 has steepness 1"),
        ([[0.0], [0.0]], [[0.0], [5.0]], [1.0, 1.0], "translation 1 has steepness"),
        ([[0.0]], [[0.1]], [0.0], "widths must be finite and positive"),
        ([[0.0]], [[np.nan]], [1.0], "must be finite"),
        ([[0.0]], [[0.1, 0.1]], [1.0], r"shape \(m, d\)"),
        ([0.0], [0.1], [1.0], r"shape \(m, d\)"),
    ],
)
def test_a_map_that_may_fold_is_refused(centers, shifts, widths, words):
    with pytest.raises(ValueError, match=words):
        Diffeomorphism(np.array(centers), np.array(shifts), np.array(widths))
