import numpy as np
import pytest

from studio.rbf.lessons import PATH_POINTS, lesson_from
from studio.rbf.trajectories import read_demonstrations
from tests.rbf.shapes import bent_reach


def lesson(demonstrations, goal=None):
    return lesson_from(read_demonstrations(demonstrations, None), goal)


def test_paths_end_at_the_goal_and_have_even_steps():
    taught = lesson(bent_reach(0))
    assert taught.paths.shape == (3, PATH_POINTS, 2)
    np.testing.assert_allclose(taught.paths[:, -1], 0.0, atol=1e-12)
    steps = np.linalg.norm(np.diff(taught.paths, axis=1), axis=2)
    np.testing.assert_allclose(steps, steps.mean(axis=1, keepdims=True) + 0.0 * steps, rtol=0.05)
    assert np.linalg.norm(taught.paths, axis=2).max(axis=1).mean() == pytest.approx(1.0)


def test_unit_of_length_and_place_of_the_goal_change_nothing():
    plain = bent_reach(1)
    moved = [(times, 1000.0 * rows + [5.0, -7.0]) for times, rows in plain]
    first, second = lesson(plain), lesson(moved)
    np.testing.assert_allclose(first.paths, second.paths, atol=1e-10)
    np.testing.assert_allclose(first.times, second.times, atol=1e-10)
    assert second.unit == pytest.approx(1000.0 * first.unit)


def test_a_rest_on_the_way_changes_the_times_and_not_the_path():
    (times, rows), *_ = bent_reach(2)
    rest = 40
    waited = (
        np.concatenate(
            [times[:rest], times[rest - 1] + 0.01 * np.arange(1, 51), times[rest:] + 1.0]
        ),
        np.concatenate([rows[:rest], np.tile(rows[rest - 1], (50, 1)), rows[rest:]]),
    )
    first, second = lesson([(times, rows)]), lesson([waited])
    np.testing.assert_allclose(first.paths, second.paths, atol=1e-12)
    assert second.times[0, -1] == pytest.approx(first.times[0, -1] + 1.0)


def test_rates_are_positive_and_in_the_demonstrations_time():
    slow = [(3.0 * times, rows) for times, rows in bent_reach(3)]
    rates, thrice = lesson(slow).rates, lesson(bent_reach(3)).rates
    assert (rates > 0.0).all()
    np.testing.assert_allclose(3.0 * rates, thrice)


TIMES = np.arange(6.0)
OUT_AND_BACK = np.array([[0.0], [1.0], [2.0], [2.0], [1.0], [0.0]])


@pytest.mark.parametrize(
    ("rows", "goal", "words"),
    [
        (OUT_AND_BACK, None, "starts at its goal.*Eq. 5.*split the motion"),
        (np.ones((6, 2)), None, "does not move"),
        (TIMES[:, np.newaxis], [9.0], "ends 4 from the goal"),
        (1e200 * TIMES[:, np.newaxis], None, "need another unit"),
        (1e-200 * TIMES[:, np.newaxis], None, "need another unit"),
    ],
)
def test_what_no_field_can_learn_is_refused_in_words(rows, goal, words):
    with pytest.raises(ValueError, match=words):
        lesson([(TIMES, rows)], None if goal is None else np.array(goal))
