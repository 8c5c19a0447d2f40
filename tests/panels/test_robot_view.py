"""A frame moves the links that moved, and no others."""

from types import SimpleNamespace

import numpy as np
import pytest

from studio.engine.fingers import OPEN
from studio.engine.robot import load_robot
from studio.panels.poses import quaternions
from studio.panels.robot_view import GhostView, RobotView

PLAIN = 0.02  # [m] of detail
NOTHING = np.empty(0)


class Scene:
    """Takes note of what is put into it."""

    def __init__(self) -> None:
        self.nodes: dict[str, SimpleNamespace] = {}

    def _add(self, name: str, *_: object, **props: object) -> SimpleNamespace:
        self.nodes[name] = SimpleNamespace(**props)
        return self.nodes[name]

    add_frame = add_batched_glb = add_mesh_simple = _add

    def changed_by(self, draw) -> set[str]:
        before = {name: dict(vars(node)) for name, node in self.nodes.items()}
        draw()
        return {
            name.rsplit("/", 1)[1]
            for name, node in self.nodes.items()
            if any(value is not before[name].get(prop) for prop, value in vars(node).items())
        }


@pytest.fixture
def scene() -> Scene:
    return Scene()


def turned(**angles: float) -> np.ndarray:
    joints = np.zeros(15)
    for name, angle in angles.items():
        joints[load_robot().joint_index(name)] = angle
    return joints


def test_only_what_a_joint_carries_is_moved(scene: Scene) -> None:
    view = RobotView(scene, PLAIN)
    assert scene.changed_by(lambda: view.draw(turned(), NOTHING)) == set()
    assert scene.changed_by(lambda: view.draw(turned(head_pan=0.3), NOTHING)) == {"head"}
    # The right arm shares the left one's nodes.
    moved = scene.changed_by(lambda: view.draw(turned(head_pan=0.3, right_w0=0.4), NOTHING))
    assert {"left_wrist", "left_hand"} <= moved
    assert not {"base", "head", "left_upper_shoulder", "left_upper_elbow"} & moved
    assert scene.changed_by(lambda: view.draw(turned(head_pan=0.3, right_w0=0.4), NOTHING)) == set()


def test_creeping_adds_up_to_a_step(scene: Scene) -> None:
    view = RobotView(scene, PLAIN)
    drawn = [
        scene.changed_by(lambda a=a: view.draw(turned(head_pan=a), NOTHING))
        for a in np.arange(9) * 3e-5
    ]
    assert {"head"} in drawn
    assert set() in drawn[1:]


def test_links_are_where_the_kinematics_put_them(scene: Scene) -> None:
    view, joints = RobotView(scene, PLAIN), np.linspace(-0.5, 0.5, 15)
    view.draw(joints, NOTHING)
    poses = load_robot().link_poses(joints)
    wrists = np.stack([poses["left_wrist"], poses["right_wrist"]])
    node = scene.nodes["/robot/left_wrist"]
    np.testing.assert_allclose(node.batched_positions, wrists[:, :3, 3], atol=1e-6)
    np.testing.assert_allclose(node.batched_wxyzs, quaternions(wrists), atol=1e-6)


def test_fingers_move_and_go_where_there_are_none(scene: Scene) -> None:
    view, joints = RobotView(scene, PLAIN), np.zeros(15)
    assert "/robot/left_finger_1" not in scene.nodes
    found = []
    for out in (0.0, OPEN):
        view.draw(joints, np.full(4, out))
        node = scene.nodes["/robot/left_finger_1"]
        assert node.visible
        found.append(np.array(node.batched_positions[0]))
        expected = load_robot(fingers=True).link_poses(np.array([*joints, *np.full(4, out)]))
        np.testing.assert_allclose(found[-1], expected["left_finger_1"][:3, 3], atol=1e-6)
    assert np.linalg.norm(found[1] - found[0]) == pytest.approx(OPEN, abs=1e-6)
    view.draw(joints, NOTHING)
    assert not node.visible
    view.draw(joints, np.zeros(4))
    assert node.visible


def test_a_still_ghost_costs_nothing_and_either_arm_has_one(scene: Scene) -> None:
    ghost, joints = GhostView(scene), turned(left_s0=0.3)
    ghost.draw(None, "left")
    assert not scene.nodes["/ghost"].visible
    assert "left_hand" in scene.changed_by(lambda: ghost.draw(joints, "left"))
    assert scene.nodes["/ghost"].visible
    assert scene.changed_by(lambda: ghost.draw(joints, "left")) == set()
    assert "left_hand" in scene.changed_by(lambda: ghost.draw(joints, "right"))
    hand = load_robot().link_poses(joints)["right_hand"]
    np.testing.assert_allclose(scene.nodes["/ghost/left_hand"].position, hand[:3, 3])
