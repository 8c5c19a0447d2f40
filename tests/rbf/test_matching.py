import numpy as np
import pytest

from studio.rbf.diffeomorphism import STEEPEST, Diffeomorphism
from studio.rbf.lessons import lesson_from
from studio.rbf.matching import LONGEST_TRIED, grow, match
from studio.rbf.refinement import Objective
from studio.rbf.trajectories import read_demonstrations
from tests.rbf.shapes import bent_reach


def lesson(seed, dimension=2):
    return lesson_from(read_demonstrations(bent_reach(seed, dimension=dimension), None), None)


@pytest.mark.parametrize("dimension", [1, 2, 4])
def test_the_gradient_is_what_differences_say(dimension):
    taught = lesson(0, dimension)
    objective = Objective(taught, 4, 0.8, 1e-3)
    generator = np.random.default_rng(0)
    numbers = objective.packed(grow(taught, 4, 0.7), taught.starts)
    numbers = numbers + 0.1 * generator.normal(size=numbers.shape)
    _, gradient = objective(numbers)
    for direction in generator.normal(size=(20, numbers.size)):
        step = 1e-6 * direction
        slope = (objective(numbers + step)[0] - objective(numbers - step)[0]) / 2e-6
        assert slope == pytest.approx(gradient @ direction, rel=1e-5, abs=1e-9)


def test_packing_a_chain_and_unpacking_it_gives_it_back():
    taught = lesson(1)
    chain = grow(taught, 6, 0.7)
    objective = Objective(taught, 6, 0.8, 1e-3)
    again, starts = objective.unpacked(objective.packed(chain, taught.starts))
    np.testing.assert_allclose(again.shifts, chain.shifts, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(again.widths, chain.widths, rtol=1e-12)
    np.testing.assert_array_equal(again.centers, chain.centers)
    np.testing.assert_array_equal(starts, taught.starts)


@pytest.mark.parametrize("bound", [0.2, 0.8, 0.99])
def test_no_translation_gets_steeper_than_the_bound(bound):
    found = match(lesson(2), 8, bound, 0.0, 100)
    assert found.chain.steepness.max() <= bound


def test_refinement_and_more_translations_bring_the_paths_closer():
    taught = lesson(3)
    coarse, fine = (match(taught, count, 0.8, 3e-5, 200).error for count in (2, 12))
    chain = grow(taught, 12, 0.8)
    lines = taught.remaining[:, np.newaxis] * taught.starts[:, np.newaxis]
    bent = chain.forward(lines.reshape(-1, 2)).reshape(taught.paths.shape)
    untouched = np.sqrt(np.square(bent - taught.paths).sum(axis=2).mean())
    assert fine < 0.5 * coarse
    assert fine < 0.8 * untouched  # what is left is how the paths differ


@pytest.mark.parametrize(("more", "iterations"), [(15, 40), (170, 90), (270, 60)])
def test_a_chain_longer_than_those_tried_is_no_worse_than_they_are(more, iterations):
    taught = lesson(2)
    tried = match(taught, LONGEST_TRIED, 0.8, 3e-5, iterations)
    longer = match(taught, LONGEST_TRIED + more, 0.8, 3e-5, iterations)
    assert len(longer.chain.widths) == LONGEST_TRIED + more
    assert longer.chain.steepness.max() <= 0.8
    assert longer.error <= 1.02 * tried.error


def test_a_shift_as_steep_as_the_bound_can_be_packed():
    taught, bound = lesson(1), 0.8
    objective = Objective(taught, 1, bound, 0.0)
    steepest = Diffeomorphism(np.zeros((1, 2)), np.array([[bound / STEEPEST, 0.0]]), np.ones(1))
    again, _ = objective.unpacked(objective.packed(steepest, taught.starts))
    np.testing.assert_allclose(again.shifts, steepest.shifts, rtol=1e-9)
