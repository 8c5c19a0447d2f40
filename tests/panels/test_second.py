"""The second robot comes when there is one, stands aside, and goes."""

from dataclasses import replace

import numpy as np

from studio.panels.second import ASIDE, SecondRobot
from tests.panels.nodes import Scene

PLAIN = 0.02  # [m] of detail


def test_it_comes_with_a_desk_of_its_own_and_goes(lesson) -> None:
    scene, now = Scene(), lesson["played"]
    second = SecondRobot(scene, PLAIN)
    second.draw(now)
    assert not scene.nodes["/b"].visible
    assert "/b/desk" not in scene.nodes
    two = replace(now, compare=replace(now.compare, beside=now.world))
    second.draw(two)
    second.wait()
    second.draw(two)
    assert scene.nodes["/b"].visible
    assert scene.nodes["/letter"].visible
    np.testing.assert_allclose(scene.nodes["/b"].position, (0.0, ASIDE, 0.0))
    block = scene.nodes["/b/blocks/0"]
    np.testing.assert_allclose(block.position, now.world.block_poses[0, :3])
    assert {"/b/robot/base", "/b/robot/left_wrist"} <= set(scene.nodes)
    second.draw(now)
    assert not scene.nodes["/b"].visible
    assert not scene.nodes["/letter"].visible


def test_a_still_world_moves_no_block(lesson) -> None:
    scene, now = Scene(), lesson["played"]
    second = SecondRobot(scene, PLAIN)
    two = replace(now, compare=replace(now.compare, beside=now.world))
    second.draw(two)
    before = scene.nodes["/b/blocks/0"].position
    second.draw(two)
    assert scene.nodes["/b/blocks/0"].position is before
    second.wait()
