"""The 3D view: Baxter, desk and blocks, the person beside it, and what is compared."""

import threading
from functools import partial

import numpy as np
import viser

from studio.engine import commands
from studio.engine.arms import Arms, sides_of
from studio.engine.robot import BASE_HEIGHT
from studio.engine.skeleton import SIDES, FloatArray, Side
from studio.engine.snapshot import Snapshot
from studio.panels.dragging import Drag, over
from studio.panels.field_board import FieldBoard
from studio.panels.inputs import Post
from studio.panels.person import PersonView
from studio.panels.robot_view import GhostView, RobotView
from studio.panels.second import ROOT, SecondRobot
from studio.panels.stage import Furniture, set_the_backdrop, set_the_stage
from studio.panels.trails import Trails
from studio.panels.viewpoint import Viewpoint

_UP = np.array([0.0, 0.0, 1.0])
_BASE = (0.0, 0.0, BASE_HEIGHT)  # [m] the robot's base in the world


class SceneView:
    """Everything in the 3D view; Baxter's meshes come a little later, from their own thread."""

    def __init__(
        self, server: viser.ViserServer, detail: float, post: Post = lambda _: None
    ) -> None:
        self._scene, self._detail, self._post = server.scene, detail, post
        self._robot: RobotView | None = None
        self._ghosts: dict[Side, GhostView] = {}
        self._furniture = Furniture(self._scene)
        self._is_dark = False
        self._drags: dict[int, Drag] = {}  # of the task's blocks, by their numbers
        self._dragged: list[viser.BoxHandle] = []  # the blocks among which they are
        set_the_stage(server)
        self._person = PersonView(self._scene)
        self._second = SecondRobot(self._scene, detail)
        roots = ("/trails", f"{ROOT}/trails")
        for root in roots:
            self._scene.add_frame(root, show_axes=False, position=_BASE)
        self._trails = Trails(self._scene, roots)
        self._board = FieldBoard(self._scene, post)
        self._viewpoint = Viewpoint(server)
        self._loading = threading.Thread(target=self._load, name="meshes", daemon=True)
        self._loading.start()

    @property
    def lacks_meshes(self) -> bool:
        """Whether Baxter is drawn in simple shapes, since its meshes are missing."""
        return self._robot is not None and not self._robot.has_meshes

    def wait(self, seconds: float | None = None) -> None:
        """Wait until the meshes are there, or for so long [s]."""
        self._loading.join(seconds)
        self._second.wait()

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._draw_blocks(now)
        if self._robot is not None:
            self._robot.draw(now.world.joint_positions, now.world.fingers)
        shown = sides_of(_ghost_arms(now))
        for side, ghost in self._ghosts.items():
            ghost.draw(now.ghost if side in shown else None, side)
        self._person.draw(now)
        self._second.draw(now)
        self._trails.draw(now)
        self._board.draw(now)
        self._viewpoint.draw(now)

    def shade(self, is_dark: bool) -> None:
        """Be in the dark, as the rest of the page, or in the light."""
        if is_dark != self._is_dark:
            set_the_backdrop(self._scene, is_dark)
            self._person.shade(is_dark)
            self._is_dark = is_dark

    def _load(self) -> None:
        self._robot = RobotView(self._scene, self._detail)
        self._ghosts = {side: GhostView(self._scene, f"/ghost_{side}") for side in SIDES}

    def _draw_blocks(self, now: Snapshot) -> None:
        """Draw the blocks where they are; those of the task follow whoever drags them."""
        poses = now.world.block_poses
        self._furniture.draw(now.scene, poses)
        blocks = self._furniture.blocks
        if self._dragged is not blocks:
            self._dragged = blocks
            self._drags = {
                number: Drag(blocks[number], {None: over(_UP)}, partial(self._place_block, number))
                for number in now.scene.task_blocks
            }
        for number, drag in self._drags.items():
            drag.draw(poses[number, :3])

    def _place_block(self, number: int, point: FloatArray, is_let_go: bool) -> None:
        if is_let_go:
            self._post(commands.PlaceBlock(float(point[0]), float(point[1]), number))


def _ghost_arms(now: Snapshot) -> Arms:
    return now.entries[now.chosen].demonstration.arms if now.entries else now.choices.arms
