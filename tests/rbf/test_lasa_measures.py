"""What `bench_lasa.py` measures with: against answers that are known, and slower roads to them."""

import numpy as np
import pytest

from tests.bench.lasa import judged, random_starts, resampled, swept_error_area, warping_distance


def slow_warping_distance(one, other):
    least = np.full((len(one) + 1, len(other) + 1), np.inf)
    least[0, 0] = 0.0
    for i, a in enumerate(one, start=1):
        for j, b in enumerate(other, start=1):
            before = min(least[i - 1, j], least[i, j - 1], least[i - 1, j - 1])
            least[i, j] = before + np.linalg.norm(a - b)
    return least[-1, -1]


@pytest.mark.parametrize("seed", range(5))
def test_warping_distance_is_that_of_the_plain_recursion(seed):
    generator = np.random.default_rng(seed)
    one, other = generator.normal(size=(12, 2)), generator.normal(size=(17, 2))
    assert warping_distance(one, other) == pytest.approx(slow_warping_distance(one, other))
    assert warping_distance(one, one) == pytest.approx(0.0, abs=1e-9)


def test_swept_area_between_parallel_lines_is_that_of_the_rectangle():
    line = np.column_stack([np.linspace(0.0, 10.0, 50), np.zeros(50)])
    assert swept_error_area(line, line + np.array([0.0, 3.0])) == pytest.approx(30.0)
    assert swept_error_area(line, line) == 0.0


def test_resampled_points_lie_an_equal_way_apart():
    corner = np.array([[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, 3.0]])
    points = resampled(corner, 9)
    np.testing.assert_allclose(np.linalg.norm(np.diff(points, axis=0), axis=1), 0.5)
    np.testing.assert_allclose(points[[0, 2, -1]], corner[[0, 2, -1]])


def test_a_path_is_cut_where_it_arrives_and_judged_by_whether_it_stays():
    distances = np.array([10.0, 5.0, 0.5, 0.2])
    path = np.column_stack([distances, np.zeros(4)])
    there = judged(path, fence=100.0)
    assert there.arrived
    assert len(there.path) == 3
    passing = judged(np.vstack([path, [[-8.0, 0.0]]]), fence=100.0)
    assert not passing.arrived
    assert len(passing.path) == 3
    lost = judged(np.array([[10.0, 0.0], [200.0, 0.0], [np.nan, 0.0]]), fence=100.0)
    assert not lost.arrived
    assert len(lost.path) == 2
    slow = judged(path[:2], fence=100.0)
    assert not slow.arrived
    assert len(slow.path) == 2


def test_random_starts_lie_around_the_demonstrations():
    path = np.array([[0.0, 0.0], [10.0, 20.0]])
    starts = random_starts([(np.arange(2.0), path)], count=200)
    assert (starts >= [-2.0, -4.0]).all()
    assert (starts <= [12.0, 24.0]).all()
    assert (starts.min(axis=0) < 0.0).all()
