"""Surfaces with fewer triangles, by collapsing the edges that show least.

Garland and Heckbert (1997; see `quadrics`) take one edge after the other from a queue; here a round
takes many at once that do not touch each other, so that NumPy does the work.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from studio.engine.skeleton import FloatArray
from studio.panels.quadrics import best_places, vertex_sums
from studio.panels.triangles import Edges, Index, Triangles

_TURN = 0.5  # cosine of how far one collapse may turn a triangle
_SHARES = (0.1, 0.3, 1.0)  # of the tolerance: what costs little goes first
_ROUNDS, _WORTHWHILE = 30, 0.02  # at most for one share; the fewest vertices for another round
_DRAWS = 3  # how often a round looks for further edges that touch no chosen one


def simplified(mesh: Triangles, tolerance: float) -> Triangles:
    """Return the mesh with fewer triangles, about ``tolerance`` [m] from where they were.

    Large areas keep their shading besides. The same mesh gives the same result.
    """
    generator = np.random.default_rng(0)  # whose turn it is among neighbors that cost little
    sums = vertex_sums(mesh)
    for share in _SHARES:
        for _ in range(_ROUNDS):
            before = len(mesh.vertices)
            mesh, sums = _round(mesh, sums, share * tolerance, generator)
            if before - len(mesh.vertices) <= _WORTHWHILE * before:
                break
    return mesh


def _round(
    mesh: Triangles, sums: FloatArray, tolerance: float, generator: np.random.Generator
) -> tuple[Triangles, FloatArray]:
    """Collapse edges that do not touch each other and cost less than the tolerance [m]."""
    edges = Edges.of(mesh.faces)
    places, costs = best_places(mesh.vertices, sums, edges.ends)
    cheap = np.flatnonzero(costs <= tolerance**2)
    chosen = _apart(edges.ends, generator.permutation(cheap), len(mesh.vertices))
    chosen = chosen[_keeps_topology(edges, chosen, len(mesh.vertices))]
    spoiled = _spoiled(mesh, *_collapsed(mesh, edges.ends[chosen], places[chosen]))
    chosen = chosen[~spoiled[edges.ends[chosen]].any(axis=1)]
    moved, target = _collapsed(mesh, edges.ends[chosen], places[chosen])
    kept, gone = edges.ends[chosen].T
    merged = sums.copy()
    merged[kept] += sums[gone]
    tidy, used = Triangles(moved, target[mesh.faces], mesh.colors).tidied()
    return tidy, merged[used]


def _apart(ends: Index, candidates: Index, count: int) -> Index:
    """Return candidates, earlier ones first, of which no two touch the same triangle."""
    chosen = [candidates[:0]]
    near = np.zeros(count, bool)  # the vertices next to those that are taken
    for _ in range(_DRAWS):
        chosen.append(_first_around(ends, candidates, count))
        taken = np.zeros(count, bool)
        taken[ends[chosen[-1]]] = True
        near |= taken
        for end, other in (ends.T, ends.T[::-1]):
            near[end[taken[other]]] = True
        candidates = candidates[~near[ends[candidates]].any(axis=1)]
    return np.concatenate(chosen)


def _first_around(ends: Index, candidates: Index, count: int) -> Index:
    """Return the candidates that come before all others at their vertices and at the next ones."""
    rank = np.full(len(ends), len(candidates))
    rank[candidates] = np.arange(len(candidates))
    first = np.full(count, len(candidates))
    for end in ends.T:
        np.minimum.at(first, end, rank)
    around = first.copy()
    for end, other in (ends.T, ends.T[::-1]):
        np.minimum.at(around, end, first[other])
    one, other = ends[candidates].T
    mine = rank[candidates]
    firsts: Index = candidates[(around[one] == mine) & (around[other] == mine)]
    return firsts


def _keeps_topology(edges: Edges, chosen: Index, count: int) -> NDArray[np.bool_]:
    """Return which collapses glue nothing together: the link condition of Dey et al. (1999)."""
    one, other = edges.ends.T
    ones = np.ones(len(one), np.int64)
    near = sparse.coo_array((ones, (one, other)), (count, count)).tocsr()
    near = (near + near.T).tocsr()
    start, end = edges.ends[chosen].T
    common = np.asarray(near[start].multiply(near[end]).sum(axis=1)).ravel()
    on_rim = np.zeros(count, bool)
    on_rim[edges.ends[edges.counts == 1]] = True
    pinches = (edges.counts[chosen] > 1) & on_rim[start] & on_rim[end]
    keeps: NDArray[np.bool_] = (common == edges.counts[chosen]) & ~pinches
    return keeps


def _collapsed(mesh: Triangles, ends: Index, places: FloatArray) -> tuple[FloatArray, Index]:
    """Return the vertices after collapses, and which one each has become (V,)."""
    kept, gone = ends.T
    moved, target = mesh.vertices.copy(), np.arange(len(mesh.vertices))
    moved[kept] = moved[gone] = places
    target[gone] = kept
    return moved, target


def _spoiled(mesh: Triangles, moved: FloatArray, target: Index) -> NDArray[np.bool_]:
    """Return the vertices (V,) of triangles that would turn too far or become lines."""
    faces = target[mesh.faces]
    stays = np.all(faces != np.roll(faces, 1, axis=1), axis=1)
    touched = stays & np.any(moved[mesh.faces] != mesh.vertices[mesh.faces], axis=(1, 2))
    old = Triangles(mesh.vertices, mesh.faces[touched], mesh.colors[touched]).crosses()
    new = Triangles(moved, mesh.faces[touched], mesh.colors[touched]).crosses()
    lengths = np.linalg.norm(old, axis=1) * np.linalg.norm(new, axis=1)
    bad = np.sum(old * new, axis=1) <= _TURN * lengths
    spoiled = np.zeros(len(moved), bool)
    spoiled[mesh.faces[touched][bad]] = True
    return spoiled
