import tempfile
from collections.abc import Iterator

import numpy as np
import pybullet
import pytest
import yourdfpy

from studio.engine.errors import StudioError
from studio.engine.robot import (
    JOINT_NAMES,
    Robot,
    description_folder,
    load_robot,
    urdf_path,
    urdf_without_visuals,
)
from studio.engine.skeleton import FloatArray

RENAMED = {"left_hand": "left_hand_link", "right_hand": "right_hand_link"}  # ours: the wheel's


def random_positions(count: int, seed: int = 0) -> FloatArray:
    limits = load_robot().limits
    return np.random.default_rng(seed).uniform(limits.lower, limits.upper, (count, 15))


@pytest.fixture(scope="module")
def upstream() -> yourdfpy.URDF:
    folder = description_folder()
    if folder is None:
        pytest.skip("the wheel example-robot-data is not installed")
    return yourdfpy.URDF.load(str(folder / "urdf" / "baxter.urdf"), load_meshes=False)


@pytest.fixture(scope="module")
def bullet() -> Iterator[tuple[int, int]]:
    client = pybullet.connect(pybullet.DIRECT)
    with tempfile.NamedTemporaryFile(suffix=".urdf") as file:
        file.write(urdf_without_visuals())
        file.flush()
        body = pybullet.loadURDF(file.name, useFixedBase=True, physicsClientId=client)
    yield client, body
    pybullet.disconnect(physicsClientId=client)


def test_every_link_is_where_the_wheels_own_description_has_it(upstream: yourdfpy.URDF) -> None:
    robot, positions = load_robot(), random_positions(1000)
    ours = {link.name: robot.forward_kinematics(link.name, positions) for link in robot.links}
    theirs = set(upstream.link_map)
    assert {RENAMED.get(name, name) for name in ours} <= theirs
    worst = 0.0
    for index, row in enumerate(positions):
        upstream.update_cfg(dict(zip(JOINT_NAMES, row, strict=True)))
        for name, poses in ours.items():
            expected = upstream.get_transform(RENAMED.get(name, name), "base")
            worst = max(worst, float(np.abs(poses[index] - expected).max()))
    assert worst < 1e-6


def test_every_link_is_where_pybullet_has_it(bullet: tuple[int, int]) -> None:
    client, body = bullet
    infos = [
        pybullet.getJointInfo(body, joint, physicsClientId=client)
        for joint in range(pybullet.getNumJoints(body, physicsClientId=client))
    ]
    for row in random_positions(50, seed=1):
        poses = load_robot().link_poses(row)
        for info in infos:
            name = info[1].decode()
            if name in JOINT_NAMES:
                angle = row[JOINT_NAMES.index(name)]
                pybullet.resetJointState(body, info[0], angle, physicsClientId=client)
        for info in infos:
            state = pybullet.getLinkState(
                body, info[0], computeForwardKinematics=True, physicsClientId=client
            )
            turn = np.reshape(pybullet.getMatrixFromQuaternion(state[5]), (3, 3))
            T = poses[info[12].decode()]
            # pybullet hands out poses in single precision's neighborhood
            np.testing.assert_allclose(T[:3, 3], state[4], atol=1e-6)
            np.testing.assert_allclose(T[:3, :3], turn, atol=1e-6)


def test_one_road_agrees_with_the_other_in_any_shape() -> None:
    robot, positions = load_robot(), random_positions(6)
    at_once = {
        link.name: robot.forward_kinematics(link.name, positions.reshape(2, 3, 15))
        for link in robot.links
    }
    for index, row in enumerate(positions):
        poses = robot.link_poses(row)
        assert set(poses) == set(at_once)
        for name, T in poses.items():
            one = at_once[name].reshape(-1, 4, 4)[index]
            np.testing.assert_allclose(T, one, atol=1e-14)
            np.testing.assert_allclose(T[:3, :3] @ T[:3, :3].T, np.eye(3), atol=1e-9)


def test_the_description_is_read_as_yourdfpy_reads_it() -> None:
    theirs = yourdfpy.URDF.load(str(urdf_path()), load_meshes=False)
    assert set(theirs.link_map) == {link.name for link in load_robot().links}
    assert set(theirs.actuated_joint_names) == set(JOINT_NAMES)


@pytest.mark.parametrize("shape", [(), (14,), (3, 16)])
def test_a_wrong_number_of_angles_is_refused(shape: tuple[int, ...]) -> None:
    robot: Robot = load_robot()
    with pytest.raises(StudioError, match="15"):
        robot.forward_kinematics("left_hand", np.zeros(shape))
    with pytest.raises(StudioError, match="15"):
        robot.link_poses(np.zeros(shape))


def test_link_poses_take_one_row() -> None:
    with pytest.raises(StudioError, match="one row"):
        load_robot().link_poses(np.zeros((2, 15)))


def test_an_unknown_link_is_refused_with_the_known_ones() -> None:
    with pytest.raises(StudioError, match=r"'left_foot'.*left_hand"):
        load_robot().forward_kinematics("left_foot", np.zeros(15))


def test_all_links_stacked_are_all_links() -> None:
    kinematics = load_robot().kinematics
    poses = np.random.default_rng(0).uniform(-1.5, 1.5, (3, 15))
    for angles, stack in zip(poses, kinematics.stacked(poses), strict=True):
        each = kinematics.all_links(angles)
        for link, pose in zip((kinematics.root, *kinematics.children), stack, strict=True):
            np.testing.assert_allclose(pose, each[link], atol=1e-12)


def test_below_a_joint_is_what_it_moves() -> None:
    kinematics = load_robot().kinematics
    column = load_robot().joint_index("right_w1")
    found = [kinematics.children[joint] for joint in kinematics.below([column])]
    assert found == ["right_lower_forearm", "right_wrist", "right_hand"]


@pytest.mark.parametrize("fingers", [False, True])
@pytest.mark.parametrize("moved", ["left_s0 left_e1 left_w2", "right_e0 left_s1", "head_pan"])
def test_what_moves_alone_is_where_it_is_among_all_to_the_bit(fingers: bool, moved: str) -> None:
    robot = load_robot(fingers)
    columns = [robot.joint_index(name) for name in moved.split()]
    rest = np.random.default_rng(1).uniform(robot.limits.lower, robot.limits.upper)
    angles = np.tile(rest, (5, 1))
    angles[:, columns] = np.random.default_rng(2).uniform(-1.0, 1.0, (5, len(columns)))
    moving = robot.kinematics.moving(rest, columns)
    carried = [1 + joint for joint in moving.joints]
    whole = robot.kinematics.stacked(angles)
    poses = moving.poses(angles[:, columns]).transpose(1, 0, 2, 3)
    np.testing.assert_array_equal(poses, whole[:, carried])
    np.testing.assert_array_equal(moving.poses(angles[0, columns]), whole[0, carried])
