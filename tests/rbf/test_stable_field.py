import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from studio.rbf import Certificate, NotFittedError, StableField
from tests.rbf.shapes import bent_reach


@pytest.fixture(scope="module")
def demonstrations():
    return bent_reach(0)


@pytest.fixture(scope="module")
def field(demonstrations):
    return StableField(goal=[0.0, 0.0]).fit(demonstrations)


def far_starts(count=50, scale=20.0, dimension=2):
    return np.random.default_rng(5).normal(scale=scale, size=(count, dimension))


def test_every_path_ends_at_the_goal_and_v_falls_all_the_way(field):
    starts = far_starts()
    times = np.linspace(0.0, 30.0 / field.certificate_.slowest_rate, 301)
    paths = field.rollout(starts, times[1], 300)
    assert np.linalg.norm(paths[-1], axis=1).max() < 1e-6
    levels = np.stack([field.lyapunov(points) for points in paths])
    told_apart = levels[:-1] > 1e-20  # below, rounding of the goal's place is all there is
    assert (np.diff(levels, axis=0)[told_apart] < 0.0).all()
    bound = levels[0] * np.exp(-2.0 * field.certificate_.slowest_rate * times[:, np.newaxis])
    assert (levels <= 1.001 * bound + 1e-20).all()


def test_velocity_and_rollout_are_two_roads_to_one_path(field, demonstrations):
    for start in (demonstrations[0][1][0], np.array([4.0, -3.0])):
        times = np.linspace(0.0, 2.0, 41)
        solved = solve_ivp(
            lambda _, x: field.velocity(x),
            (0.0, 2.0),
            start,
            method="DOP853",
            t_eval=times,
            rtol=1e-8,
            atol=1e-10,
        )
        np.testing.assert_allclose(field.rollout(start, 0.05, 40), solved.y.T, atol=2e-3)
        fine = field.rollout(start, 0.005, 400)[::10]
        np.testing.assert_allclose(fine, solved.y.T, atol=1e-5)


def test_v_falls_along_the_velocity_as_the_certificate_says(field):
    points = far_starts(scale=3.0)
    step = 1e-6
    ahead = field.lyapunov(points + step * field.velocity(points))
    behind = field.lyapunov(points - step * field.velocity(points))
    rates = -(ahead - behind) / (2.0 * step) / (2.0 * field.lyapunov(points))
    assert rates.min() > field.certificate_.slowest_rate * 0.999
    assert rates.max() < field.certificate_.fastest_rate * 1.001


def test_it_goes_where_and_when_the_demonstrations_went(field, demonstrations):
    for times, rows in demonstrations:
        path = field.rollout(rows[0], times[-1] / 400, 400)
        nearest = np.linalg.norm(path[:, np.newaxis] - rows[np.newaxis], axis=2)
        assert nearest.min(axis=0).max() < 0.08 * np.linalg.norm(rows, axis=1).max()
        near, shown_near = (
            np.linalg.norm(way, axis=1) < 0.5 * np.linalg.norm(rows[0]) for way in (path, rows)
        )
        halfway, shown = near.argmax() / 400 * times[-1], times[shown_near.argmax()]
        assert 0.6 < halfway / shown < 1.4


@settings(deadline=None, derandomize=True, max_examples=6)
@given(
    seed=st.integers(0, 1000),
    dimension=st.sampled_from([1, 2, 3, 7]),
    count=st.sampled_from([1, 4]),
)
def test_in_any_dimension_it_is_certified_and_arrives(seed, dimension, count):
    taught = bent_reach(seed, count, dimension=dimension)
    field = StableField(n_translations=8, max_iterations=60).fit(taught)
    assert field.certificate_.holds
    assert field.certificate_.steepness <= 0.8
    starts = far_starts(10, 10.0, dimension)
    end = field.rollout(starts, 2.0 / field.certificate_.slowest_rate, 20)[-1]
    assert np.linalg.norm(end - field.goal_, axis=1).max() < 1e-6


def test_the_goal_stands_still_and_is_where_it_was_told(demonstrations):
    field = StableField(goal=[0.01, -0.02], n_translations=6, max_iterations=40).fit(demonstrations)
    np.testing.assert_allclose(field.velocity([0.01, -0.02]), 0.0, atol=1e-10)
    np.testing.assert_allclose(field.rollout([1.0, 1.0], 5.0, 50)[-1], [0.01, -0.02], atol=1e-9)


def test_units_of_length_and_time_change_nothing(demonstrations):
    field = StableField(n_translations=6, max_iterations=60).fit(demonstrations)
    scaled = [(60.0 * times, 1000.0 * rows) for times, rows in demonstrations]
    other = StableField(n_translations=6, max_iterations=60).fit(scaled)
    start = demonstrations[0][1][0]
    path = field.rollout(start, 0.05, 40)
    reach = np.linalg.norm(start)
    np.testing.assert_allclose(
        other.rollout(1000.0 * start, 3.0, 40) / 1000.0, path, atol=0.01 * reach
    )


def test_far_away_everything_is_still_a_number(field):
    far = np.array([[1e160, -1e160], [1e100, 0.0]])
    assert np.isfinite(field.velocity(far)).all()
    assert field.lyapunov(far)[0] == np.inf
    assert np.isfinite(field.rollout(far, 1.0, 5)).all()


TURN = np.linspace(0.0, 1.0, 142)


@pytest.mark.parametrize(
    "rows",
    [
        np.sin(np.pi * TURN) + 0.03 * (1.0 - TURN),
        (1.0 - TURN) * np.cos(8.0 * TURN),
    ],
    ids=["there and back", "past the goal and back"],
)
def test_it_warns_where_no_field_can_do_what_was_shown(rows):
    with pytest.warns(UserWarning, match="misses its demonstrations.*split a motion"):
        field = StableField(goal=[0.0]).fit([(TURN, rows[:, np.newaxis])])
    assert field.certificate_.holds


def test_the_error_is_that_of_all_samples_as_they_were_given():
    line = np.column_stack([1.0 - TURN, 0.2 * TURN])
    with pytest.warns(UserWarning, match="12 % of their reach"):
        field = StableField(goal=[0.0, 0.0], n_translations=3).fit([(TURN, line)])
    beside = 0.2 * np.sqrt(np.mean(TURN**2))  # the goal is 0.2 beside the end of the line
    assert field.error_ == pytest.approx(beside, rel=0.01)


def test_the_same_demonstrations_give_the_same_bits(demonstrations):
    one, two = (StableField(n_translations=5, max_iterations=30).fit(demonstrations) for _ in "ab")
    np.testing.assert_array_equal(one.velocity(far_starts()), two.velocity(far_starts()))


@pytest.mark.parametrize(
    "fault",
    [
        {"bound": 1.0},
        {"bound": 0.0},
        {"n_translations": 0},
        {"smoothness": -1.0},
        {"max_iterations": 0},
        {"n_neurons": 0},
        {"goal": [0.0]},
    ],
)
def test_settings_that_cannot_work_are_refused(demonstrations, fault):
    with pytest.raises(ValueError, match=next(iter(fault))):
        StableField(**fault).fit(demonstrations)


def test_it_says_when_it_was_taught_nothing():
    for ask in (lambda f: f.velocity([0.0]), lambda f: f.rollout([0.0], 1.0, 1)):
        with pytest.raises(NotFittedError):
            ask(StableField())


def test_a_certificate_that_does_not_hold_says_so():
    assert "DOES NOT HOLD" in str(Certificate(1.2, 0.1, 2.0))
    assert not Certificate(0.5, 0.0, 2.0).holds
    assert not Certificate(float("nan"), 0.1, 2.0).holds
    assert not Certificate(-1.0, 0.1, 2.0).holds
    assert not Certificate(0.5, 0.1, float("inf")).holds
    assert "holds: steepness 0.500" in str(Certificate(0.5, 0.1, 2.0))


def test_settings_follow_scikit_learn(demonstrations):
    from sklearn.base import clone  # noqa: PLC0415

    field = StableField(n_translations=3).set_params(bound=0.5)
    copy = clone(field)
    assert copy.get_params() == field.get_params()
    with pytest.raises(ValueError, match="no setting 'magic'"):
        field.set_params(magic=1)
