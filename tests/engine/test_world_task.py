import math
from dataclasses import replace

import numpy as np
import pytest

from studio.engine.scene import Block, Scene
from studio.engine.skeleton import SIDES, Side
from studio.engine.world import World
from tests.engine.motions import MOTIONS, moved, play, rows


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("motion", MOTIONS)
def test_the_block_can_be_pushed_down_and_the_others_stay(motion: str, side: Side) -> None:
    states = play(Scene(arms=side), rows(motion, side), side)
    assert states[-1].block_down
    assert not states[0].touched
    others = states[-1].block_poses[1:, :3] - states[0].block_poses[1:, :3]
    assert np.abs(others).max() < 5e-4


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize(("x", "y"), [(0.02, 0.02), (0.02, -0.02), (-0.02, 0.02), (-0.02, -0.02)])
def test_the_block_may_stand_two_centimeters_off(motion: str, x: float, y: float) -> None:
    assert play(moved(Scene(), x, y), rows(motion))[-1].block_down


@pytest.mark.parametrize("motion", MOTIONS)
def test_an_arm_that_stays_where_it_is_leaves_the_block_standing(motion: str) -> None:
    states = play(Scene(), np.repeat(rows(motion)[:1], 150, axis=0))
    assert not any(state.touched or state.block_down for state in states)
    assert states[-1].tilt < math.radians(0.05)


def test_idle_blocks_stand_still() -> None:
    with World() as world:
        poses = [world.step().block_poses for _ in range(150)]
    places = np.array([block.position for block in world.scene.placed_blocks])
    np.testing.assert_allclose(poses[-1][:, :3], places, atol=3e-4)
    assert np.abs(poses[-1][:, 3:6]).max() < 1e-3
    np.testing.assert_array_equal(poses[-1], poses[90])  # nor do they creep


@pytest.mark.parametrize(("taught", "counts"), [("right", True), ("left", False)])
def test_a_push_by_the_arm_that_is_not_taught_does_not_count(taught: Side, counts: bool) -> None:
    scene = Scene(arms="right")
    if taught == "left":  # told mirrored, so that everything stands in the same places
        scene = Scene(desk=scene.placed_desk, blocks=scene.placed_blocks, arms="left")
    last = play(scene, rows("sweep exact", "right"), "right")[-1]
    assert last.tilt > math.radians(60)
    assert last.touched == counts
    assert last.block_down == counts


def test_a_block_that_falls_by_itself_does_not_count() -> None:
    high = Block((0.06, 0.06, 0.3), (1.04, 0.2, 0.88), 0.4, 0.6)
    with World(Scene(blocks=(high,))) as world:
        states = [world.step() for _ in range(60)]
    assert states[-1].tilt < math.radians(5)
    edge = replace(high, position=(1.09, 0.2, 0.88))  # its middle is beyond the desk's edge
    with World(Scene(blocks=(edge,))) as world:
        states = [world.step() for _ in range(120)]
    assert max(state.tilt for state in states) > math.radians(60)
    assert not any(state.touched or state.block_down for state in states)
