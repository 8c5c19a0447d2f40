"""The hands' paths: demonstrations thin with their envelope, what is played bold."""

from collections.abc import Sequence

import numpy as np
import viser
from numpy.typing import NDArray

from studio.engine.arms import sides_of
from studio.engine.demonstration import DemonstrationSet
from studio.engine.export.material import Take
from studio.engine.measured import envelope, hand_paths, hands_alone, hands_followed
from studio.engine.performance import Performance
from studio.engine.robot import CONTROL_RATE
from studio.engine.skeleton import FloatArray, Side
from studio.engine.snapshot import Snapshot
from studio.panels.palette import ENVELOPE, GHOST, ROBOT, SECOND, Color

THIN, BOLD = 0.0025, 0.009  # [m]
EVERY = 3  # ticks between two updates of a growing trail: 10 Hz
_AROUND, _ALONG = 12, 2  # corners of the envelope's tube, and samples from one ring to the next
_THINNEST = 0.004  # [m] of the tube, where all demonstrations agree

Moved = Performance | Take  # what leaves a trail: a robot alone, or one that followed a person


class Trails:
    """All of them, under a root that is the robots' base; B's are drawn where B stands."""

    def __init__(self, scene: viser.SceneApi, roots: Sequence[str]) -> None:
        self._scene = scene
        self._taught: DemonstrationSet | None = None
        self._thin: list[viser.LineSegmentsHandle | viser.MeshHandle] = []
        self._bold = [
            _Trail(scene, f"{root}/alone", color)
            for root, color in zip(roots, (ROBOT, SECOND), strict=False)
        ]
        self._root = roots[0]

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot: what was learned from and what came of it while that is played.

        While a demonstration is replayed there is the way of the robot that followed the person.
        """
        playing = now.compare.playing
        self._show_taught(playing[0].lesson.taught if playing else None)
        alone = [each.performance for each in playing]
        moved: Sequence[Moved | None] = alone or [now.compare.replayed]
        for number, trail in enumerate(self._bold):
            trail.draw(moved[number] if number < len(moved) else None, now.time)

    def _show_taught(self, taught: DemonstrationSet | None) -> None:
        if taught is self._taught:
            return
        self._taught = taught
        for node in self._thin:
            node.remove()
        self._thin = []
        if taught is None:
            return
        for side in sides_of(taught.arms):
            paths = hand_paths(taught, side)
            self._thin += [
                self._scene.add_line_segments(
                    f"{self._root}/shown_{side}",
                    np.concatenate([segments(path) for path in paths]),
                    colors=GHOST,
                    thickness=THIN,
                    thickness_units="world",
                ),
                self._scene.add_mesh_simple(
                    f"{self._root}/envelope_{side}",
                    *tube(*envelope(paths)),
                    color=ENVELOPE,
                    opacity=0.25,
                    cast_shadow=False,
                    receive_shadow=False,
                ),
            ]


class _Trail:
    """Where one robot's hands have been, up to the playhead."""

    def __init__(self, scene: viser.SceneApi, name: str, color: Color) -> None:
        self._line = scene.add_line_segments(
            name,
            np.zeros((1, 2, 3)),
            colors=color,
            thickness=BOLD,
            thickness_units="world",
            visible=False,
        )
        self._of: Moved | None = None
        self._paths: list[FloatArray] = []  # (T, 3) [m] of each hand, one point a tick
        self._drawn = -1  # points

    def draw(self, moved: Moved | None, time: float) -> None:
        """Show it up to ``time`` [s], or nothing."""
        if moved is None:
            self._line.visible, self._drawn = False, -1
            return
        count = 1 + EVERY * int(min(time, _duration(moved)) * CONTROL_RATE / EVERY)
        if moved is not self._of and not self._knows(moved, count):
            self._of, self._drawn = moved, -1
            self._paths = list(_hands(moved).values())
        if count != self._drawn:
            self._drawn = count
            self._line.visible = count > 1
            if count > 1:
                drawn = [segments(path[:count]) for path in self._paths]
                self._line.points = np.concatenate(drawn).astype(np.float32)

    def _knows(self, moved: Moved, count: int) -> bool:
        """Tell whether it is the same run, simulated further, and far enough known already."""
        before = self._of
        return (
            isinstance(before, Performance)
            and isinstance(moved, Performance)
            and before.ticks[0] is moved.ticks[0]
            and len(before.ticks) > count
            and len(self._paths[0]) > count
        )


def _duration(moved: Moved) -> float:
    """Return how long [s] it moved, the settling left out."""
    return moved.demonstration.duration if isinstance(moved, Take) else moved.duration


def _hands(moved: Moved) -> dict[Side, FloatArray]:
    """Return each hand's path (T, 3) [m], a point a tick, as far as it is known."""
    ticks = round(_duration(moved) * CONTROL_RATE)
    if isinstance(moved, Take):
        return hands_followed(moved, ticks / CONTROL_RATE, ticks + 1)
    ticks = min(len(moved.ticks), ticks)
    return hands_alone(moved, ticks / CONTROL_RATE, ticks + 1)


def segments(points: FloatArray) -> FloatArray:
    """Return the lines (N - 1, 2, 3) that join points (N, 3) one after the other."""
    return np.stack([points[:-1], points[1:]], axis=1)


def tube(middle: FloatArray, radius: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
    """Return vertices (V, 3) [m] and triangles (F, 3) of a tube about a path (T, 3).

    Its radius (T,) [m] is the envelope's: all paths pass at most so far from its middle.
    """
    middle, radius = middle[::_ALONG], np.maximum(radius[::_ALONG], _THINNEST)
    along = np.gradient(middle, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    # Any direction that the path never takes would do to begin with; hands rarely go straight up.
    aside = np.cross(along, (0.0, 0.0, 1.0))
    aside /= np.maximum(np.linalg.norm(aside, axis=1, keepdims=True), 1e-9)
    up = np.cross(aside, along)
    angles = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    rings = (np.cos(angles)[:, None, None] * aside + np.sin(angles)[:, None, None] * up) * radius[
        :, None
    ] + middle
    vertices = rings.transpose(1, 0, 2).reshape(-1, 3)
    corner, ring = np.meshgrid(np.arange(_AROUND), np.arange(len(middle) - 1))
    here = ring * _AROUND
    a, b = here + corner, here + (corner + 1) % _AROUND
    faces = np.stack([a, b, b + _AROUND, a, b + _AROUND, a + _AROUND], axis=-1).reshape(-1, 3)
    return vertices, faces
