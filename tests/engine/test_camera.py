"""The camera against pybullet's own matrices, and against what its renderer draws."""

import numpy as np
import pybullet
import pytest

from studio.engine.camera import Camera
from studio.engine.performance import start_world
from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene
from studio.engine.world import World

CAMERAS = [Camera(), Camera((3.0, -1.0, 2.5), (0.1, 0.2, 0.8), 60.0, (320, 200))]


@pytest.mark.parametrize("camera", CAMERAS)
def test_matrices_are_pybullets(camera: Camera) -> None:
    view, projection = camera.matrices
    expected = pybullet.computeViewMatrix(camera.position, camera.target, (0, 0, 1))
    np.testing.assert_allclose(view, expected, atol=1e-6)
    width, height = camera.size
    expected = pybullet.computeProjectionMatrixFOV(camera.view_angle, width / height, 0.1, 12.0)
    np.testing.assert_allclose(projection, expected, atol=1e-6)


def test_the_target_is_in_the_middle() -> None:
    for camera in CAMERAS:
        middle = camera.pixels(np.array([camera.target]))[0]
        np.testing.assert_allclose(middle, np.array(camera.size) / 2)


def test_a_picture_shows_the_block_where_the_camera_says() -> None:
    camera = Camera(size=(240, 180))
    with World(Scene(), looks=True) as world:
        for shift in (0.0, 0.12):
            state = world.state
            poses = state.block_poses.copy()
            poses[0, 1] += shift
            world.show(type(state)(**{**vars(state), "block_poses": poses}))
            picture = world.picture(camera)
            column, row = np.round(camera.pixels(poses[:1, :3])[0]).astype(int)
            red, green, blue = picture[row, column].tolist()
            assert picture.shape == (180, 240, 3)
            assert red > 100
            assert green > 60
            assert blue < 80  # the block is amber


def test_a_picture_shows_the_zone_where_the_camera_says() -> None:
    camera, scene = Camera(size=(240, 180)), read_scene("push-into-zone")
    (zone,) = scene.zones
    with World(scene, looks=True) as world:
        picture = world.picture(camera)
    beside = np.array([*zone.center, scene.desk.top]) - [0.0, zone.size[1], 0.0]
    inside = np.array([*zone.center, scene.desk.top])
    colors = [
        picture[row, column].tolist()
        for column, row in np.round(camera.pixels(np.array([inside, beside]))).astype(int)
    ]
    (red, green, _), (wood, shade, _) = colors
    assert green > 1.2 * red
    assert shade < wood  # the desk is brown


@pytest.mark.parametrize("scene", [Scene(), read_scene("push-into-zone")])
def test_looks_change_nothing_of_what_happens(scene: Scene) -> None:
    """Same commands, same states, to the bit: looks have neither mass nor shape to bump into."""
    found = []
    with start_world("left", "exact") as plain:
        start = dict(zip(plain._robot.joint_names, plain.state.joint_positions, strict=True))
    for looks in (False, True):
        with World(scene, start, looks=looks) as world:
            world.apply({"left_s0": -0.8, "left_s1": 0.2})
            states = [world.step() for _ in range(25)]
        found.append(np.array([s.joint_positions for s in states]).tobytes())
        found.append(states[-1].block_poses.tobytes())
    assert found[:2] == found[2:]
