"""The second robot, B, beside the first: its own desk and blocks, but the same playhead."""

import threading

import viser

from studio.engine.snapshot import Snapshot
from studio.panels.robot_view import RobotView
from studio.panels.stage import Furniture

ROOT = "/b"
ASIDE = 1.8  # [m] to the left of the first one,
FURTHER = 3.4  # where a board stands between them
ABOVE = (0.0, 0.0, 2.0)  # [m] the letters


class SecondRobot:
    """See the module; its meshes come when it is first needed, from a thread of their own."""

    def __init__(self, scene: viser.SceneApi, detail: float) -> None:
        self._scene, self._detail = scene, detail
        self._root = scene.add_frame(ROOT, show_axes=False, visible=False)
        self._letters = [
            scene.add_label(f"{root}/letter", letter, position=ABOVE, visible=False)
            for root, letter in (("", "A"), (ROOT, "B"))
        ]
        self._robot: RobotView | None = None
        self._furniture = Furniture(scene, ROOT)
        self._loading: threading.Thread | None = None

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        world, is_there = now.compare.beside, now.compare.beside is not None
        self._root.visible = is_there
        for letter in self._letters:
            letter.visible = is_there
        if world is None:
            return
        self._load()
        self._root.position = (0.0, FURTHER if now.compare.field is not None else ASIDE, 0.0)
        self._furniture.draw(now.scene, world.block_poses)
        if self._robot is not None:
            self._robot.draw(world.joint_positions, world.fingers)

    def wait(self) -> None:
        """Wait until its meshes are there, if they were asked for."""
        if self._loading is not None:
            self._loading.join()

    def _load(self) -> None:
        if self._loading is None:
            self._loading = threading.Thread(target=self._make, name="meshes of B", daemon=True)
            self._loading.start()

    def _make(self) -> None:
        self._robot = RobotView(self._scene, self._detail, f"{ROOT}/robot")
