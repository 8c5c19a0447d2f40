"""How one says that a task is done."""

import pytest

from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.task_words import BLOCK, TASK, task_words


def test_only_the_papers_task_speaks_of_its_block() -> None:
    assert task_words(Scene()) is task_words(Scene(arms="right")) is BLOCK
    for name in scene_names()[1:]:
        assert task_words(read_scene(name)) is TASK


@pytest.mark.parametrize("words", [BLOCK, TASK])
def test_done_and_not_done_are_told_apart(words) -> None:
    for told in (words.told, words.judged, words.marked):
        assert told(True) != told(False)
    assert words.judged(True).startswith("✔")
    assert words.judged(False).startswith("✖")


def test_what_is_missing_is_told_where_it_is_not_plain() -> None:
    assert BLOCK.told(False, "the block still stands") == "The block stands."
    told = TASK.told(False, "the box is 3 cm outside the zone")
    assert told == "The task is not done. The box is 3 cm outside the zone."
    assert TASK.told(True, "") == "The task is done."
