import numpy as np
import pytest

from studio.rbf.pace import LARGEST_FACTOR, learn_pace


def radial(rate, count=60):
    points = np.linspace(0.05, 1.0, count)[:, np.newaxis]
    return learn_pace(points, np.full(count, rate), 8)


@pytest.mark.parametrize("dt", [0.01, 0.5, 3.0])
def test_a_constant_rate_gives_an_exponential_at_any_step(dt):
    pace = radial(2.0)
    path = np.stack(list(pace.descend(np.array([[1.0]]), dt, 20)))[:, 0, 0]
    np.testing.assert_allclose(np.log(path), -2.0 * dt * np.arange(21), rtol=1e-6, atol=1e-9)


def test_halving_the_step_changes_next_to_nothing():
    generator = np.random.default_rng(0)
    points = generator.normal(size=(80, 3))
    pace = learn_pace(points, 1.0 + 0.5 * np.sin(points[:, 0]), 10)
    starts = generator.normal(size=(5, 3))
    *_, coarse = pace.descend(starts, 0.1, 10)
    *_, fine = pace.descend(starts, 0.05, 20)
    np.testing.assert_allclose(coarse, fine, atol=1e-4)


def test_a_path_is_walked_at_the_rates_that_are_told_for_its_places():
    """Two roads to one step: the rates that `descend` asks for itself are those of `rates`."""
    generator = np.random.default_rng(2)
    points = generator.normal(size=(60, 2))
    pace = learn_pace(points, np.exp(generator.normal(size=60)), 12)
    start = generator.normal(size=(7, 2))
    asked = pace._asked_often()
    for scale in (1e-200, 1e-3, 1.0, 1e3, 1e150):
        assert asked(scale * start).tobytes() == pace.rates(scale * start).tobytes()
    *_, after = pace.descend(start, 1e-6, 1)
    np.testing.assert_allclose(
        -np.log(after / start).mean(axis=1) / 1e-6, pace.rates(start), rtol=1e-4
    )


def test_what_is_no_number_is_refused():
    with pytest.raises(ValueError, match="must be finite"):
        next(radial(1.0).descend(np.array([[np.inf]]), 0.1, 1))


def test_rates_stay_between_their_bounds_everywhere():
    generator = np.random.default_rng(1)
    points = generator.normal(size=(50, 2))
    pace = learn_pace(points, np.exp(4.0 * generator.normal(size=50)), 20)
    assert pace.fastest / pace.slowest == pytest.approx(LARGEST_FACTOR**2)
    rates = pace.rates(generator.normal(scale=20.0, size=(5000, 2)))
    assert rates.min() >= pace.slowest > 0.0
    assert rates.max() <= pace.fastest


def test_the_distance_falls_in_every_step_however_long():
    pace = radial(3.0)
    path = np.stack(list(pace.descend(np.array([[40.0], [1e-3]]), 10.0, 5)))
    assert (np.diff(np.abs(path), axis=0) < 0.0).all()
