import numpy as np
import pytest
from scipy.integrate import solve_ivp

from studio.rbf import NotFittedError, PlainField, RBFRegressor, StableField
from tests.rbf.shapes import bent_reach


def test_it_is_the_papers_network_from_places_to_velocities():
    (times, rows), *_ = bent_reach(0)
    field = PlainField(20).fit([(times, rows)])
    velocities = np.gradient(rows, times, axis=0, edge_order=2)
    network = RBFRegressor(20, centers="grid", width="dmax", solver="svd").fit(rows, velocities)
    np.testing.assert_array_equal(field.velocity(rows), network.predict(rows))


def test_its_rollout_is_what_an_integrator_finds():
    demonstrations = bent_reach(1)
    field = PlainField(15).fit(demonstrations)
    start, times = demonstrations[0][1][0], np.linspace(0.0, 1.5, 31)
    solved = solve_ivp(
        lambda _, x: field.velocity(x), (0.0, 1.5), start, t_eval=times, rtol=1e-10, atol=1e-12
    )
    np.testing.assert_allclose(field.rollout(start, 0.05, 30), solved.y.T, atol=1e-3)
    several = field.rollout(np.stack([start, start + 0.1]), 0.05, 30)
    np.testing.assert_allclose(several[:, 0], field.rollout(start, 0.05, 30), atol=1e-12)


def test_students_see_it_fail_where_the_stable_field_arrives():
    missed = 0
    for seed in range(5):
        demonstrations = bent_reach(seed)
        starts = np.random.default_rng(seed).normal(scale=4.0, size=(20, 2))
        plain = PlainField(30).fit(demonstrations).rollout(starts, 0.05, 400)[-1]
        missed += int((np.linalg.norm(plain, axis=1) > 0.3).sum())
        stable = StableField([0.0, 0.0], 10, max_iterations=60).fit(demonstrations)
        assert np.linalg.norm(stable.rollout(starts, 0.5, 100)[-1], axis=1).max() < 1e-3
    assert missed > 50  # of 100


def test_faults_are_told_in_words():
    with pytest.raises(NotFittedError):
        PlainField().velocity([1.0])
    field = PlainField(3).fit([np.arange(8.0)[:, np.newaxis]], dt=1.0)
    with pytest.raises(ValueError, match=r"shape \(1,\) or \(n, 1\)"):
        field.velocity([1.0, 2.0])
    with pytest.raises(ValueError, match="n_neurons"):
        PlainField(0).fit([np.arange(8.0)[:, np.newaxis]], dt=1.0)
    with pytest.raises(ValueError, match="no setting"):
        field.set_params(width=2.0)
    assert field.get_params() == {"n_neurons": 3}
