import numpy as np
import pytest

from studio.rbf.trajectories import as_states, read_demonstrations, read_goal

LINE = np.column_stack([np.arange(5.0), 2.0 * np.arange(5.0)])


def test_stamps_and_a_step_say_the_same():
    by_step = read_demonstrations([LINE, LINE[:3]], 0.5)
    by_stamps = read_demonstrations(
        [(0.5 * np.arange(5), LINE), (0.5 * np.arange(3), LINE[:3])], None
    )
    for first, second in zip(by_step, by_stamps, strict=True):
        np.testing.assert_array_equal(first.times, second.times)
        np.testing.assert_array_equal(first.positions, second.positions)


@pytest.mark.parametrize("samples", [2, 3, 9])
def test_velocities_of_a_straight_line_are_its_slope(samples):
    times = np.cumsum(np.random.default_rng(0).uniform(0.1, 1.0, samples))
    (line,) = read_demonstrations([(times, np.outer(times, [3.0, -1.0]))], None)
    np.testing.assert_allclose(line.velocities, np.tile([3.0, -1.0], (samples, 1)), atol=1e-12)


@pytest.mark.parametrize(
    ("demonstrations", "dt", "words"),
    [
        ([], None, "no demonstration"),
        ([LINE], None, "demonstration 1 is a pair of times"),
        ([LINE[:1]], 1.0, "1 samples, but a motion takes at least two"),
        ([LINE, LINE[:, :1]], 1.0, r"one dimension d, not \[2, 1\]"),
        ([LINE[:, 0]], 1.0, r"shape \(T, d\), not \(5,\)"),
        ([LINE], 0.0, "dt"),
        ([(np.arange(4.0), LINE)], None, r"5 positions, but times of shape \(4,\)"),
        ([(np.array([0.0, 1.0, 1.0, 2.0, 3.0]), LINE)], None, "must rise, but sample 2"),
        ([1e200 * LINE], 1.0, "reach .* another unit"),
        ([1e-200 * LINE], 1.0, "reach .* another unit"),
        ([LINE], 1e-160, "another unit of time"),
        ([[[1.0, 2.0], [3.0]]], 1.0, "demonstration 1: "),
        ([(np.arange(5.0), LINE * np.nan)], None, r"positions of demonstration 1.* is NaN"),
    ],
)
def test_what_cannot_be_learned_from_is_refused_in_words(demonstrations, dt, words):
    with pytest.raises(ValueError, match=words):
        read_demonstrations(demonstrations, dt)


def test_goals_and_states_have_the_dimension():
    assert read_goal(None, 3) is None
    np.testing.assert_array_equal(read_goal([1, 2], 2), [1.0, 2.0])
    with pytest.raises(ValueError, match=r"shape \(2,\), not \(3,\)"):
        read_goal([1.0, 2.0, 3.0], 2)
    points, shape = as_states([1.0, 2.0], 2)
    assert (points.shape, shape) == ((1, 2), (2,))
    for wrong in ([1.0], [[1.0, 2.0, 3.0]], np.empty((0, 2)), np.zeros((2, 2, 2)), [np.nan, 1.0]):
        with pytest.raises(ValueError, match="x"):
            as_states(wrong, 2)
