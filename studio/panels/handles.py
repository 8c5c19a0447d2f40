"""The puppet's handles: balls around its hands and elbows, which people drag in the 3D view.

A dragged handle stays under the pointer, in the plane of the picture, or with Shift at its height.
The puppet follows as fast as a person moves. A handle that nobody drags stands at its joint: the
page moves it, and not the browser, so that the two never pull against each other.
"""

import numpy as np
import viser

from studio.engine import commands
from studio.engine.placement import Placement
from studio.engine.skeleton import SIDES, FloatArray, Joint, Side
from studio.engine.snapshot import Snapshot
from studio.panels.dragging import Drag, Ways, in_the_picture, over
from studio.panels.inputs import Post
from studio.panels.palette import HANDLE
from studio.panels.placing import Placing

_RADII = {"hand": 0.085, "elbow": 0.065}  # [m]
_FURTHEST = 1.5  # [m] from its joint that a handle goes
_WAYS: Ways = {None: in_the_picture, "shift": over(np.array([0.0, 0.0, 1.0]))}


class Handles:
    """All four of them."""

    def __init__(self, scene: viser.SceneApi, post: Post, name: str = "/puppet") -> None:
        self._placing = Placing()
        self._root = scene.add_frame(name, show_axes=False, visible=False)
        self._handles = {
            Joint.of(part, side): _Handle(scene, post, name, part, side)
            for side in SIDES
            for part in _RADII
        }

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        placement = self._placing.of(now)
        self._root.visible = now.who.puppet is not None
        if now.who.puppet is None or now.skeleton is None or placement is None:
            return
        points = placement.place(now.skeleton.positions)
        for joint, handle in self._handles.items():
            handle.draw(points[joint], placement)


class _Handle:
    """One of them."""

    def __init__(self, scene: viser.SceneApi, post: Post, root: str, part: str, side: Side) -> None:
        self._post, self._part, self._side = post, part, side
        self._placement: Placement | None = None
        self._joint = np.zeros(3)  # [m] where the puppet has it, in the world
        self._node = scene.add_icosphere(
            f"{root}/{side}_{part}",
            radius=_RADII[part],
            color=HANDLE,
            opacity=0.35,
            cast_shadow=False,
            receive_shadow=False,
        )
        self._drag = Drag(self._node, _WAYS, self._moved, lambda point: near(point, self._joint))
        if part == "elbow":
            self._node.on_click(lambda _: post(commands.ReleaseElbow(side)))

    def draw(self, joint: FloatArray, placement: Placement) -> None:
        """Bring the handle to its joint (3,) [m], unless somebody drags it."""
        self._joint, self._placement = joint, placement
        self._drag.draw(joint)

    def _moved(self, point: FloatArray, _: bool) -> None:
        if self._placement is not None:
            x, y, z = self._placement.to_camera(point).tolist()
            drag = commands.DragHand if self._part == "hand" else commands.DragElbow
            self._post(drag(self._side, (x, y, z)))


def near(point: FloatArray, joint: FloatArray) -> FloatArray:
    """Return a point (3,) [m] that is no further from its joint than a handle may be."""
    away = point - joint
    distance = float(np.linalg.norm(away))
    found: FloatArray = joint + away * min(1.0, _FURTHEST / max(distance, 1e-9))
    return found
