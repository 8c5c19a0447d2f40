"""A film: a demonstration's replay beside what Baxter does alone, as WebM that browsers play.

Pictures come from pybullet's own renderer, which needs no graphics card, and VP9 from OpenCV,
whose wheel brings it. A second of film takes 3 to 4 s of one core, and 85 kB.
"""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from studio.engine.arms import sides_of
from studio.engine.camera import Camera
from studio.engine.demonstration import Demonstration
from studio.engine.errors import FileError
from studio.engine.export.kind import Job
from studio.engine.export.material import Material
from studio.engine.measures import hand_path
from studio.engine.performance import Performance, perform
from studio.engine.robot import BASE_HEIGHT, CONTROL_RATE
from studio.engine.scene import USUAL, Scene
from studio.engine.silence import STDERR, silenced
from studio.engine.skeleton import FloatArray
from studio.engine.task_words import task_words
from studio.engine.teaching import Lesson
from studio.engine.world import World

FILE = "video.webm"
FRAME_RATE = 15  # [Hz], every second tick
_TICKS = CONTROL_RATE // FRAME_RATE
_CODEC = cv2.VideoWriter.fourcc(*"VP90")
_INK, _PAPER, _TRAIL = (40, 40, 40), (255, 255, 255), (190, 100, 20)  # blue, green, red
_FONT, _SCALE = cv2.FONT_HERSHEY_SIMPLEX, 0.5
_REPLAYED = 0.1  # share of the work that the demonstration's replay takes

Picture = NDArray[np.uint8]  # (height, width, 3) blue, green, red, as OpenCV has it


@dataclass(frozen=True, eq=False)
class Side:
    """One half of the film."""

    title: str
    performance: Performance
    trail: FloatArray  # (N, A, 3) [m] where the hands of A arms were, tick by tick
    scene: Scene  # for the arms that are taught

    @classmethod
    def of(cls, title: str, performance: Performance, scene: Scene | None = None) -> "Side":
        """Return the half that shows a performance, in the usual scene unless given one."""
        joints = np.array([tick.world.joint_positions for tick in performance.ticks])
        paths = [hand_path(joints, side) for side in sides_of(performance.arms)]
        trail = np.stack(paths, axis=1) + np.array([0.0, 0.0, BASE_HEIGHT])
        return cls(title, performance, trail, (scene or USUAL).taught_by(performance.arms))


def write(material: Material, job: Job) -> tuple[Path, ...]:
    """Film the reproduction beside the first demonstration that it was learned from."""
    path = job.folder / FILE
    lesson, reproduction = material.lesson, material.reproduction
    if lesson is not None and reproduction is not None:
        job.done(0.0)
        shown = lesson.taught.demonstrations[0]
        sides = (
            Side.of(f"Demonstration: {shown.name}", _replay(shown), shown.scene),
            Side.of(f"Alone: {_learner(lesson)}", reproduction.performance, shown.scene),
        )
        write_film(path, sides, job.part(_REPLAYED, 1.0))
    return (path,)


def write_film(path: Path, sides: tuple[Side, ...], job: Job, camera: Camera | None = None) -> int:
    """Write a film of performances side by side, on one clock; return how many frames it has.

    The shorter ones stand still in the end.

    Raises
    ------
    FileError
        Where the file cannot be written, or OpenCV here has no VP9.
    StoppedError
        Where the job was stopped; there is no file then.
    """
    seen_by = camera or _camera_for(sides[0].performance)
    width, height = seen_by.size
    count = max(len(side.performance.ticks) for side in sides)
    moments = range(0, count, _TICKS)
    # The name must end in .webm, for OpenCV tells the format by it.
    with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
        unfinished = Path(scratch, FILE)
        with silenced(STDERR):  # the tag of VP9 is not WebM's, which it says and cures by itself
            film = cv2.VideoWriter(
                str(unfinished), _CODEC, FRAME_RATE, (width * len(sides), height)
            )
        if not film.isOpened():
            raise FileError(
                f"{path}: OpenCV cannot write VP9 here: pip install --force-reinstall "
                "opencv-python-headless"
            )
        try:
            for number, frame in enumerate(_frames(sides, moments, seen_by), start=1):
                film.write(frame)
                job.done(number / len(moments))
        finally:
            film.release()
        unfinished.replace(path)
    return len(moments)


def _frames(sides: tuple[Side, ...], moments: range, camera: Camera) -> Iterator[Picture]:
    """Yield the film's pictures; one world shows all sides, one after the other."""
    fingers = bool(len(sides[0].performance.ticks[0].world.fingers))
    with World(sides[0].scene, fingers=fingers, looks=True) as world:
        for tick in moments:
            yield np.hstack([_half(world, camera, side, tick) for side in sides])


def _half(world: World, camera: Camera, side: Side, tick: int) -> Picture:
    last = len(side.performance.ticks) - 1
    shown = side.performance.ticks[min(tick, last)]
    world.show(shown.world)
    picture = np.ascontiguousarray(world.picture(camera)[:, :, ::-1])
    for path in side.trail[: min(tick, last) + 1].swapaxes(0, 1):
        line = np.round(camera.pixels(path)).astype(np.int32)
        cv2.polylines(picture, [line], False, _TRAIL, 2, cv2.LINE_AA)
    down = task_words(side.scene).state[not shown.world.done]
    _label(picture, side.title, 22)
    _label(picture, f"{max(shown.time, 0.0):4.1f} s   {down}", camera.size[1] - 12)
    return picture


def _label(picture: Picture, text: str, baseline: int) -> None:
    """Write a line; OpenCV's own letters are ASCII only, and fit any picture."""
    plain = text.encode("ascii", "replace").decode()
    (width, _), _ = cv2.getTextSize(plain, _FONT, _SCALE, 1)
    scale = _SCALE * min(1.0, (picture.shape[1] - 16) / max(width, 1))
    for color, thickness in ((_PAPER, 4), (_INK, 1)):
        cv2.putText(picture, plain, (8, baseline), _FONT, scale, color, thickness, cv2.LINE_AA)


def _camera_for(performance: Performance) -> Camera:
    """Return the usual camera, for the right arm alone from the other side."""
    camera = Camera()
    if performance.arms != "right":
        return camera
    (x, y, z), (tx, ty, tz) = camera.position, camera.target
    return Camera((x, -y, z), (tx, -ty, tz))


def _replay(shown: Demonstration) -> Performance:
    how = (shown.duration, shown.arms, shown.mapping, shown.hands, shown.scene)
    return perform(shown.trajectory(), *how)


def _learner(lesson: Lesson) -> str:
    return f"{lesson.settings.name}, {lesson.settings.neurons} neurons"
