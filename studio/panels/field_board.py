"""A learned field on a board beside the robot: arrows, rollouts, and start points to drag.

The board stands upright; across it goes the direction in which the demonstrations spread most, up
goes the second one. Both are stretched to fill it, each at its own scale: the second is small.
"""

import numpy as np
import viser

from studio.engine import commands
from studio.engine.field_picture import LEGS, FieldPicture, Plane, Rollouts
from studio.engine.skeleton import FloatArray
from studio.engine.snapshot import Snapshot
from studio.panels.dragging import Drag, over
from studio.panels.inputs import Post
from studio.panels.palette import MEAN, PLAIN, STABLE, START
from studio.panels.trails import segments

MIDDLE = np.array([0.25, 1.75, 1.25])  # [m] of the board in the world
SIZE = np.array([1.5, 0.9])  # [m] across and up
THICK = 0.02  # [m]
_BEFORE = 0.015  # [m] in front of the board
_ARROW = 0.1  # [m] of the longest
_NORMAL = np.array([1.0, 0.0, 0.0])


class FieldBoard:
    """See the module."""

    def __init__(self, scene: viser.SceneApi, post: Post, name: str = "/field") -> None:
        self._scene, self._post, self._name = scene, post, name
        self._drawn: FieldPicture | None = None
        self._root = scene.add_frame(name, show_axes=False, visible=False)
        self._starts: list[Drag] = []
        self._of_kind: dict[str, viser.SceneNodeHandle] = {}  # what a picture may lack

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        picture = now.compare.field
        self._root.visible = picture is not None
        if picture is None:
            return
        if picture is not self._drawn:
            self._show(picture)
        for start, rollout in zip(self._starts, picture.rollouts, strict=True):
            start.draw(placed(picture.plane, rollout.start))

    def _show(self, picture: FieldPicture) -> None:
        """Draw what has changed: of a dragged start point nothing but the rollouts."""
        before, self._drawn = self._drawn, picture
        if before is None or before.plane is not picture.plane:
            self._furnish(picture)
        for kind, color, width in (("stable", STABLE, 0.012), ("plain", PLAIN, 0.006)):
            paths = [getattr(rollout, kind) for rollout in picture.rollouts]
            if getattr(picture, kind) is None:
                continue
            lines = [segments(placed(picture.plane, inside(picture.plane, p))) for p in paths]
            self._of_kind[kind] = self._scene.add_line_segments(
                f"{self._name}/{kind}",
                np.concatenate(lines),
                colors=color,
                thickness=width,
                thickness_units="world",
            )

    def _furnish(self, picture: FieldPicture) -> None:
        scene, name, plane = self._scene, self._name, picture.plane
        for node in self._of_kind.values():
            node.remove()
        self._of_kind = {}
        scene.add_box(
            f"{name}/board",
            dimensions=(THICK, *SIZE),
            position=MIDDLE,
            color=(250, 250, 248),
            cast_shadow=False,
        )
        shown = [segments(placed(plane, rows)) for rows in picture.demonstrations]
        scene.add_line_segments(
            f"{name}/shown", np.concatenate(shown), colors=MEAN, thickness=0.003
        )
        for kind, color in (("stable", STABLE), ("plain", PLAIN)):
            flow = getattr(picture, kind)
            if flow is None:
                continue
            self._of_kind[f"{kind}_arrows"] = scene.add_arrows(
                f"{name}/{kind}_arrows",
                arrows(plane, picture.places, flow),
                colors=pale(color),
                shaft_radius=0.004,
                head_radius=0.013,
                head_length=0.025,
            )
        scene.add_icosphere(
            f"{name}/goal", radius=0.022, color=MEAN, position=placed(plane, np.zeros(2))
        )
        top = MIDDLE + np.array([0.0, 0.0, SIZE[1] / 2 + 0.06])
        scene.add_label(f"{name}/title", title(picture), position=top, anchor="bottom-center")
        self._starts = [
            self._start(number, rollout, plane) for number, rollout in enumerate(picture.rollouts)
        ]

    def _start(self, number: int, rollout: Rollouts, plane: Plane) -> Drag:
        node = self._scene.add_icosphere(
            f"{self._name}/start_{number}",
            radius=0.045,
            color=START,
            position=placed(plane, rollout.start),
        )

        def moved(point: FloatArray, is_let_go: bool) -> None:
            if is_let_go:
                u, v = taken(plane, point).tolist()
                self._post(commands.PlaceStart(number, u, v))

        def keep(point: FloatArray) -> FloatArray:
            return placed(plane, plane.kept(taken(plane, point)))

        return Drag(node, {None: over(_NORMAL)}, moved, keep)


def title(picture: FieldPicture) -> str:
    """Return what stands above the board."""
    if picture.stable is None:
        return "one plain field for both ways; gray ball = goal"
    return f"the field {LEGS[picture.leg]}: thick = stable, thin = plain; gray ball = goal"


def placed(plane: Plane, places: FloatArray) -> FloatArray:
    """Return where places (..., 2) [rad] on the plane stand on the board (..., 3) [m]."""
    shares = (places - plane.low) / (plane.high - plane.low) - 0.5
    across, up = shares[..., 0] * SIZE[0], shares[..., 1] * SIZE[1]
    before = np.full_like(across, THICK / 2 + _BEFORE)
    points: FloatArray = MIDDLE + np.stack([before, across, up], axis=-1)
    return points


def taken(plane: Plane, points: FloatArray) -> FloatArray:
    """Return the places (..., 2) [rad] of points (..., 3) [m] on the board."""
    shares = (points - MIDDLE)[..., 1:] / SIZE + 0.5
    found: FloatArray = plane.low + shares * (plane.high - plane.low)
    return found


def inside(plane: Plane, path: FloatArray) -> FloatArray:
    """Return a path (T, 2) [rad] up to where it leaves the board."""
    kept = np.all((path >= plane.low) & (path <= plane.high), axis=1)
    end = len(path) if kept.all() else max(int(np.argmin(kept)), 1)
    cut = path[:end]
    return np.vstack([cut, cut]) if len(cut) == 1 else cut


def arrows(plane: Plane, places: FloatArray, velocities: FloatArray) -> FloatArray:
    """Return arrows (A, 2, 3) [m] on the board; the longest of all has the same length always."""
    flow = velocities / (plane.high - plane.low) * SIZE
    longest = float(np.linalg.norm(flow, axis=1).max())
    # Roots, so that slow places still show where they lead.
    lengths = np.linalg.norm(flow, axis=1, keepdims=True)
    shown = _ARROW * flow / np.sqrt(np.maximum(lengths * max(longest, 1e-12), 1e-24))
    begin = placed(plane, places)
    tip = begin + np.column_stack([np.zeros(len(shown)), shown])
    return np.stack([begin, tip], axis=1)


def pale(color: tuple[int, int, int]) -> tuple[int, int, int]:
    """Return a color halfway to white, for what stands behind."""
    red, green, blue = ((255 + part) // 2 for part in color)
    return red, green, blue
