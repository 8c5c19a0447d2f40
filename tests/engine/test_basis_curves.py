"""The Gaussians add up to the network's own answer."""

import numpy as np
import pytest

from studio.engine.basis_curves import MOST_DRAWN, basis_of
from studio.engine.teaching import LearnerSettings, learn
from tests.engine.sweeps import samples


@pytest.mark.parametrize("settings", [("rbf", 7), ("newrb", 12), ("rbf", 1)])
def test_the_parts_add_up_to_what_the_network_answers(settings: tuple) -> None:
    lesson = learn(samples(2), LearnerSettings(*settings))
    for column in range(4):
        basis = basis_of(lesson, column)
        answer = np.degrees(lesson.model.predict(basis.stamps))[:, column]
        np.testing.assert_allclose(basis.total + basis.bias, answer, atol=1e-9)
        every = sum(np.interp(basis.stamps, *part, left=0.0, right=0.0) for part in basis.parts)
        rough = 0.02 * max(np.abs(part[1]).max() for part in basis.parts)  # drawn with 25 points
        np.testing.assert_allclose(every, basis.total, atol=len(basis.parts) * rough)


def test_of_many_the_largest_are_drawn_in_order_of_time() -> None:
    lesson = learn(samples(2), LearnerSettings("rbf", 150))
    basis = basis_of(lesson, 0)
    assert (basis.neurons, len(basis.parts)) == (150, MOST_DRAWN)
    heights = np.sort(np.abs(np.degrees(lesson.model.weights_[:, 0])))[-MOST_DRAWN:]
    drawn = np.sort([np.abs(angles).max() for _, angles in basis.parts])
    assert drawn[-1] == pytest.approx(heights[-1], rel=0.05)
    middles = [stamps.mean() for stamps, _ in basis.parts]
    assert middles == sorted(middles)


def test_every_part_stays_within_the_motion() -> None:
    basis = basis_of(learn(samples(2), LearnerSettings("rbf", 9)), 1)
    for stamps, angles in basis.parts:
        assert stamps.min() >= 1.0
        assert stamps.max() <= 142.0
        assert (np.diff(stamps) > 0.0).all()
        assert np.isfinite(angles).all()


def test_a_field_has_no_gaussians_over_time() -> None:
    assert basis_of(learn(samples(2), LearnerSettings("plain-field", 5)), 0) is None
