"""Which triangles of a mesh are shaded as one smooth surface, and which meet in a sharp edge."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from studio.panels.glb import Surface
from studio.panels.triangles import Edges, Index, Triangles, unit

CREASE = np.cos(np.radians(40.0))  # triangles that meet at more than 40 degrees meet in an edge


def shaded(mesh: Triangles) -> Surface:
    """Return a mesh as a surface: a vertex is split where an edge, or a line of color, meets it."""
    corners = mesh.faces.ravel()
    links = _smooth_links(mesh)
    graph = sparse.coo_array((np.ones(links.shape[1]), tuple(links)), (corners.size, corners.size))
    groups = connected_components(graph, directed=False)[1]
    _, first, vertex = np.unique(groups, return_index=True, return_inverse=True)
    return Surface(
        vertices=mesh.vertices[corners[first]],
        faces=vertex.reshape(-1, 3),
        colors=mesh.colors[first // 3],
    )


def _smooth_links(mesh: Triangles) -> Index:
    """Return pairs (2, N) of corners at one vertex, of triangles that share a smooth edge there."""
    edges = Edges.of(mesh.faces)
    order = np.argsort(edges.of_side, kind="stable")
    sharing = edges.of_side[order[:-1]] == edges.of_side[order[1:]]
    one, other = order[:-1][sharing], order[1:][sharing]
    normals = unit(mesh.crosses())
    smooth = np.sum(normals[one // 3] * normals[other // 3], axis=1) > CREASE
    smooth &= np.all(mesh.colors[one // 3] == mesh.colors[other // 3], axis=1)
    one, other = one[smooth], other[smooth]
    at_ends = [
        np.stack([_corner_at(mesh.faces, side, end) for side in (one, other)])
        for end in edges.ends[edges.of_side[one]].T
    ]
    return np.hstack(at_ends)


def _corner_at(faces: Index, sides: Index, vertices: Index) -> Index:
    """Return the corner of each side that stands at a vertex: its own, or the next around."""
    following = sides - sides % 3 + (sides + 1) % 3
    return np.where(faces.ravel()[sides] == vertices, sides, following)
