"""A page of its own that replays what Baxter did alone: one file, no server, no network.

It holds the 3D view, and viser's player below it. Baxter's meshes are most of it, so their
maker's license goes with them.
"""

import contextlib
import io
from pathlib import Path

import numpy as np
import viser

from studio.engine.arms import sides_of
from studio.engine.demonstration import Demonstration
from studio.engine.errors import StudioError
from studio.engine.export.files import write_bytes
from studio.engine.export.kind import Job, Kind, lacks_reproduction
from studio.engine.export.material import Material
from studio.engine.measures import hand_path
from studio.engine.moment import demonstration_at
from studio.engine.resources import notice_path
from studio.engine.robot import BASE_HEIGHT, CONTROL_PERIOD
from studio.engine.skeleton import FloatArray, Side
from studio.engine.teaching import Lesson, Reproduction
from studio.panels.meshes import FINE
from studio.panels.palette import GHOST, ROBOT, Color
from studio.panels.robot_view import GhostView, RobotView
from studio.panels.stage import Furniture, set_the_stage
from studio.panels.trails import segments

FILE = "replay.html"
PAUSE = 1.0  # [s] at the end, before it begins anew
_WORLD_BASE = np.array([0.0, 0.0, BASE_HEIGHT])  # [m] the robot's base in the world
_MESHES_READ = 0.3  # share of the work


def replay_page(
    lesson: Lesson, reproduction: Reproduction, ghost: Demonstration, job: Job, detail: float = FINE
) -> bytes:
    """Return a page that shows the reproduction, a demonstration's ghost, and both hands' paths.

    Parameters
    ----------
    lesson : what was learned, for its name
    reproduction : what Baxter did alone
    ghost : the demonstration that goes along, at equal shares of its own duration
    job : is told how far it is; its folder is not used
    detail : how fine Baxter is drawn [m]

    Raises
    ------
    StudioError
        Where there is no port on this machine to build it at.
    StoppedError
        Where the job was stopped.
    """
    job.done(0.0)
    with contextlib.redirect_stdout(io.StringIO()):  # viser's banner
        try:
            server = viser.ViserServer("127.0.0.1", 0, label="Replay", verbose=False)
        except OSError as error:
            raise StudioError(f"no port is free on this machine: {error.strerror}") from error
    try:
        stage = _Stage(server, lesson, reproduction, ghost, detail)
        job.done(_MESHES_READ)
        return stage.recorded(job.part(_MESHES_READ, 1.0))
    finally:
        with contextlib.redirect_stdout(io.StringIO()):
            server.stop()


def write(material: Material, job: Job) -> tuple[Path, ...]:
    """Write the page, with the first demonstration that was learned from as the ghost."""
    path = job.folder / FILE
    lesson, reproduction = material.lesson, material.reproduction
    if lesson is not None and reproduction is not None:
        ghost = lesson.taught.demonstrations[0]
        write_bytes(path, replay_page(lesson, reproduction, ghost, job))
    return (path,)


REPLAY = Kind("replay", "the 3D view as a page of its own", (FILE,), lacks_reproduction, write)


def with_notice(page: str) -> str:
    """Return a page that says in its source whose meshes it embeds, under a title of our own."""
    notice = notice_path().read_text(encoding="utf-8").replace("--", "- -")  # ends no comment
    titled = page.replace("<title>Viser</title>", "<title>Baxter does it alone</title>", 1)
    return titled.replace("<head>", f"<head>\n<!--\n{notice}-->", 1)


class _Stage:
    """The scene of a replay, on a server that nobody sees."""

    def __init__(
        self,
        server: viser.ViserServer,
        lesson: Lesson,
        reproduction: Reproduction,
        ghost: Demonstration,
        detail: float,
    ) -> None:
        self._server, self._shown, self._ghost = server, reproduction.performance, ghost
        self._scene = lesson.taught.scene
        set_the_stage(server)
        self._robot = RobotView(server.scene, detail)
        self._ghosts: dict[Side, GhostView] = {
            side: GhostView(server.scene, f"/ghost_{side}") for side in sides_of(ghost.arms)
        }
        self._furniture = Furniture(server.scene)
        joints = np.array([tick.world.joint_positions for tick in self._shown.ticks])
        self._trail("/alone", joints, ROBOT, 0.008)
        shown = np.stack([demonstration_at(ghost, time).joints for time in ghost.times.tolist()])
        self._trail("/demonstration", shown, GHOST, 0.004)
        title = f"{lesson.settings.name}, {lesson.settings.neurons} neurons"
        server.scene.add_label("/title", f"{title}; ghost: {ghost.name}", position=(0.0, 0.0, 2.1))

    def recorded(self, job: Job) -> bytes:
        """Return the page of all ticks."""
        ticks = self._shown.ticks
        self._draw(0)
        serializer = self._server.get_scene_serializer()
        for number in range(1, len(ticks)):
            serializer.insert_sleep(CONTROL_PERIOD)
            self._draw(number)
            job.done(number / len(ticks))
        serializer.insert_sleep(PAUSE)
        return with_notice(serializer.as_html()).encode()

    def _draw(self, number: int) -> None:
        tick = self._shown.ticks[number]
        self._robot.draw(tick.world.joint_positions, tick.world.fingers)
        self._furniture.draw(self._scene, tick.world.block_poses)
        share = min(max(tick.time, 0.0) / self._shown.duration, 1.0)
        body = demonstration_at(self._ghost, share * self._ghost.duration).joints
        for side, ghost in self._ghosts.items():
            ghost.draw(body, side)

    def _trail(self, name: str, joints: FloatArray, color: Color, thickness: float) -> None:
        """Draw the path of each taught hand."""
        paths = [hand_path(joints, side) + _WORLD_BASE for side in sides_of(self._shown.arms)]
        self._server.scene.add_line_segments(
            name,
            np.concatenate([segments(path) for path in paths]),
            colors=color,
            thickness=thickness,
            thickness_units="world",
        )
