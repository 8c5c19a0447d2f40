"""The robot's surfaces, made light for a browser: one colored surface a link, finer than the eye.

Rethink Robotics' meshes have 250,000 triangles in many parts. Here each link becomes one surface,
simplified by vertex clustering: it takes a second for the whole robot, so that nothing has to be
kept in a cache.
"""

import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh import visual as trimesh_visual

from studio.engine.robot import Robot, Visual
from studio.engine.skeleton import FloatArray
from studio.engine.urdf import Box, Cylinder, Mesh, Sphere

FINE = 0.002  # [m] detail that is kept of the robot
COARSE = 0.010  # [m] the same of a ghost, through which one looks


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles with a normal and a color at each corner."""

    vertices: FloatArray  # (V, 3) [m]
    faces: NDArray[np.int64]  # (F, 3)
    normals: FloatArray  # (V, 3) unit vectors
    colors: NDArray[np.uint8]  # (V, 4) red, green, blue, alpha

    def as_glb(self) -> bytes:
        """Return the surface as a binary glTF file."""
        mesh = trimesh.Trimesh(
            # Rounded below what can be seen, so that the connection compresses them better.
            np.round(self.vertices * 8192.0) / 8192.0,
            self.faces,
            vertex_normals=np.round(self.normals * 64.0) / 64.0,
            process=False,
        )
        silk = trimesh_visual.material.PBRMaterial(  # type: ignore[no-untyped-call]
            metallicFactor=0.0, roughnessFactor=0.55
        )
        mesh.visual = trimesh_visual.TextureVisuals(material=silk)  # type: ignore[no-untyped-call]
        mesh.visual.vertex_attributes["color"] = self.colors
        glb = io.BytesIO()
        mesh.export(glb, file_type="glb", include_normals=True)
        return glb.getvalue()


@dataclass(frozen=True, eq=False)
class Look:
    """What links look like; the left and the right one of a pair share it."""

    links: tuple[str, ...]
    visuals: tuple[Visual, ...]

    @property
    def has_meshes(self) -> bool:
        """Whether the real meshes are there, not only simple shapes."""
        return any(isinstance(visual.shape, Mesh) for visual in self.visuals)

    def surface(self, detail: float) -> Surface:
        """Return the surface in the link's frame, with detail down to ``detail`` [m]."""
        return simplified(_joined([p for visual in self.visuals for p in _parts(visual)]), detail)


def looks(robot: Robot) -> list[Look]:
    """Return the looks of all links that are to be drawn."""
    by_link: dict[str, list[Visual]] = {}
    for visual in robot.visuals:
        by_link.setdefault(visual.link, []).append(visual)
    sharing: dict[object, list[str]] = {}
    for link, visuals in by_link.items():
        sharing.setdefault(tuple(_signature(visual) for visual in visuals), []).append(link)
    return [Look(tuple(links), tuple(by_link[links[0]])) for links in sharing.values()]


def simplified(surface: Surface, detail: float) -> Surface:
    """Merge the vertices of each cell of a grid (Rossignac and Borrel 1993, vertex clustering).

    A triangle whose corners do not fall into three cells vanishes. Corners of one cell stay apart
    where their normals or colors differ, so that edges stay sharp; as they share one position, no
    crack opens between them.
    """
    _, cells = _distinct(np.floor(surface.vertices / detail).astype(np.int64))
    places = _means(surface.vertices, cells)
    corners = cells[surface.faces]
    solid = np.all(corners != np.roll(corners, 1, axis=1), axis=1)
    faces, corners = surface.faces[solid], corners[solid]
    first, _ = _distinct(np.sort(corners, axis=1))
    used, corners = faces[first].ravel(), corners[first].ravel()
    facing = np.round(surface.normals[used]).astype(np.int64)
    kept, index = _distinct(np.column_stack([corners, facing, surface.colors[used]]))
    normals = _means(surface.normals[used], index)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return Surface(
        vertices=places[corners[kept]],
        faces=index.reshape(-1, 3),
        normals=normals / np.maximum(length, np.finfo(float).tiny),
        colors=surface.colors[used][kept],
    )


def _parts(visual: Visual) -> Iterator[Surface]:
    """Yield the parts of a visual in its link's frame, each of one color or with colored faces."""
    scene = _scene(visual)
    for node in scene.graph.nodes_geometry:
        T_visual_part, name = scene.graph[node]
        part = scene.geometry[name].copy()
        part.apply_transform(visual.T_link_visual @ T_visual_part)
        colors = np.empty((len(part.vertices), 4), np.uint8)
        if not isinstance(visual.shape, Mesh):
            colors[:] = np.round(255.0 * np.array(visual.color))
        elif part.visual.kind == "texture":
            colors[:] = part.visual.material.main_color
        else:
            colors[part.faces.ravel()] = np.repeat(part.visual.face_colors, 3, axis=0)
        yield Surface(part.vertices, part.faces, part.vertex_normals, colors)


def _scene(visual: Visual) -> trimesh.Scene:
    match visual.shape:
        case Mesh(file):
            return trimesh.load_scene(file)
        case Box(size):
            return trimesh.Scene(trimesh.creation.box(size))
        case Cylinder(radius, length):
            return trimesh.Scene(trimesh.creation.cylinder(radius, length, sections=48))
        case Sphere(radius):
            return trimesh.Scene(trimesh.creation.icosphere(subdivisions=3, radius=radius))


def _joined(parts: Sequence[Surface]) -> Surface:
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    return Surface(
        vertices=np.vstack([part.vertices for part in parts]),
        faces=np.vstack([part.faces + start for part, start in zip(parts, starts, strict=True)]),
        normals=np.vstack([part.normals for part in parts]),
        colors=np.vstack([part.colors for part in parts]),
    )


def _signature(visual: Visual) -> object:
    return visual.shape, visual.color, visual.T_link_visual.tobytes()


def _distinct(rows: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first row of each kind of row (n, k), and each row's kind (n,)."""
    _, first, kind = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    return first, kind.ravel()


def _means(values: FloatArray, kinds: NDArray[np.int64]) -> FloatArray:
    """Return the mean of values (n, k) of each kind (n,)."""
    counts = np.bincount(kinds)
    sums = np.column_stack([np.bincount(kinds, column) for column in values.T])
    means: FloatArray = sums / counts[:, None]
    return means
