"""The robot's surfaces, made light for a browser: one colored surface a link, fine to the eye.

Rethink Robotics' meshes have 250,000 triangles in many parts. Here each link becomes one surface
with less than half of that; `mesh_cache` keeps them, as that takes some seconds.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import trimesh

from studio.engine.robot import Robot, Visual
from studio.engine.urdf import Box, Cylinder, Mesh, Sphere
from studio.panels.glb import Surface
from studio.panels.shading import shaded
from studio.panels.simplify import simplified
from studio.panels.triangles import Triangles

FINE = 0.0002  # [m] how far the robot's light surface may be from the maker's
COARSE = 0.002  # [m] the same for a ghost, through which one looks


@dataclass(frozen=True, eq=False)
class Look:
    """What links look like; the left and the right one of a pair share it."""

    links: tuple[str, ...]
    visuals: tuple[Visual, ...]

    @property
    def has_meshes(self) -> bool:
        """Whether the real meshes are there, not only simple shapes."""
        return any(isinstance(visual.shape, Mesh) for visual in self.visuals)

    def triangles(self) -> Triangles:
        """Return all that the maker gave, in the link's frame."""
        parts = [part for visual in self.visuals for part in _parts(visual)]
        return _joined(parts)

    def surface(self, detail: float) -> Surface:
        """Return the surface in the link's frame, true to about ``detail`` [m]."""
        return shaded(simplified(self.triangles(), detail))


def looks(robot: Robot) -> list[Look]:
    """Return the looks of all links that are to be drawn."""
    by_link: dict[str, list[Visual]] = {}
    for visual in robot.visuals:
        by_link.setdefault(visual.link, []).append(visual)
    sharing: dict[object, list[str]] = {}
    for link, visuals in by_link.items():
        sharing.setdefault(tuple(_signature(visual) for visual in visuals), []).append(link)
    return [Look(tuple(links), tuple(by_link[links[0]])) for links in sharing.values()]


def _parts(visual: Visual) -> Iterator[Triangles]:
    """Yield the parts of a visual in its link's frame, each of one color or with colored faces."""
    scene = _scene(visual)
    for node in scene.graph.nodes_geometry:
        T_visual_part, name = scene.graph[node]
        part = scene.geometry[name].copy()
        part.apply_transform(visual.T_link_visual @ T_visual_part)
        colors = np.empty((len(part.faces), 4), np.uint8)
        if not isinstance(visual.shape, Mesh):
            colors[:] = np.round(255.0 * np.array(visual.color))
        elif part.visual.kind == "texture":
            colors[:] = part.visual.material.main_color
        else:
            colors[:] = part.visual.face_colors
        yield Triangles(part.vertices, part.faces, colors)


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


def _joined(parts: Sequence[Triangles]) -> Triangles:
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    return Triangles.welded(
        vertices=np.vstack([part.vertices for part in parts]),
        faces=np.vstack([part.faces + start for part, start in zip(parts, starts, strict=True)]),
        colors=np.vstack([part.colors for part in parts]),
    )


def _signature(visual: Visual) -> object:
    return visual.shape, visual.color, visual.T_link_visual.tobytes()
