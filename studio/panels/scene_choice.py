"""What stands around Baxter, and what is to be done with it: the choice, and how it stands."""

import viser

from studio.engine import commands
from studio.engine.scene_file import scene_names
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
            shipped = scene_names()
            names = shipped if scene.name in shipped else (*shipped, scene.name)
            if self._choice.options != names:
                self._choice.options = names
            show_value(self._choice, scene.name)
        self._choice.disabled = bool(refusal)
        self._words.content = described(now) + markup.reasons([refusal] if refusal else [])


def described(now: Snapshot) -> str:
    """Return what there is to do, and what is missing for it, as HTML."""
    scene = now.choices.scene
    takes = [
        *(["both arms"] if scene.both_arms else []),
        *(["the gripper, worked by your right hand"] if scene.gripper else []),
    ]
    needed = f" It takes {' and '.join(takes)}." if takes else ""
    words = markup.note(f"{scene.words}{needed}")
    if now.scene.name != scene.name:
        return words
    task = task_words(scene)
    missing = "" if now.world.done else now.world.missing
    if not missing or not now.world.touched:
        return words + (markup.note(f"✔ {task.sentence[0]}") if now.world.done else "")
    return words + markup.note(f"Not done yet: {missing}.")
