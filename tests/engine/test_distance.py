import numpy as np
import pytest

from studio.engine.distance import point_to_box, segment_to_box, segment_to_segment
from studio.engine.skeleton import FloatArray

GRID = np.linspace(0.0, 1.0, 1001)


@pytest.fixture
def random() -> np.random.Generator:
    return np.random.default_rng(0)


def points_on(start: FloatArray, way: FloatArray) -> FloatArray:
    return start[:, None, :] + GRID[:, None] * way[:, None, :]


def by_walking(start: FloatArray, way: FloatArray, o: FloatArray, w: FloatArray) -> FloatArray:
    """The other road: walk along one segment; the nearest point of the other is a projection."""
    points = points_on(start, way) - o[:, None, :]
    length = np.maximum(np.einsum("ni,ni->n", w, w), 1e-18)
    share = np.einsum("nsi,ni->ns", points, w) / length[:, None]
    gap = points - np.clip(share, 0.0, 1.0)[..., None] * w[:, None, :]
    shortest: FloatArray = np.linalg.norm(gap, axis=2).min(axis=1)
    return shortest


@pytest.mark.parametrize("kind", ["any", "parallel", "almost parallel", "a point", "two points"])
def test_segments_agree_with_a_walk_along_one(random: np.random.Generator, kind: str) -> None:
    start, way, other, other_way = random.normal(size=(4, 400, 3))
    if "parallel" in kind:
        other_way = way * random.uniform(-2, 2, (400, 1))
        other_way = other_way + ("almost" in kind) * 1e-7 * random.normal(size=way.shape)
    if "point" in kind:
        way = np.zeros_like(way)
    if kind == "two points":
        other_way = np.zeros_like(way)
    found = segment_to_segment(start, way, other, other_way)
    walked = by_walking(start, way, other, other_way)
    assert (found <= walked + 1e-12).all()
    np.testing.assert_allclose(found, walked, atol=4e-3)  # half a step of the walk
    np.testing.assert_allclose(found, segment_to_segment(other, other_way, start, way), atol=1e-7)


def test_segments_that_cross_touch() -> None:
    x, y = np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]])
    assert segment_to_segment(-x / 2, x, -y / 2, y)[0] == 0.0


@pytest.mark.parametrize("kind", ["any", "along an axis", "a point", "through it"])
def test_boxes_agree_with_a_walk_along_the_segment(random: np.random.Generator, kind: str) -> None:
    start, way = 1.5 * random.normal(size=(2, 400, 3))
    half = random.uniform(0.1, 1.0, (400, 3))
    if kind == "along an axis":
        way[:, :2] = 0.0
    if kind == "a point":
        way[:] = 0.0
    if kind == "through it":
        start = -0.5 * way
    found = segment_to_box(start, way, half)
    walked = point_to_box(points_on(start, way), half[:, None, :]).min(axis=1)
    assert (found <= walked + 1e-12).all()
    np.testing.assert_allclose(found, walked, atol=4e-3)
    if kind == "through it":
        np.testing.assert_allclose(found, 0.0, atol=1e-12)


def test_a_point_is_as_far_from_a_box_as_from_its_nearest_side_edge_or_corner() -> None:
    half = np.array([1.0, 2.0, 3.0])
    points = np.array([[0.5, 0, 0], [3, 0, 0], [4, 6, 0], [-2, 4, -5]])
    np.testing.assert_allclose(point_to_box(points, half), [0, 2, 5, 3])


def test_leading_dimensions_broadcast(random: np.random.Generator) -> None:
    start, way = random.normal(size=(2, 5, 7, 3))
    half = random.uniform(0.1, 1.0, (7, 3))
    each = [segment_to_box(s, w, half) for s, w in zip(start, way, strict=True)]
    np.testing.assert_array_equal(segment_to_box(start, way, half), each)
    each = [segment_to_segment(s, w, half, half) for s, w in zip(start, way, strict=True)]
    np.testing.assert_array_equal(segment_to_segment(start, way, half, half), each)
