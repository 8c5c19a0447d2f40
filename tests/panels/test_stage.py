"""What stands around the robot is drawn as the scene has it: desk, blocks, zones."""

from types import SimpleNamespace

import numpy as np
import pytest

from studio.engine.scene_file import read_scene, scene_names
from studio.engine.skeleton import Joint, Skeleton, Tracking, all_tracked
from studio.panels.person import joint_colors
from studio.panels.stage import Furniture, set_the_backdrop
from studio.panels.zones import outline
from tests.panels.nodes import Scene
from tests.panels.test_view import contrast


def poses(scene) -> np.ndarray:
    upright = (0.0, 0.0, 0.0, 1.0)
    return np.array([[*block.position, *upright] for block in scene.placed_blocks])


@pytest.mark.parametrize("root", ["", "/b"])
@pytest.mark.parametrize("name", scene_names())
def test_every_block_and_zone_is_there_and_nothing_of_the_scene_before(name, root) -> None:
    nodes, scene = Scene(), read_scene(name)
    furniture = Furniture(nodes, root)
    for other in (*scene_names(), name):
        furniture.draw(read_scene(other), poses(read_scene(other)))
    blocks = {n for n in nodes.nodes if n.startswith(f"{root}/blocks/")}
    zones = {n for n in nodes.nodes if n.startswith(f"{root}/zones/")}
    assert blocks == {f"{root}/blocks/{i}" for i in range(len(scene.blocks))}
    assert len(zones) == 2 * len(scene.zones)
    for i, block in enumerate(scene.blocks):
        node = nodes.nodes[f"{root}/blocks/{i}"]
        assert node.dimensions == block.size
        np.testing.assert_allclose(node.position, block.position)
    for i, zone in enumerate(scene.zones):
        node = nodes.nodes[f"{root}/zones/{i}"]
        np.testing.assert_allclose(node.position[:2], zone.center)
        assert scene.desk.top < node.position[2] < scene.desk.top + 0.003
        assert node.dimensions[:2] == zone.size
        assert 0.0 < node.opacity < 1.0


def test_a_moved_block_is_no_other_scene() -> None:
    nodes, scene = Scene(), read_scene("push-into-zone")
    furniture = Furniture(nodes)
    furniture.draw(scene, poses(scene))
    added, blocks = nodes.added, furniture.blocks
    moved = scene.with_block_at(0.8, 0.3)
    furniture.draw(moved, poses(moved))
    assert (nodes.added, furniture.blocks) == (added, blocks)
    np.testing.assert_allclose(blocks[0].position[:2], (0.8, 0.3))


def test_an_outline_goes_around_its_zone() -> None:
    (zone,) = read_scene("push-into-zone").zones
    edges = outline(zone)
    np.testing.assert_allclose(edges[:, 1], np.roll(edges[:, 0], -1, axis=0))
    np.testing.assert_allclose(np.ptp(edges[:, 0], axis=0), (*zone.size, 0.0))


@pytest.mark.parametrize("is_dark", [False, True])
def test_a_person_is_seen_before_the_backdrop_and_guesses_are_fainter(is_dark) -> None:
    images: list[np.ndarray] = []
    scene = SimpleNamespace(
        set_background_image=lambda image, **_: images.append(image),
        add_grid=lambda *_, **__: None,
    )
    set_the_backdrop(scene, is_dark)
    tracking = all_tracked()
    tracking[Joint.WRIST_LEFT] = Tracking.INFERRED
    colors = joint_colors(Skeleton(0.0, np.zeros((25, 3)), tracking), is_dark)
    sure, guessed = (tuple(colors[joint].tolist()) for joint in (Joint.HAND_LEFT, Joint.WRIST_LEFT))
    (image,) = images
    for behind in (tuple(image[0, 0].tolist()), tuple(image[-1, 0].tolist())):
        assert contrast(sure, behind) >= 4.5
        assert contrast(guessed, behind) < contrast(sure, behind)
    assert (image.mean() < 64) == is_dark
