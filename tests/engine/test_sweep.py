import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.sweep import sweep
from studio.rbf import RBFRegressor, leave_one_demonstration_out, smoothness
from tests.engine.sweeps import Ticking, samples


@pytest.fixture(scope="module")
def table():
    return sweep(samples(), Ticking(), ("newrb", "rbf"), (20, 5))


def test_every_learner_meets_every_count(table):
    met = [(row.learner, row.neurons) for row in table.rows]
    assert met == [("newrb", 5), ("newrb", 20), ("rbf", 5), ("rbf", 20)]
    assert table.learners == ("newrb", "rbf")


def test_the_numbers_are_those_of_the_network_alone(table):
    """Two roads: the table's row, and the network fitted and judged here."""
    rows = table.taught.rows
    settings = RBFRegressor(20, width="dmax", solver="svd")
    time = np.arange(1.0, 143.0)
    model = RBFRegressor(20, width="dmax", solver="svd").fit(np.tile(time, 4), rows.reshape(-1, 4))
    quality = table.of("rbf")[1].quality
    np.testing.assert_allclose(quality.curve, model.predict(time), atol=1e-12)
    errors = rows - model.predict(time)
    np.testing.assert_allclose(quality.mse, np.square(errors).mean(axis=(0, 1)))
    np.testing.assert_allclose(quality.largest, np.abs(errors).max(axis=(0, 1)))
    assert quality.floor_ratio == pytest.approx(quality.mse.mean() / table.floor.mean())
    held_out = leave_one_demonstration_out(settings, rows)
    assert quality.held_out == pytest.approx(held_out.mse.mean())
    assert quality.held_out_ratio == pytest.approx(held_out.ratio)
    assert quality.acceleration_ratio == pytest.approx(smoothness(model.predict, rows).ratio)
    assert quality.fit_seconds == quality.predict_seconds == 1.0  # of the false clock


def test_the_suggested_network_is_played(table):
    assert table.suggestions["rbf"].neurons == 20
    assert table.shown_row("rbf").neurons == 20
    assert table.played["rbf"].performance.block_down
    assert table.played["rbf"].deviation.hand_mean < 0.02


def test_a_single_demonstration_has_no_floor_and_nothing_to_leave_out():
    table = sweep(samples(1), Ticking(), ("rbf",), (5, 10))
    assert table.floor is None
    assert "single" in table.floor_note
    assert table.suggestions == {}
    assert table.rows[0].quality.held_out is None
    assert table.rows[0].quality.floor_ratio is None
    assert table.shown_row("rbf").neurons == 10  # the most


@pytest.mark.parametrize(
    ("learners", "neurons", "words"),
    [
        (("magic",), (5,), "unknown learner 'magic'"),
        (("spline",), (5,), "spline has no neurons to sweep over"),
        (("rbf",), (0,), "neurons: 1 to 1000, not 0"),
        (("rbf",), (), "at least one number"),
    ],
)
def test_what_cannot_be_swept_is_refused_in_words(learners, neurons, words):
    with pytest.raises(StudioError, match=words):
        sweep(samples(), Ticking(), learners, neurons)
