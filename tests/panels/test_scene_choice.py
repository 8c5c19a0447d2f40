"""The choice of a scene: what is to be done, and what is missing yet."""

from dataclasses import replace

import pytest

from studio.engine import commands
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.snapshot import Mode
from studio.panels.card import pictured
from studio.panels.cards import line
from studio.panels.readiness import fitting, why_not_train
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


def test_a_scene_of_the_same_name_is_told_apart_everywhere(lesson) -> None:
    gui, now = Gui(), lesson["trained"]
    usual = now.choices.scene
    other = replace(usual, desk=replace(usual.desk, friction=0.5))
    name = "push-down (another one)"
    elsewhere = replace(now, choices=now.choices.in_scene(other))
    SceneChoice(gui, lambda _: None).draw(elsewhere)
    assert (gui["Scene"].options, gui["Scene"].value) == ((*scene_names(), name), name)
    assert fitting(now)
    assert not fitting(elsewhere)
    assert f"in the scene {name}" in why_not_train(elsewhere)
    entry = now.entries[0]
    assert line(entry, usual) == line(entry)
    assert line(entry, other) == f"{line(entry)} · of {name}"
    shown = replace(entry.demonstration, scene=other)
    assert f"scene {name}" in pictured(replace(entry, demonstration=shown))
    assert "scene" not in pictured(entry)


def test_what_is_missing_is_told_of_the_chosen_scene_wherever_its_blocks_were_put(lesson) -> None:
    now = in_scene(lesson["played"], "push-into-zone", touched=True, missing="the box still moves")
    moved = replace(now, scene=now.scene.with_block_at(0.8, 0.35))
    assert "Not done yet: the box still moves." in described(moved)
    rough = replace(now.scene, desk=replace(now.scene.desk, friction=0.5))
    assert "Not done yet" not in described(replace(now, scene=rough))
