from collections.abc import Iterator

import numpy as np
import pytest
import trimesh
import yourdfpy

from studio.engine.fingers import CLOSED, FINGER_JOINTS, OPEN, fingers_of
from studio.engine.resources import resource_root
from studio.engine.robot import JOINT_NAMES, description_folder, load_robot
from studio.engine.scene import Block, Scene
from studio.engine.skeleton import FloatArray
from studio.engine.urdf import Box, Mesh
from studio.engine.world import World

ROBOT = load_robot(fingers=True)
THEIRS = {"left_finger_1": "l_gripper_l_finger", "left_finger_2": "l_gripper_r_finger"}

# The left hand points straight down at a block of 4 cm on the desk, and 15 cm higher [rad].
AT_THE_BLOCK = (-0.943, -0.456, 0.096, 1.394, -0.14, 0.647, -0.008)
LIFTED = (-0.987, -0.769, 0.155, 1.529, -0.132, 0.842, -0.008)
BLOCK = Block((0.04, 0.04, 0.04), (0.7, 0.2, 0.74), 0.1, 0.6)  # pybullet: 0.6 x 1, the tips' own


@pytest.fixture(scope="module")
def upstream() -> yourdfpy.URDF:
    folder = description_folder()
    if folder is None:
        pytest.skip("the wheel example-robot-data is not installed")
    return yourdfpy.URDF.load(str(folder / "urdf" / "baxter.urdf"), load_meshes=False)


@pytest.fixture(scope="module")
def ours() -> yourdfpy.URDF:
    return yourdfpy.URDF.load(str(resource_root() / "urdf" / "fingers.urdf"), load_meshes=False)


def test_a_robot_without_fingers_is_what_it_was() -> None:
    assert load_robot().joint_names == JOINT_NAMES
    assert not any("finger" in link.name for link in load_robot().links)
    assert ROBOT.joint_names == (*JOINT_NAMES, *FINGER_JOINTS)


def test_open_and_closed_are_the_ends_of_the_travel() -> None:
    limits = ROBOT.limits_of(FINGER_JOINTS)
    np.testing.assert_array_equal(limits.upper, OPEN)
    np.testing.assert_array_equal(limits.lower, CLOSED)
    assert fingers_of("left", closed=True) == {"left_finger_1": 0.0, "left_finger_2": 0.0}


def test_fingers_slide_as_the_wheels_do(upstream: yourdfpy.URDF) -> None:
    for out in (0.0, 0.01, OPEN):
        body = np.zeros(19)
        body[15:17] = out
        poses = ROBOT.link_poses(body)
        upstream.update_cfg({"l_gripper_l_finger_joint": out})
        T_hand = upstream.get_transform("left_hand_link", "base")
        for name, theirs in THEIRS.items():
            T = np.linalg.inv(T_hand) @ upstream.get_transform(theirs, "base")
            if name == "left_finger_2":  # theirs mimics; not every reader of URDF follows that
                T[1, 3] = 0.0015 - out
            found = np.linalg.inv(poses["left_hand"]) @ poses[name]
            np.testing.assert_allclose(found, T, atol=1e-9)


def test_masses_travel_and_effort_are_the_wheels(
    upstream: yourdfpy.URDF, ours: yourdfpy.URDF
) -> None:
    for name, theirs in THEIRS.items():
        own = name.removeprefix("left_")
        limit, their_limit = (
            ours.joint_map[own].limit,
            upstream.joint_map[f"{theirs}_joint"].limit,
        )
        assert limit.upper - limit.lower == their_limit.upper - their_limit.lower
        assert limit.effort == their_limit.effort
        mass = sum(upstream.link_map[f"{theirs}{tip}"].inertial.mass for tip in ("", "_tip"))
        assert ours.link_map[own].inertial.mass == pytest.approx(mass)


@pytest.mark.parametrize("name", ["finger_1", "finger_2"])
def test_inertias_are_those_of_the_boxes(ours: yourdfpy.URDF, name: str) -> None:
    (link,) = (link for link in ROBOT.links if link.name == f"left_{name}")
    boxes = [(np.array(s.shape.size), s.T_link_shape[:3, 3]) for s in link.collisions
             if isinstance(s.shape, Box)]  # fmt: skip
    volumes = np.array([size.prod() for size, _ in boxes])
    masses = np.array([*(0.02 * volumes[:2] / volumes[:2].sum()), 0.01])  # finger, tip
    center = masses @ np.array([at for _, at in boxes]) / masses.sum()
    inertia = np.zeros((3, 3))
    for mass, (size, at) in zip(masses, boxes, strict=True):
        square, away = np.square(size), at - center
        inertia += mass / 12 * np.diag(square.sum() - square)
        inertia += mass * (away @ away * np.eye(3) - np.outer(away, away))
    inertial = ours.link_map[name].inertial
    np.testing.assert_allclose(inertial.origin[:3, 3], center, atol=1e-8)
    np.testing.assert_allclose(inertial.inertia, inertia, rtol=1e-6)


def test_shapes_to_collide_fit_the_meshes() -> None:
    if description_folder() is None:
        pytest.skip("the wheel example-robot-data is not installed")
    visuals = [visual for visual in ROBOT.visuals if visual.link == "left_finger_1"]
    looks = np.vstack([corners(v.shape, v.T_link_visual) for v in visuals])
    (link,) = (link for link in ROBOT.links if link.name == "left_finger_1")
    collides = np.vstack([corners(s.shape, s.T_link_shape) for s in link.collisions])
    np.testing.assert_allclose(collides.min(axis=0), looks.min(axis=0), atol=0.006)
    np.testing.assert_allclose(collides.max(axis=0), looks.max(axis=0), atol=0.006)


def corners(shape: object, T: FloatArray) -> FloatArray:
    match shape:
        case Mesh(file):
            solid = trimesh.load(file, force="mesh")
        case Box(size):
            solid = trimesh.creation.box(size)
    found: FloatArray = trimesh.bounds.corners(solid.apply_transform(T).bounds)
    return found


@pytest.fixture
def world() -> Iterator[World]:
    start = dict(zip(JOINT_NAMES[:7], AT_THE_BLOCK, strict=True))
    start |= fingers_of("left", closed=False) | fingers_of("right", closed=False)
    with World(Scene(blocks=(BLOCK,)), start, fingers=True) as world:
        yield world


def move(world: World, goal: tuple[float, ...], seconds: float) -> None:
    start = world.state.joint_positions[:7]
    ticks = round(30 * seconds)
    for tick in range(ticks):
        rows = start + (np.array(goal) - start) * (tick + 1) / ticks
        world.apply(dict(zip(JOINT_NAMES[:7], rows.tolist(), strict=True)))
        world.step()


def test_fingers_hold_a_block_lift_it_and_let_it_go(world: World) -> None:
    for _ in range(15):
        world.step()
    np.testing.assert_allclose(world.state.fingers, OPEN, atol=1e-4)
    world.apply(fingers_of("left", closed=True))
    for _ in range(20):
        world.step()
    assert world.state.fingers[:2].sum() == pytest.approx(
        0.04 - 0.016, abs=2e-3
    )  # the block's width
    move(world, LIFTED, 3.0)
    lifted = world.state.block_poses[0, 2]
    assert lifted > 0.86
    for _ in range(60):
        world.step()
    assert world.state.block_poses[0, 2] > lifted - 0.01  # it is held
    np.testing.assert_allclose(world.state.fingers[2:], OPEN, atol=1e-4)  # the other hand's stay
    world.apply(fingers_of("left", closed=False))
    for _ in range(30):
        world.step()
    assert world.state.block_poses[0, 2] == pytest.approx(0.74, abs=0.002)  # back on the desk


def test_a_closed_gripper_closes_on_nothing(world: World) -> None:
    move(world, LIFTED, 1.0)
    world.apply(fingers_of("left", closed=True))
    for _ in range(20):
        state = world.step()
    np.testing.assert_allclose(state.fingers[:2], CLOSED, atol=1e-3)
    assert state.joint_positions.shape == (15,)
