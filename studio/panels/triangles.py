"""Triangle meshes as arrays, and their edges."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from studio.engine.skeleton import FloatArray

Index = NDArray[np.int64]

WELD = 1e-5  # [m] corners closer than that are one


@dataclass(frozen=True, eq=False)
class Triangles:
    """Triangles, each of one color; where they are welded, neighbors share their corners."""

    vertices: FloatArray  # (V, 3) [m]
    faces: Index  # (F, 3)
    colors: NDArray[np.uint8]  # (F, 4) red, green, blue, alpha

    @classmethod
    def welded(cls, vertices: FloatArray, faces: Index, colors: NDArray[np.uint8]) -> "Triangles":
        """Return triangles whose corners are one where they are at one place."""
        grid = np.round(vertices / WELD).astype(np.int64)
        _, first, place = np.unique(grid, axis=0, return_index=True, return_inverse=True)
        # As plain arrays: trimesh's own keep watch over every change.
        corners, places = place.ravel()[np.asarray(faces)], np.asarray(vertices)[first]
        return cls(places, corners, np.asarray(colors)).tidied()[0]

    def tidied(self) -> tuple["Triangles", Index]:
        """Return what is neither a line nor double, and which vertices (V',) that still needs."""
        solid = np.all(self.faces != np.roll(self.faces, 1, axis=1), axis=1)
        faces, colors = self.faces[solid], self.colors[solid]
        turns = np.argmin(faces, axis=1)[:, None]  # the lowest corner first, the same way round
        turned = np.take_along_axis(faces, (np.arange(3) + turns) % 3, axis=1)
        span = len(self.vertices)
        keys = turned @ np.array([span * span, span, 1])
        first = np.sort(np.unique(keys, return_index=True)[1])
        used, corners = np.unique(turned[first], return_inverse=True)
        return Triangles(self.vertices[used], corners.reshape(-1, 3), colors[first]), used

    def crosses(self) -> FloatArray:
        """Return the triangles' normals (F, 3), as long as twice their areas [m^2]."""
        a, b, c = (self.vertices[corner] for corner in self.faces.T)
        return np.cross(b - a, c - a)


@dataclass(frozen=True, eq=False)
class Edges:
    """The edges of a mesh. Side 3 f + i of triangle f runs from its corner i to the next one."""

    ends: Index  # (E, 2) vertices
    of_side: Index  # (3 F,) the edge of each side
    counts: Index  # (E,) how many triangles it has

    @classmethod
    def of(cls, faces: Index) -> "Edges":
        """Return the edges of faces (F, 3)."""
        sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2))
        span = int(faces.max(initial=0)) + 1
        keys, of_side = np.unique(sides @ np.array([span, 1]), return_inverse=True)
        return cls(np.stack(np.divmod(keys, span), axis=1), of_side, np.bincount(of_side))


def unit(vectors: FloatArray) -> FloatArray:
    """Return vectors (N, 3) at length 1; one without a length stays as it is."""
    units: FloatArray = vectors / above_zero(np.linalg.norm(vectors, axis=1, keepdims=True))
    return units


def above_zero(values: FloatArray) -> FloatArray:
    """Return values by which one may divide."""
    return np.maximum(values, np.finfo(float).tiny)
