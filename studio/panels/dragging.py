"""Nodes of the 3D view that people drag: the block, a field's start points, the puppet's hands.

A dragged node stays under the pointer until viser says that the drag is over, which it also does
where a browser is gone. Nothing else ends a drag: whoever holds still for long, or whose browser
draws a picture in two seconds, goes on where he was.
"""

import threading
from collections.abc import Callable, Mapping
from typing import Any, Literal

import numpy as np
import viser

from studio.engine.skeleton import FloatArray
from studio.panels.hearing import heard_as

SETTLING = 15  # pictures in which the engine may bring a node to where it was let go
_STILL = 1e-4  # [m]; what moved less is not drawn anew
_FLAT = 0.05  # of a line of sight whose slope is smaller the plane says nothing

# From the eye, the pointer in the plane of the picture, and where the drag began (3,) [m] to where
# the pointer leads, if anywhere.
Way = Callable[[FloatArray, FloatArray, FloatArray], FloatArray | None]
Ways = Mapping[Literal["shift"] | None, Way]  # by the key that is held meanwhile
Drop = Callable[[FloatArray, bool], None]  # where it is now (3,) [m], and whether it was let go


class Drag:
    """One of them; viser's loop drags it, another thread draws it.

    Parameters
    ----------
    node
        A node at the scene's root.
    ways
        How it follows the pointer.
    moved
        Is told where it is dragged to.
    keep
        Returns the nearest place where it may be.
    """

    def __init__(
        self,
        node: Any,
        ways: Ways,
        moved: Drop,
        keep: Callable[[FloatArray], FloatArray] = np.array,
    ) -> None:
        self._node, self._moved, self._keep = node, moved, keep
        self._lock = threading.Lock()
        self._begun: FloatArray | None = None  # (3,) [m] where it was gripped
        self._grip: FloatArray | None = None  # (3,) [m] from where the pointer led to the middle
        self._at: FloatArray | None = None  # (3,) [m] where it was dragged to
        self._left: FloatArray | None = None  # (3,) [m] where the engine had it when it was let go
        self._unsettled = 0  # pictures since then
        for key, way in ways.items():
            node.on_drag("left", modifier=key)(self._following(way))

    def draw(self, position: FloatArray) -> None:
        """Bring the node to where it is (3,) [m], or is dragged to."""
        with self._lock:
            if self._at is not None and self._begun is None:
                self._settle(position)
            place = position if self._at is None else self._at
            if np.abs(self._node.position - place).max() > _STILL:
                self._node.position = place

    def _settle(self, position: FloatArray) -> None:
        """Let it go for good once the engine has moved it, or does not in time."""
        left = position if self._left is None else self._left
        self._left, self._unsettled = left, self._unsettled + 1
        if np.abs(position - left).max() > _STILL or self._unsettled > SETTLING:
            self._at = None

    def _following(self, way: Way) -> Callable[[viser.SceneNodeDragEvent[Any]], Any]:
        # On viser's loop, where drags keep their order; its threads may overtake each other.
        async def follow(event: viser.SceneNodeDragEvent[Any]) -> None:
            eye, pointer = np.array(event.client.camera.position), np.array(event.end_position)
            place = self._follow(event.phase, way, eye, pointer)
            if place is not None:
                with heard_as(event.client_id):
                    self._moved(place, event.phase == "end")

        return follow

    def _follow(
        self, phase: str, way: Way, eye: FloatArray, pointer: FloatArray
    ) -> FloatArray | None:
        """Return where it is dragged to as seen by an eye, if it is."""
        with self._lock:
            begun = self._begun
            if phase == "start" or begun is None:
                begun = np.array(self._node.position if self._at is None else self._at)
                self._grip = None
            led = way(eye, pointer, begun)
            if led is not None:
                self._grip = begun - led if self._grip is None else self._grip
                self._at = self._keep(led + self._grip)
            self._begun = None if phase == "end" else begun
            self._left, self._unsettled = None, 0
            return self._at


def in_the_picture(_: FloatArray, pointer: FloatArray, __: FloatArray) -> FloatArray:
    """Follow the pointer in the plane of the picture: a `Way`."""
    return pointer


def over(normal: FloatArray) -> Way:
    """Return the way over the plane that stands on ``normal`` (3,) where the drag began."""
    return lambda eye, pointer, begun: on_plane(eye, pointer, begun, normal)


def on_plane(
    eye: FloatArray, seen: FloatArray, point: FloatArray, normal: FloatArray
) -> FloatArray | None:
    """Return where the line of sight from an eye (3,) through ``seen`` meets a plane.

    The plane goes through ``point`` (3,) and stands on ``normal``. None where it is seen too flat,
    or lies behind the eye.
    """
    line = seen - eye
    length = float(np.linalg.norm(line))
    steepness = float(line @ normal)
    if abs(steepness) < _FLAT * max(length, 1e-9):
        return None
    share = float((point - eye) @ normal) / steepness
    return eye + share * line if share > 0.0 else None
