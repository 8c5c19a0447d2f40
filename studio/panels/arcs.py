"""The six angles of the person's arm, drawn as arcs with their numbers, where the arm is."""

import math

import numpy as np
import viser

from studio.engine.arm_arcs import NAMES, STEPS, Arc, arm_arcs
from studio.engine.arms import sides_of
from studio.engine.skeleton import FloatArray, Side, other_side
from studio.engine.snapshot import Snapshot
from studio.panels.palette import ARCS
from studio.panels.placing import Placing

NUMBERS = dict(zip(NAMES, "①②③④⑤⑥", strict=True))  # as in the table beside
_NOWHERE = np.zeros((STEPS - 1, 2, 3))
# [m] in the world, from the middle of an arc to its number: apart, and off the arm.
_BESIDE = np.array(
    [
        (0.0, -0.05, 0.04),
        (0.0, -0.02, 0.15),
        (0.0, 0.20, 0.03),
        (0.0, 0.20, -0.03),
        (0.0, 0.14, -0.12),
        (0.0, -0.14, -0.12),
    ]
)


class ArcsView:
    """Draws the arcs of the first arm that is followed, while ``wanted``."""

    def __init__(self, scene: viser.SceneApi, name: str = "/arcs") -> None:
        self.wanted = False
        self._placing = Placing()
        self._drawn: object = None
        self._root = scene.add_frame(name, show_axes=False, visible=False)
        self._lines = scene.add_line_segments(
            f"{name}/lines",
            np.tile(_NOWHERE, (len(NAMES), 1, 1)),
            colors=_colors(),
            thickness=0.012,
            thickness_units="world",
        )
        self._labels = {
            arc: scene.add_label(f"{name}/{arc}", "", anchor="center-center", font_screen_scale=0.9)
            for arc in NAMES
        }

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        placement = self._placing.of(now)
        self._root.visible = self.wanted and placement is not None
        state = (now.skeleton, now.choices)
        if not self._root.visible or now.skeleton is None or state == self._drawn:
            return
        self._drawn = state
        arcs = {arc.name: arc for arc in arm_arcs(now.skeleton, persons_side(now))}
        lines = {name: _segments(arc) for name, arc in arcs.items()}
        points = np.concatenate([lines.get(name, _NOWHERE) for name in NAMES])
        outward = (1.0, 1.0 if persons_side(now) == "left" else -1.0, 1.0)
        if placement is not None:
            self._lines.points = placement.place(points).astype(np.float32)
            for (name, label), beside in zip(self._labels.items(), _BESIDE, strict=True):
                label.visible = name in arcs
                if name in arcs:
                    label.text = number(arcs[name])
                    label.position = placement.place(arcs[name].middle) + outward * beside


def persons_side(now: Snapshot) -> Side:
    """Return which of the person's arms is drawn: the one that Baxter's first arm follows."""
    first = sides_of(now.choices.arms)[0]
    return other_side(first) if now.choices.mirrored else first


def number(arc: Arc) -> str:
    """Return an arc's number in the table, and its angle."""
    return f"{NUMBERS[arc.name]} {math.degrees(arc.angle):.0f}°"


def _segments(arc: Arc) -> FloatArray:
    """Return the lines (STEPS - 1, 2, 3) [m] along an arc."""
    return np.stack([arc.points[:-1], arc.points[1:]], axis=1)


def _colors() -> FloatArray:
    """Return the color of both ends of each line (6 (STEPS - 1), 2, 3)."""
    each = np.repeat(np.array(ARCS, np.uint8), STEPS - 1, axis=0)
    return np.stack([each, each], axis=1)
