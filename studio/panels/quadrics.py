"""What it costs to collapse an edge of a mesh: how far that moves the surface, and its shading.

The distance is the quadric error of Garland and Heckbert, "Surface simplification using quadric
error metrics" (1997): here the mean squared distance, weighted by area, to the planes of all
triangles that a vertex has come to stand for. As normals are computed from what is left, a second
term keeps apart what is to be shaded differently: how the normals of the vertices that became one
spread about their mean, weighted likewise (the criterion of Ward, "Hierarchical grouping to
optimize an objective function", 1963).

A vertex has a row of sums: the entries of its quadric x A x + 2 b x + c (A's upper half, b, c), the
weight of its planes, its area, its normals times area, and their spread before anything was merged.
Rows are added where vertices merge.
"""

import numpy as np
from numpy.typing import NDArray

from studio.engine.skeleton import FloatArray
from studio.panels.triangles import Edges, Index, Triangles, above_zero, unit

SHADE = 0.0046  # [m] normals that spread by one radian are as bad as a surface so far away
PATCH = 0.015**2  # [m^2] a smaller area matters in proportion
_SEAM = 10.0  # how much dearer it is to leave a rim, or the line between two colors
_HOLD = 1e-3  # how much a vertex is held to the middle of its edge, where planes leave it free

_PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2), (0, 3), (1, 3), (2, 3), (3, 3))
_MATRIX, _VECTOR, _CONSTANT = [0, 1, 2, 1, 3, 4, 2, 4, 5], [6, 7, 8], 9
_WEIGHT, _AREA, _NORMAL, _SPREAD, _WIDTH = 10, 11, slice(12, 15), 15, 16


def vertex_sums(mesh: Triangles) -> FloatArray:
    """Return the sums (V, 16) of each vertex: its triangles, rims and lines of color."""
    sums = np.zeros((len(mesh.vertices), _WIDTH))
    crosses = mesh.crosses()
    areas, normals = np.linalg.norm(crosses, axis=1) / 2.0, unit(crosses)
    for corner in mesh.faces.T:
        _add_planes(sums, corner, normals, mesh.vertices[corner], areas)
        _add(sums[:, _AREA], corner, areas)
        _add(sums[:, _NORMAL], corner, areas[:, None] * normals)
    sums[:, _SPREAD] = _spread(sums)
    edges = Edges.of(mesh.faces)
    side = np.flatnonzero(_is_seam(mesh, edges)[edges.of_side])
    start, end = edges.ends[edges.of_side[side]].T
    along = mesh.vertices[end] - mesh.vertices[start]
    upright = unit(np.cross(along, normals[side // 3]))
    for corner in (start, end):
        weights = _SEAM * np.sum(along**2, axis=1)
        _add_planes(sums, corner, upright, mesh.vertices[corner], weights)
    return sums


def best_places(vertices: FloatArray, sums: FloatArray, ends: Index) -> tuple[FloatArray, ...]:
    """Return where each edge would best collapse to (E, 3) [m], and the cost (E,) [m^2]."""
    one, other = ends.T
    both = sums[one] + sums[other]
    middle = (vertices[one] + vertices[other]) / 2.0
    reach = np.linalg.norm(vertices[one] - vertices[other], axis=1)
    quadrics = both[:, :_WEIGHT] / above_zero(both[:, _WEIGHT, None])
    A, b = quadrics[:, _MATRIX].reshape(-1, 3, 3), quadrics[:, _VECTOR]
    slopes = np.matmul(A, middle[:, :, None])[:, :, 0] + b
    costs = np.sum(middle * (slopes + b), axis=1) + quadrics[:, _CONSTANT]
    steps = -np.linalg.solve(A + _HOLD * np.eye(3), slopes[:, :, None])[:, :, 0]
    steps[np.linalg.norm(steps, axis=1) > reach] = 0.0
    costs += np.sum(steps * (2.0 * slopes + np.matmul(A, steps[:, :, None])[:, :, 0]), axis=1)
    shading = np.maximum(_spread(both) - both[:, _SPREAD], 0.0)
    shading /= np.maximum(both[:, _AREA], PATCH)
    return middle + steps, np.maximum(costs, 0.0) + SHADE**2 * shading


def _spread(sums: FloatArray) -> FloatArray:
    """Return the normals' squared distances (N,) from their mean, times area."""
    squares = np.sum(sums[:, _NORMAL] ** 2, axis=1)
    spread: FloatArray = sums[:, _AREA] - squares / above_zero(sums[:, _AREA])
    return spread


def _is_seam(mesh: Triangles, edges: Edges) -> NDArray[np.bool_]:
    """Return which edges (E,) are rims or part two colors."""
    shades = np.repeat(mesh.colors.astype(np.int64) @ (1 << np.arange(0, 32, 8)), 3)
    lowest = np.full(len(edges.ends), shades.max(initial=0))
    np.minimum.at(lowest, edges.of_side, shades)
    parts = np.zeros(len(edges.ends), bool)
    parts[edges.of_side[shades != lowest[edges.of_side]]] = True
    parts[edges.counts != 2] = True
    return parts


def _add_planes(
    sums: FloatArray, vertices: Index, normals: FloatArray, origins: FloatArray, weights: FloatArray
) -> None:
    """Add planes (N,), by normal and a point, to the quadrics of vertices (N,)."""
    planes = np.column_stack([normals, -np.sum(normals * origins, axis=1)])
    rows, columns = np.transpose(_PAIRS)
    _add(sums[:, :_WEIGHT], vertices, weights[:, None] * planes[:, rows] * planes[:, columns])
    _add(sums[:, _WEIGHT], vertices, weights)


def _add(sums: FloatArray, vertices: Index, values: FloatArray) -> None:
    """Add values (N,) or (N, k) to the sums (V,) or (V, k) of vertices (N,)."""
    for total, value in zip(np.atleast_2d(sums.T), np.atleast_2d(values.T), strict=True):
        np.add(total, np.bincount(vertices, value, len(total)), out=total)
