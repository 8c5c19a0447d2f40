"""The SEDS that our field is compared with is no straw man: what its publication says holds."""

from functools import lru_cache, partial

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import minimize
from scipy.stats import multivariate_normal
from sklearn.mixture import GaussianMixture

from tests.bench import seds
from tests.bench.seds_mixture import (
    MARGIN,
    Coordinates,
    Mixture,
    negative_log_likelihood,
    squared_error,
)

SYSTEM = np.array([[-1.0, 2.0], [-1.5, -0.8]])  # stable, and it turns


def motions(system, starts, duration=4.0, count=80):
    """Demonstrations of x' = A x, exactly: times and positions."""
    times = np.linspace(0.0, duration, count)
    values, vectors = np.linalg.eig(system)
    modes = np.linalg.solve(vectors, np.asarray(starts, dtype=complex).T)
    paths = np.einsum("ij,tj,jk->kti", vectors, np.exp(times[:, None] * values), modes)
    return [(times, path.real) for path in paths]


def hooks():
    """Three bent ways to the origin, always nearer."""
    left = 1.0 - np.linspace(0.0, 1.0, 60) ** 1.5
    angles = (0.0, 0.15, -0.1)
    bend = 1.2 * np.sin(2.0 * left)
    return [
        (np.linspace(0.0, 2.0, 60), 40.0 * left[:, None] * np.column_stack([np.cos(a), np.sin(a)]))
        for a in (bend + angle for angle in angles)
    ]


@lru_cache
def learned(components=3):
    return seds.learn(hooks(), components, seeds=[0], max_iterations=300)


def random_mixture(seed, components=3, dimension=2):
    generator = np.random.default_rng(seed)
    coordinates = Coordinates(components, dimension)
    return coordinates, generator.normal(0.0, 0.5, coordinates.free + 1), generator


@pytest.mark.parametrize("objective", [negative_log_likelihood, squared_error])
@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_gradients_are_those_of_finite_differences(objective, dimension):
    coordinates, point, generator = random_mixture(dimension, dimension=dimension)
    x, v = generator.normal(size=(2, 30, dimension))
    found = coordinates.pulled_back(point, objective(coordinates.mixture(point), x, v)[1])
    for k, expected in enumerate(found):
        step = 1e-5 * np.eye(len(point))[k]
        above, below = (objective(coordinates.mixture(point + s), x, v)[0] for s in (step, -step))
        assert expected == pytest.approx((above - below) / 2e-5, abs=1e-7, rel=1e-6)


def joint_gaussians(mixture):
    """The Gaussians over (x, v) as the publication writes them: prior, mean, covariance."""
    for k, prior in enumerate(np.exp(mixture.log_priors)):
        system = mixture.systems[k]
        within = np.linalg.inv(mixture.whiteners[k].T @ mixture.whiteners[k])
        across = within @ system.T
        spread = np.linalg.inv(mixture.sharpeners[k].T @ mixture.sharpeners[k])
        covariance = np.block([[within, across], [across.T, system @ across + spread]])
        yield prior, np.concatenate([mixture.means[k], system @ mixture.means[k]]), covariance


def test_likelihood_is_that_of_the_joint_mixture():
    coordinates, point, generator = random_mixture(5)
    x, v = generator.normal(size=(2, 20, 2))
    mixture = coordinates.mixture(point)
    density = sum(
        prior * multivariate_normal(mean, covariance).pdf(np.hstack([x, v]))
        for prior, mean, covariance in joint_gaussians(mixture)
    )
    value, _ = negative_log_likelihood(mixture, x, v, bias=0.0)
    assert value == pytest.approx(-np.log(density).mean(), rel=1e-10)


def test_velocity_is_gaussian_mixture_regression():
    coordinates, point, generator = random_mixture(7)
    mixture = coordinates.mixture(point)
    x = generator.normal(size=(20, 2))
    shares, means = [], []
    for prior, mean, covariance in joint_gaussians(mixture):
        shares.append(prior * multivariate_normal(mean[:2], covariance[:2, :2]).pdf(x))
        gain = covariance[2:, :2] @ np.linalg.inv(covariance[:2, :2])
        means.append(mean[2:] + (x - mean[:2]) @ gain.T)
    expected = np.einsum("kn,kni->ni", shares / np.sum(shares, axis=0), means)
    np.testing.assert_allclose(mixture.velocity(x), expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_every_free_point_is_stable_and_every_stable_mixture_has_a_point(seed):
    coordinates, point, generator = random_mixture(seed, dimension=3)
    systems = coordinates.mixture(3.0 * point).systems
    worst = np.linalg.eigvalsh(systems + systems.transpose(0, 2, 1)).max()
    assert worst <= -2.0 * MARGIN * (1.0 - 1e-9)
    wanted = seds.nearest_stable(generator.normal(size=(3, 3)))
    mixture = coordinates.mixture(point)
    changed = Mixture(
        mixture.logits,
        mixture.means,
        mixture.whiteners,
        np.stack([wanted] * 3),
        mixture.sharpeners,
    )
    again = coordinates.mixture(coordinates.point(changed))
    for name in ("logits", "means", "whiteners", "systems", "sharpeners"):
        np.testing.assert_allclose(getattr(again, name), getattr(changed, name), atol=1e-12)


def test_rollouts_use_the_matrix_exponential():
    generator = np.random.default_rng(3)
    sizes = np.array([0.0, 1e-3, 1.0, 10.0, 300.0])[:, np.newaxis, np.newaxis]
    systems = sizes * (generator.normal(size=(5, 2, 2)) - 2.0 * np.eye(2))
    x = generator.normal(size=(5, 2))
    expected = [expm(0.1 * system) @ point for system, point in zip(systems, x, strict=True)]
    np.testing.assert_allclose(seds.propagated(systems, x, 0.1), expected, atol=1e-12)


def test_a_linear_system_is_found_again():
    taught = motions(SYSTEM, [[1.0, 0.0], [0.0, 1.0], [-1.0, 1.0]], count=400)
    pair = seds.learn(taught, components=1, seeds=[0])
    for field in (pair.likelihood, pair.mse):
        system = field.mixture.systems[0] * field.speed / field.reach
        np.testing.assert_allclose(system, SYSTEM, atol=0.01)


def test_where_the_constraints_are_slack_the_likelihood_is_that_without_them():
    generator = np.random.default_rng(0)
    x = generator.normal(size=(200, 2))
    v = x @ SYSTEM.T + 0.3 * generator.normal(size=(200, 2))
    x, v = np.vstack([x, -x]), np.vstack([v, -v])  # so that the free mean is the goal, too
    free = GaussianMixture(1, reg_covar=0.0).fit(np.hstack([x, v])).score(np.hstack([x, v]))
    coordinates = Coordinates(1, 2)
    start = coordinates.point(seds.stable_start(x, v, 1, 0)) + 0.3
    unbiased = partial(negative_log_likelihood, bias=0.0)
    loss, _ = seds.descend(unbiased, coordinates, start, x, v, 500)
    assert -loss == pytest.approx(free, abs=1e-6)


def test_where_a_constraint_is_active_another_solver_finds_the_same_optimum():
    generator = np.random.default_rng(1)
    x = generator.normal(size=(200, 2))
    unstable = np.array([[0.6, 1.0], [-0.5, -1.0]])
    v = x @ unstable.T + 0.3 * generator.normal(size=(200, 2))

    def spread(entries):  # the likelihood with the best S for an A, up to a constant
        error = v - x @ entries.reshape(2, 2).T
        return 0.5 * np.linalg.slogdet(error.T @ error / len(x))[1]

    def slack(entries):
        system = entries.reshape(2, 2)
        return -MARGIN - np.linalg.eigvalsh(0.5 * (system + system.T))

    start = -np.eye(2).ravel()
    expected = minimize(spread, start, constraints={"type": "ineq", "fun": slack}, method="SLSQP")
    coordinates = Coordinates(1, 2)
    begin = coordinates.point(seds.stable_start(x, v, 1, 0))
    _, point = seds.descend(negative_log_likelihood, coordinates, begin, x, v, 1000)
    found = coordinates.mixture(point).systems[0]
    assert expected.success
    assert slack(found.ravel()).min() == pytest.approx(0.0, abs=1e-4)
    np.testing.assert_allclose(found, expected.x.reshape(2, 2), atol=2e-3)


def test_the_constraints_hold_after_a_fit():
    pair = learned()
    assert pair.likelihood.worst_eigenvalue < 0.0
    assert pair.mse.worst_eigenvalue < 0.0


def test_each_objective_is_better_at_its_own():
    pair = learned()
    x, v, _, _ = seds.scaled_samples(hooks())
    exact, likely = (squared_error(each.mixture, x, v)[0] for each in (pair.mse, pair.likelihood))
    assert exact < likely
    exact, likely = (
        negative_log_likelihood(each.mixture, x, v)[0] for each in (pair.mse, pair.likelihood)
    )
    assert likely < exact


def test_more_gaussians_fit_no_worse():
    assert learned(4).mse.loss < learned(2).mse.loss
    assert learned(4).likelihood.loss < learned(2).likelihood.loss


@pytest.mark.parametrize("objective", ["likelihood", "mse"])
def test_it_follows_demonstrations_and_arrives_from_anywhere(objective):
    field = getattr(learned(), objective)
    starts = np.random.default_rng(2).uniform(-200.0, 200.0, (20, 2))
    distances = np.linalg.norm(field.rollout(starts, 0.02, 2000), axis=2)
    assert (distances[-1] < 0.4).all()  # a hundredth of the demonstrations' reach
    assert (np.diff(distances, axis=0) < 0.0).all()  # the Lyapunov function it is built on
    times, path = hooks()[0]
    again = field.rollout(path[:1], times[1], len(times) - 1)[:, 0]
    nearest = np.linalg.norm(again[:, np.newaxis] - path, axis=2).min(axis=1)
    assert nearest.max() < 4.0
