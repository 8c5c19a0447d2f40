"""The choice of a scene: what is to be done, and what is missing yet."""

from dataclasses import replace

import pytest

from studio.engine import commands
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.snapshot import Mode
from studio.panels.scene_choice import SceneChoice, described
from tests.panels.controls import Gui


def in_scene(now, name: str, **world):
    scene = read_scene(name)
    return replace(
        now,
        choices=now.choices.in_scene(scene),
        scene=scene,
        world=replace(now.world, **{"done": False, "touched": False, **world}),
    )


def test_all_scenes_that_ship_can_be_chosen(lesson) -> None:
    gui, posted = Gui(), []
    choice = SceneChoice(gui, posted.append)
    choice.draw(lesson["played"])
    assert gui["Scene"].options == scene_names()
    assert gui["Scene"].value == "push-down"
    gui["Scene"].press("two-in-order")
    assert posted == [commands.ChooseScene("two-in-order")]


def test_a_scene_of_ones_own_joins_them_while_it_is_chosen(lesson) -> None:
    gui = Gui()
    choice = SceneChoice(gui, lambda _: None)
    now = lesson["played"]
    own = replace(now.choices.scene, name="mine")
    choice.draw(replace(now, choices=now.choices.in_scene(own)))
    assert (gui["Scene"].options, gui["Scene"].value) == ((*scene_names(), "mine"), "mine")
    choice.draw(now)
    assert (gui["Scene"].options, gui["Scene"].value) == (scene_names(), "push-down")


def test_while_somebody_teaches_it_stays(lesson) -> None:
    gui = Gui()
    choice = SceneChoice(gui, lambda _: None)
    choice.draw(replace(lesson["played"], mode=Mode.RECORDING))
    assert gui["Scene"].disabled
    assert "Stop first" in gui.words


@pytest.mark.parametrize("name", scene_names())
def test_it_says_what_is_to_be_done(lesson, name: str) -> None:
    words = described(in_scene(lesson["played"], name)).replace("&#x27;", "'")
    assert read_scene(name).words in words
    assert ("both arms" in words) == (name == "both-arms")
    assert ("gripper" in words) == (name == "pick-and-place")


def test_it_says_what_is_missing_once_the_arm_has_touched_a_block(lesson) -> None:
    missing = "the box is 3 cm outside the zone"
    now = lesson["played"]
    before = in_scene(now, "push-into-zone", missing=missing)
    touched = in_scene(now, "push-into-zone", missing=missing, touched=True)
    done = in_scene(now, "push-into-zone", done=True, touched=True)
    assert missing not in described(before)
    assert missing in described(touched)
    assert "✔ The task is done." in described(done)
