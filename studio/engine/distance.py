"""Distances of line segments from each other and from boxes: closed forms on arrays of pairs.

A capsule is a segment with a radius, so its distance is the segment's less that radius. Leading
dimensions broadcast: (..., 3) points against (..., 3) points.
"""

import numpy as np

from studio.engine.skeleton import FloatArray

_TINY = 1e-18  # [m²] below it a segment counts as a point
_STILL = 1e-12  # [m] a way along an axis that is none
_ENDS = np.array([0.0, 1.0])


def segment_to_segment(
    start: FloatArray, way: FloatArray, other_start: FloatArray, other_way: FloatArray
) -> FloatArray:
    """Return the distances (...) between the segments ``start + s way`` and the others, s in 0..1.

    The nearest points of the two lines are brought back into the segments in turn, after
    Ericson, "Real-Time Collision Detection" (2005), section 5.1.9.
    """
    between = start - other_start
    a = np.maximum(_dot(way, way), _TINY)
    e = np.maximum(_dot(other_way, other_way), _TINY)
    b, c, f = _dot(way, other_way), _dot(way, between), _dot(other_way, between)
    s = _share((b * f - c * e) / np.maximum(a * e - b * b, _TINY * e))
    t = _share((b * s + f) / e)
    s = _share((b * t - c) / a)
    gap = between + s[..., None] * way - t[..., None] * other_way
    distances: FloatArray = np.sqrt(_dot(gap, gap))
    return distances


def segment_to_box(start: FloatArray, way: FloatArray, half: FloatArray) -> FloatArray:
    """Return the distances (...) of segments from boxes of half sizes ``half`` (..., 3).

    The segments are told in the boxes' own frames; the distance is 0 where they meet. Half of the
    squared distance is convex along the segment, and its slope rises linearly between the moments
    at which the segment crosses a plane of one of the box's sides. So the slope's zero is found by
    interpolation: it is the last of the moments to which the stretches with a falling start lead.
    """
    moves = np.where(np.abs(way) > _STILL, way, 1.0)  # a moment too many does no harm
    moments = np.empty((*start.shape[:-1], 8))
    np.divide(-half - start, moves, out=moments[..., :3])
    np.divide(half - start, moves, out=moments[..., 3:6])
    moments[..., 6:] = _ENDS
    moments = np.sort(_share(moments), axis=-1)
    points = start[..., None, :] + moments[..., None] * way[..., None, :]
    outside = points - np.minimum(np.maximum(points, -half[..., None, :]), half[..., None, :])
    slopes = np.einsum("...mi,...i->...m", outside, way)  # (..., 8), never falling
    falls = np.maximum(-slopes[..., :-1], 0.0)
    rises = np.maximum(slopes[..., 1:] - slopes[..., :-1], falls)
    first, last = moments[..., :-1], moments[..., 1:]
    zeros = first + falls / np.maximum(rises, _STILL) * (last - first)
    nearest = np.where(falls > 0.0, zeros, 0.0).max(axis=-1)
    return point_to_box(start + nearest[..., None] * way, half)


def point_to_box(point: FloatArray, half: FloatArray) -> FloatArray:
    """Return the distances (...) of points, told in the boxes' own frames; 0 inside."""
    outside = np.maximum(np.abs(point) - half, 0.0)
    distances: FloatArray = np.sqrt(_dot(outside, outside))
    return distances


def _share(values: FloatArray) -> FloatArray:
    clipped: FloatArray = np.minimum(np.maximum(values, 0.0), 1.0)  # a third of np.clip's price
    return clipped


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    product: FloatArray = np.einsum("...i,...i->...", a, b)
    return product
