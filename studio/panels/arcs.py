"""The six angles of the person's arms, drawn as arcs with their numbers, where the arms are."""

import math
from collections.abc import Sequence

import numpy as np
import viser

from studio.engine.arm_arcs import NAMES, STEPS, Arc, arm_arcs
from studio.engine.placement import Placement
from studio.engine.skeleton import SIDES, FloatArray, Side
from studio.engine.snapshot import Snapshot
from studio.panels.palette import ARCS
from studio.panels.placing import Placing

NUMBERS = dict(zip(NAMES, "①②③④⑤⑥", strict=True))  # as in the table beside
_NOWHERE = np.zeros((STEPS - 1, 2, 3))
# [m] in the world, from the middle of an arc to its number: apart, and off the left arm.
_BESIDE = np.array(
    [
        (0.0, 0.08, -0.06),
        (0.0, -0.02, 0.15),
        (0.0, 0.16, 0.09),
        (0.0, 0.22, 0.05),
        (0.0, 0.14, -0.12),
        (0.0, -0.14, -0.12),
    ]
)


class ArcsView:
    """Draws the arcs of the arms that are followed, while ``wanted``; nothing is sent else."""

    def __init__(self, scene: viser.SceneApi, name: str = "/arcs") -> None:
        self.wanted = False
        self._placing = Placing()
        self._drawn: object = None
        self._root = scene.add_frame(name, show_axes=False, visible=False)
        self._arms = {side: _ArmArcs(scene, f"{name}/{side}", side) for side in SIDES}

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        placement = self._placing.of(now)
        self._root.visible = self.wanted and placement is not None
        state = (now.skeleton, now.choices.persons_sides)
        if not self._root.visible or state == self._drawn:
            return
        self._drawn = state
        if now.skeleton is None or placement is None:
            return
        letters = letters_of(now.choices.persons_sides)
        for side, arm in self._arms.items():
            arm.root.visible = side in letters
            if side in letters:
                arm.draw(arm_arcs(now.skeleton, side), placement, letters[side])


class _ArmArcs:
    """The arcs of one arm: all lines as one node, whose size stays, and a label each."""

    def __init__(self, scene: viser.SceneApi, name: str, side: Side) -> None:
        outward = (1.0, 1.0 if side == "left" else -1.0, 1.0)
        self._beside = outward * _BESIDE
        self.root = scene.add_frame(name, show_axes=False, visible=False)
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

    def draw(self, arcs: Sequence[Arc], placement: Placement, letter: str) -> None:
        """Show the arcs that there are."""
        of_name = {arc.name: arc for arc in arcs}
        lines = [_segments(of_name[name]) if name in of_name else _NOWHERE for name in NAMES]
        placed = placement.place(np.stack(lines))
        self._lines.points = placed.reshape(-1, 2, 3).astype(np.float32)
        positions = placed[:, (STEPS - 1) // 2, 0] + self._beside
        for (name, label), position in zip(self._labels.items(), positions, strict=True):
            label.visible = name in of_name
            if name in of_name:
                label.text = letter + number(of_name[name])
                label.position = position


def letters_of(sides: Sequence[Side]) -> dict[Side, str]:
    """Return what stands before an arm's numbers: its letter, where there is another arm."""
    return {side: side[0].upper() if len(sides) > 1 else "" for side in sides}


def number(arc: Arc) -> str:
    """Return an arc's number in the table, and its angle."""
    return f"{NUMBERS[arc.name]} {math.degrees(arc.angle):.0f}°"


def _segments(arc: Arc) -> FloatArray:
    """Return the lines (STEPS - 1, 2, 3) [m] along an arc."""
    return np.stack([arc.points[:-1], arc.points[1:]], axis=1)


def _colors() -> FloatArray:
    """Return the color of both ends of each line (6 (STEPS - 1), 2, 3).

    The page takes colors of lines' ends for linear light, and those of its other things as screens
    do (IEC 61966-2-1): so here they are made linear, to be the same as in the table.
    """
    shown = np.array(ARCS) / 255.0
    linear = np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
    each = np.repeat(np.round(255.0 * linear).astype(np.uint8), STEPS - 1, axis=0)
    return np.stack([each, each], axis=1)
