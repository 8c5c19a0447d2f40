"""The zones in which blocks are to end: flat, translucent, with an outline, on the desk."""

import itertools

import numpy as np
import viser

from studio.engine.scene import Scene, Zone
from studio.engine.skeleton import FloatArray

_FILL, _OPACITY = (30, 160, 110), 0.45  # seen on wood, in light pages and in dark ones
_LINE, _THICK = (10, 95, 65), 0.006  # [m]
_HIGH = 0.002  # [m] a plate is, so that it does not flicker with the desk


def draw_zones(scene: viser.SceneApi, placed: Scene, root: str) -> list[viser.SceneNodeHandle]:
    """Draw all zones of a scene under ``root`` in the tree; return what was drawn."""
    drawn: list[viser.SceneNodeHandle] = []
    for number, zone in enumerate(placed.placed_zones):
        x, y = zone.center
        drawn.append(
            scene.add_box(
                f"{root}/zones/{number}",
                color=_FILL,
                dimensions=(*zone.size, _HIGH),
                opacity=_OPACITY,
                cast_shadow=False,
                position=(x, y, placed.placed_desk.top + _HIGH / 2),
            )
        )
        drawn.append(
            scene.add_line_segments(
                f"{root}/zones/{number}/outline",
                outline(zone),
                colors=_LINE,
                thickness=_THICK,
                position=(0.0, 0.0, _HIGH / 2),
            )
        )
    return drawn


def outline(zone: Zone) -> FloatArray:
    """Return the four edges (4, 2, 3) [m] of a zone around its center."""
    half = np.array([*zone.size, 0.0]) / 2
    corners = [half * (i, j, 0.0) for i, j in ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))]
    return np.array(list(itertools.pairwise(corners)))
