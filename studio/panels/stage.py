"""What stands around the robot in the 3D view: camera, light and floor, the desk and its blocks."""

import math

import numpy as np
import viser

from studio.engine.skeleton import FloatArray
from studio.engine.world import Scene
from studio.panels.poses import w_first
from studio.panels.viewpoint import ALONE
from studio.panels.zones import draw_zones

_BLOCK_COLORS = ((244, 180, 40), (120, 150, 175), (150, 165, 120))
_DESK_COLOR, _LEG = (188, 160, 128), 0.05  # [m]
STILL = 1e-5  # [m] what moved less is not drawn anew
_SKY, _GROUND = (238, 241, 245), (190, 201, 211)
_SKY_IN_THE_DARK, _GROUND_IN_THE_DARK = (62, 68, 77), (36, 40, 46)
_TILES, _TILES_IN_THE_DARK = (140, 140, 140), (84, 92, 102)  # the lines between them
_CELLS, _CELLS_IN_THE_DARK = (200, 200, 200), (64, 70, 78)  # the finer ones
_LAMP = (3.0, -1.0, 2.0)  # [m] before Baxter, and to its right


class Furniture:
    """The desk, its zones and the blocks of a scene, under ``root`` in the tree."""

    def __init__(self, scene: viser.SceneApi, root: str = "") -> None:
        self._scene, self._root = scene, root
        self._look: object = None  # all of a scene that is drawn here, but where its blocks are
        self.blocks: list[viser.BoxHandle] = []  # as the scene lists them; others in another scene
        self._zones: list[viser.SceneNodeHandle] = []
        self._drawn = np.zeros((0, 7))  # poses

    def draw(self, placed: Scene, poses: FloatArray) -> None:
        """Put the blocks where poses (B, 7), x y z [m] qx qy qz qw, have them."""
        sizes = tuple(block.size for block in placed.blocks)
        look = (placed.placed_desk, placed.placed_zones, sizes)
        if look != self._look:
            self._look = look
            self._furnish(placed)
        for block, before, pose in zip(self.blocks, self._drawn, poses, strict=True):
            if np.abs(pose - before).max() > STILL:
                block.position, block.wxyz = pose[:3], w_first(pose[3:])
                before[:] = pose

    def _furnish(self, placed: Scene) -> None:
        scene, root = self._scene, self._root
        for node in (*self._zones[::-1], *self.blocks):
            node.remove()
        (x, y, z), (length, width, thick) = placed.placed_desk.position, placed.placed_desk.size
        scene.add_box(
            f"{root}/desk", color=_DESK_COLOR, dimensions=(length, width, thick), position=(x, y, z)
        )
        height = z - thick / 2
        for name, dx, dy in (("a", 1, 1), ("b", 1, -1), ("c", -1, 1), ("d", -1, -1)):
            scene.add_box(
                f"{root}/desk/leg_{name}",
                color=_DESK_COLOR,
                dimensions=(_LEG, _LEG, height),
                position=(dx * (length - _LEG) / 2, dy * (width - _LEG) / 2, height / 2 - z),
            )
        self.blocks = [
            scene.add_box(
                f"{root}/blocks/{number}",
                color=_BLOCK_COLORS[number % len(_BLOCK_COLORS)],
                dimensions=block.size,
                position=block.position,
            )
            for number, block in enumerate(placed.placed_blocks)
        ]
        self._zones = draw_zones(scene, placed, root)
        self._drawn = np.full((len(self.blocks), 7), np.inf)


def set_the_stage(server: viser.ViserServer) -> None:
    """Set camera, light, backdrop and floor."""
    camera = server.initial_camera
    camera.position, camera.look_at = ALONE.position, ALONE.look_at
    camera.fov = math.radians(43.0)
    scene = server.scene
    # No environment map: without a graphics card it takes seconds to work out, and viser draws
    # nothing to be seen before it is.
    scene.configure_environment_map(None)
    scene.add_light_hemisphere("/sky", ground_color=_GROUND, intensity=1.9)
    scene.add_light_directional("/lamp", position=_LAMP, intensity=1.2)
    set_the_backdrop(scene)


def set_the_backdrop(scene: viser.SceneApi, is_dark: bool = False) -> None:
    """Set what is behind and below all, for a light page or a dark one."""
    ends = (_SKY_IN_THE_DARK, _GROUND_IN_THE_DARK) if is_dark else (_SKY, _GROUND)
    backdrop = np.linspace(*ends, 64).astype(np.uint8)[:, None, :]
    scene.set_background_image(np.repeat(backdrop, 4, axis=1), format="png")
    tiles, cells = (_TILES_IN_THE_DARK, _CELLS_IN_THE_DARK) if is_dark else (_TILES, _CELLS)
    scene.add_grid(
        "/floor",
        width=10.0,
        height=10.0,
        section_color=tiles,
        cell_color=cells,
        shadow_opacity=0.25,
    )
