"""What stands around Baxter, and what is to be done with it: the choice, and how it stands."""

from dataclasses import replace

import viser

from studio.engine import commands
from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.snapshot import Snapshot
from studio.engine.task_words import task_words
from studio.panels import markup
from studio.panels.inputs import Post, on_choice, show_value
from studio.panels.readiness import why_not_configure


class SceneChoice:
    """A dropdown of the scenes that ship; a user's own joins them while it is chosen."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._drawn: object = None
        self._choice = gui.add_dropdown(
            "Scene", scene_names(), hint="What stands around Baxter, and what it is to do"
        )
        self._words = gui.add_html("")
        on_choice(self._choice, lambda: post(commands.ChooseScene(self._choice.value)))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        scene, refusal = now.choices.scene, why_not_configure(now)
        if (scene, now.message.number) != self._drawn:
            self._drawn = scene, now.message.number
            names, name = scene_names(), listed_name(scene)
            names = names if name in names else (*names, name)
            if self._choice.options != names:
                self._choice.options = names
            show_value(self._choice, name)
        self._choice.disabled = bool(refusal)
        self._words.content = described(now) + markup.reasons([refusal] if refusal else [])


def listed_name(scene: Scene) -> str:
    """Return a scene's name on the list, told apart from that of one that ships."""
    shipped = scene.name in scene_names()
    return scene.name_beside(read_scene(scene.name)) if shipped else scene.name


def described(now: Snapshot) -> str:
    """Return what there is to do, and what is missing for it, as HTML."""
    scene = now.choices.scene
    takes = [
        *(["both arms"] if scene.both_arms else []),
        *(["the gripper, worked by your right hand"] if scene.gripper else []),
    ]
    needed = f" It takes {' and '.join(takes)}." if takes else ""
    words = markup.note(f"{scene.words}{needed}")
    if _but_for_places(now.scene) != _but_for_places(scene):
        return words
    task = task_words(scene)
    missing = "" if now.world.done else now.world.missing
    if not missing or not now.world.touched:
        return words + (markup.note(f"✔ {task.sentence[0]}") if now.world.done else "")
    return words + markup.note(f"Not done yet: {missing}.")


def _but_for_places(scene: Scene) -> Scene:
    """Return a scene for comparison with one whose blocks people have put elsewhere."""
    blocks = tuple(replace(block, position=(0.0, 0.0, 0.0)) for block in scene.blocks)
    return replace(scene.as_told, blocks=blocks)
