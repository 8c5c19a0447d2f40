"""The scene, as an option of the commands that teach."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import tyro

from studio.engine.experiment import scene_of_recordings
from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene

SceneFlag = Annotated[
    str,
    tyro.conf.arg(
        metavar="NAME|FILE",
        help="What stands around Baxter, and what is to be done: push-down (the paper's), "
        "push-into-zone, two-in-order, pick-and-place, both-arms, or a TOML file of your own. Arms "
        "and gripper are as it takes them; a recording made in another scene is followed anew.",
    ),
]
TaughtSceneFlag = Annotated[
    str | None,
    tyro.conf.arg(
        metavar="NAME|FILE",
        help="What stands around Baxter, and what is to be done: push-down (the paper's), "
        "push-into-zone, two-in-order, pick-and-place, both-arms, or a TOML file of your own; by "
        "default the scene of the first recording, push-down where there is none. Arms and gripper "
        "are as it takes them; a recording made in another scene is followed anew.",
    ),
]


def taught_scene(asked: str | None, paths: Sequence[Path]) -> Scene:
    """Return the scene that is asked for, or else that of the first recording.

    Raises
    ------
    FileError
        Where there is no such scene, or the recording cannot be read.
    """
    return scene_of_recordings(paths) if asked is None else read_scene(asked)
