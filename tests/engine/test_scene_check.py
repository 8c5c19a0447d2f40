"""Scenes that nobody can begin with: what falls by itself, stands in Baxter, or is done already."""

from dataclasses import replace

import numpy as np
import pytest

from studio.engine.arms import driven_joints, resting_body
from studio.engine.pipeline import ready_pose
from studio.engine.robot import BASE_HEIGHT, load_robot
from studio.engine.scene import Block, Scene, Zone
from studio.engine.scene_check import impossible, misplaced, unready
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.success import Down, InZone, Lifted, Success

TOP = Scene().desk.top
CUBE = Block((0.06, 0.06, 0.06), (0.8, 0.2, TOP + 0.03), 0.1, 0.5, "cube")
PUSH = Success((Down("cube"),))


def told(*blocks: Block, success: Success = PUSH, **changes) -> list[str]:
    scene = Scene(blocks=blocks, success=success, **changes)
    return [f"{problem.place}: {problem.words}" for problem in unready(scene)]


@pytest.mark.parametrize("name", scene_names())
def test_nothing_is_wrong_with_what_ships(name: str) -> None:
    scene = read_scene(name)
    assert [*misplaced(scene), *impossible(scene), *unready(scene)] == []


def test_a_block_stands_on_the_desk_or_on_the_middle_of_others() -> None:
    def at(x: float, z: float) -> Block:
        return replace(CUBE, position=(x, 0.2, z), name="lid")

    assert told(CUBE, at(0.8, TOP + 0.09)) == []
    assert told(CUBE, at(0.82, TOP + 0.09)) == []
    assert told(CUBE, at(0.8 + 1e-9, TOP + 0.09 - 1e-9)) == []
    off = ["block 2.position: 'lid' would fall off 'cube': put its center above that"]
    assert told(CUBE, at(0.84, TOP + 0.09)) == off
    high = ["block 2.position: 'lid' hangs in the air; on the desk its center is at 0.75"]
    assert told(CUBE, at(0.8, TOP + 0.10)) == told(CUBE, at(0.7, TOP + 0.09)) == high
    bridge = (CUBE, replace(CUBE, position=(0.9, 0.2, TOP + 0.03), name="pier"))
    assert told(*bridge, replace(at(0.85, TOP + 0.09), size=(0.2, 0.06, 0.06))) == []


@pytest.mark.parametrize("arms", ["left", "both"])
@pytest.mark.parametrize("mapping", ["exact", "paper"])
@pytest.mark.parametrize("link", ["left_hand", "left_lower_elbow", "right_hand", "head", "base"])
def test_nothing_stands_where_baxter_waits(arms, mapping, link: str) -> None:
    """Where a link's shapes are by its kinematics, a cube of a centimeter is in it."""
    robot, angles = load_robot(), resting_body(arms)
    angles[[robot.joint_index(name) for name in driven_joints(arms)]] = ready_pose(arms, mapping)
    (shapes,) = (each.collisions for each in robot.links if each.name == link)
    place = (robot.link_poses(angles)[link] @ shapes[0].T_link_shape)[:3, 3] + [0, 0, BASE_HEIGHT]
    cube = Block((0.01, 0.01, 0.01), tuple(place.tolist()), 0.1, 0.5, "cube")
    both = {"arms": arms, "both_arms": arms == "both"}
    assert any("'cube' stands in Baxter's" in each for each in told(cube, **both))
    far = replace(cube, position=tuple((place + np.array([0.0, 0.0, 1.5])).tolist()))
    assert not any("stands in Baxter's" in each for each in told(far, **both))


def test_the_desk_is_not_in_baxter() -> None:
    desk = replace(Scene().desk, position=(0.6, 0.15, 0.70))
    assert told(CUBE, desk=desk) == []
    (words,) = told(CUBE, desk=replace(desk, position=(0.45, 0.15, 0.70)))
    assert words.startswith("desk.position: the desk stands in Baxter's ")
    assert words.endswith(": move it away from there")


def test_a_task_is_not_done_before_it_begins() -> None:
    zone = Zone("mat", (0.8, 0.3), (0.1, 0.2))
    success = Success((InZone("cube", "mat"),))
    touching = replace(zone, center=(0.8, 0.3001))
    words = ["success 1.zone: 'cube' is in 'mat' from the beginning: move one of them"]
    assert told(CUBE, success=success, zones=(zone,)) == words
    assert told(CUBE, success=success, zones=(touching,)) == []
    lid = replace(CUBE, position=(0.8, 0.2, TOP + 0.09), name="lid")
    onto = Success((InZone("lid", "mat"),))
    assert told(CUBE, lid, success=onto, zones=(zone,)) == []  # it is to lie on the desk
    lifted = Success((Lifted("lid", 0.05),))
    (words,) = told(CUBE, lid, success=lifted)
    assert words == (
        "success 1.height: 'lid' is 0.06 m above the desk from the beginning: ask for more"
    )
    assert told(CUBE, lid, success=Success((Lifted("lid", 0.08),))) == []
