"""Strokes follow from where blocks and zones are."""

from dataclasses import replace

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.skeleton import HandState
from studio.engine.sources.strokes import mirrored, strokes_of
from studio.engine.success import Lifted, Success


@pytest.mark.parametrize("name", scene_names())
def test_the_demonstrator_knows_every_scene_that_ships(name: str) -> None:
    strokes = strokes_of(read_scene(name))
    assert strokes
    assert all(stroke.left or stroke.right for stroke in strokes)
    closed = [stroke.grip is HandState.CLOSED for stroke in strokes]
    assert any(closed) == read_scene(name).gripper
    assert not closed[0]
    assert not closed[-1]


def test_a_push_begins_behind_the_block_and_ends_before_the_middle_of_the_zone() -> None:
    scene = read_scene("push-into-zone")
    block, zone = scene.blocks[0], scene.zones[0]
    _, begin, end, *_ = (np.array(stroke.left.point) for stroke in strokes_of(scene))
    ahead = np.subtract(zone.center, block.position[:2])
    assert (begin[:2] - block.position[:2]) @ ahead < 0.0
    assert (zone.center - end[:2]) @ ahead > 0.0
    assert begin[2] == end[2] < block.position[2] + block.size[2] / 2


def test_where_things_stand_elsewhere_the_strokes_do_too() -> None:
    scene = read_scene("push-into-zone")
    shift = np.array([-0.04, 0.03, 0.0])
    block, zone = scene.blocks[0], scene.zones[0]
    moved = replace(
        scene,
        blocks=(replace(block, position=tuple((np.array(block.position) + shift).tolist())),),
        zones=(replace(zone, center=tuple((np.array(zone.center) + shift[:2]).tolist())),),
    )
    for before, after in zip(strokes_of(scene), strokes_of(moved), strict=True):
        assert np.subtract(after.left.point, before.left.point) == pytest.approx(shift)


def test_both_arms_do_the_same_on_their_sides() -> None:
    scene = read_scene("both-arms")
    for stroke in strokes_of(scene):
        assert stroke.left == stroke.right
    assert mirrored(mirrored(scene)) == scene


def test_what_it_does_not_know_it_says() -> None:
    with pytest.raises(StudioError, match="lifts the block only to set it into a zone"):
        strokes_of(Scene(success=Success((Lifted("block", 0.1),))))
