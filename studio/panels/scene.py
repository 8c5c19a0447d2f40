"""The 3D view: Baxter, desk and blocks, the person beside it, the ghost and the hand's path."""

import math
import threading

import numpy as np
import viser

from studio.engine.arms import Arms, sides_of
from studio.engine.measures import hand_path
from studio.engine.robot import BASE_HEIGHT
from studio.engine.skeleton import SIDES, FloatArray, Side
from studio.engine.snapshot import Snapshot
from studio.engine.world import Scene
from studio.panels.palette import ROBOT
from studio.panels.person import PersonView
from studio.panels.poses import w_first
from studio.panels.robot_view import GhostView, RobotView

_BLOCK_COLORS = ((244, 180, 40), (120, 150, 175), (150, 165, 120))
WORLD_BASE = np.array([0.0, 0.0, BASE_HEIGHT])  # [m] the robot's base in the world
_DESK_COLOR, _LEG = (188, 160, 128), 0.05  # [m]
_SKY, _GROUND = (238, 241, 245), (190, 201, 211)


class SceneView:
    """Everything in the 3D view; Baxter's meshes come a little later, from their own thread."""

    def __init__(self, server: viser.ViserServer, detail: float) -> None:
        self._scene, self._detail = server.scene, detail
        self._robot: RobotView | None = None
        self._ghosts: dict[Side, GhostView] = {}
        self._furnished: Arms | None = None
        self._blocks: list[viser.BoxHandle] = []
        self._traced: object = None
        self._path: viser.LineSegmentsHandle | None = None
        _set_the_stage(server)
        self._person = PersonView(self._scene)
        self._loading = threading.Thread(target=self._load, name="meshes", daemon=True)
        self._loading.start()

    @property
    def lacks_meshes(self) -> bool:
        """Whether Baxter is drawn in simple shapes, since its meshes are missing."""
        return self._robot is not None and not self._robot.has_meshes

    def wait(self) -> None:
        """Wait until the meshes are there."""
        self._loading.join()

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        if now.choices.arms != self._furnished:
            self._furnish(now.choices.arms)
        for block, pose in zip(self._blocks, now.world.block_poses, strict=True):
            block.position, block.wxyz = pose[:3], w_first(pose[3:])
        if self._robot is not None:
            self._robot.draw(now.world.joint_positions, now.world.fingers)
        shown = sides_of(_ghost_arms(now))
        for side, ghost in self._ghosts.items():
            ghost.draw(now.ghost if side in shown else None, side)
        self._person.draw(now)
        self._trace(now)

    def _load(self) -> None:
        self._robot = RobotView(self._scene, self._detail)
        self._ghosts = {side: GhostView(self._scene, f"/ghost_{side}") for side in SIDES}

    def _furnish(self, arms: Arms) -> None:
        """Put up the desk and the blocks for what is taught."""
        self._furnished = arms
        scene = Scene(arms=arms)
        (x, y, z), (length, width, thick) = scene.placed_desk.position, scene.placed_desk.size
        self._scene.add_box(
            "/desk", color=_DESK_COLOR, dimensions=(length, width, thick), position=(x, y, z)
        )
        height = z - thick / 2
        for name, dx, dy in (("a", 1, 1), ("b", 1, -1), ("c", -1, 1), ("d", -1, -1)):
            at = (x + dx * (length - _LEG) / 2, y + dy * (width - _LEG) / 2, height / 2)
            self._scene.add_box(
                f"/desk/leg_{name}",
                color=_DESK_COLOR,
                dimensions=(_LEG, _LEG, height),
                position=(at[0] - x, at[1] - y, at[2] - z),
            )
        self._blocks = [
            self._scene.add_box(
                f"/blocks/{number}",
                color=_BLOCK_COLORS[number % len(_BLOCK_COLORS)],
                dimensions=block.size,
                position=block.position,
            )
            for number, block in enumerate(scene.placed_blocks)
        ]

    def _trace(self, now: Snapshot) -> None:
        """Leave the path of the hand after the robot has done it alone."""
        if now.reproduction is self._traced:
            return
        self._traced = now.reproduction
        if self._path is not None:
            self._path.remove()
            self._path = None
        if now.reproduction is not None:
            alone = now.reproduction.performance
            measured = alone.measured_at(np.linspace(0.0, alone.duration, 142))
            paths = [_segments(hand_path(measured, side)) for side in sides_of(alone.arms)]
            self._path = self._scene.add_line_segments(
                "/hand_path",
                np.concatenate(paths) + WORLD_BASE,
                colors=ROBOT,
                thickness=0.008,
                thickness_units="world",
            )


def _set_the_stage(server: viser.ViserServer) -> None:
    """Set camera, light, backdrop and floor."""
    camera = server.initial_camera
    camera.position, camera.look_at = (3.6, 0.75, 1.95), (0.25, -0.34, 0.84)
    camera.fov = math.radians(43.0)
    scene = server.scene
    scene.configure_environment_map("studio", environment_intensity=0.25)
    backdrop = np.linspace(_SKY, _GROUND, 64).astype(np.uint8)[:, None, :]
    scene.set_background_image(np.repeat(backdrop, 4, axis=1), format="png")
    scene.add_grid("/floor", width=10.0, height=10.0, shadow_opacity=0.25)


def _ghost_arms(now: Snapshot) -> Arms:
    return now.entries[now.chosen].demonstration.arms if now.entries else now.choices.arms


def _segments(points: FloatArray) -> FloatArray:
    """Return the lines (N - 1, 2, 3) that join points (N, 3) one after the other."""
    return np.stack([points[:-1], points[1:]], axis=1)
