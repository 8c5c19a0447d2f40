import numpy as np
import pytest
import trimesh

from studio.engine.body import MARGINS, NEIGHBORS, Part, boxes_of, capsules_of, margin_of, may_rest
from studio.engine.distance import segment_to_segment
from studio.engine.robot import BASE_HEIGHT, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.engine.urdf import Box, Cylinder, Shape, Sphere

ROBOT = load_robot()
CAPSULES = capsules_of(ROBOT)
BOXES = boxes_of(ROBOT, Scene(), np.zeros(15))


def surface(shape: Shape) -> FloatArray:
    match shape:
        case Box(size):
            solid = trimesh.creation.box(size)
        case Cylinder(radius, length):
            solid = trimesh.creation.cylinder(radius, length)
        case Sphere(radius):
            solid = trimesh.creation.icosphere(radius=radius)
    return np.asarray(solid.vertices)


def test_every_shape_of_the_robot_is_a_capsule_or_a_box() -> None:
    shapes = sum(len(link.collisions) for link in ROBOT.links)
    around = 1 + len(Scene().blocks)
    assert len(CAPSULES.parts) + len(BOXES.parts) == shapes + around
    assert {part.link for part in (*CAPSULES.parts, *BOXES.parts)} >= {x.name for x in ROBOT.links}


def test_a_capsule_holds_all_of_its_shape_and_little_more() -> None:
    by_link = {link.name: list(link.collisions) for link in ROBOT.links}
    for part, line, radius in zip(CAPSULES.parts, CAPSULES.lines, CAPSULES.radii, strict=True):
        placed = next(  # boxes of torso, head and pedestal stay boxes
            by_link[part.link].pop(index)
            for index, each in enumerate(by_link[part.link])
            if part.place or not isinstance(each.shape, Box)
        )
        corners = surface(placed.shape) @ placed.T_link_shape[:3, :3].T + placed.T_link_shape[:3, 3]
        nowhere = np.zeros_like(corners)
        apart = segment_to_segment(corners, nowhere, line[:3, 0], line[:3, 1])
        assert apart.max() <= radius + 1e-12, part
        assert apart.max() >= radius - 1e-3, part  # it touches what it covers


def test_the_desk_and_the_blocks_stand_where_the_scene_has_them() -> None:
    scene = Scene()
    around = [(p, T, h) for p, T, h in zip(BOXES.parts, BOXES.T_box_base, BOXES.half, strict=True)]
    (desk,) = (each for each in around if each[0].name == "desk")
    origin = np.linalg.inv(desk[1])[:3, 3]
    origin[2] += BASE_HEIGHT
    np.testing.assert_allclose(origin, scene.placed_desk.position)
    np.testing.assert_allclose(2 * desk[2], scene.placed_desk.size)
    assert sum(part.name == "block" for part, _, _ in around) == len(scene.blocks)


def test_parts_are_named_as_one_says_them() -> None:
    assert {str(part) for part in (*CAPSULES.parts, *BOXES.parts)} == {
        *("torso", "pedestal", "head", "desk", "block"),
        *(
            f"{side} {name}"
            for side in ("left", "right")
            for name in ("shoulder", "upper arm", "elbow", "forearm", "wrist", "hand")
        ),
    }


def named(name: str) -> Part:
    return next(part for part in (*CAPSULES.parts, *BOXES.parts) if str(part) == name)


@pytest.mark.parametrize(
    ("one", "other", "stop"),
    [
        ("left hand", "desk", 0.02),
        ("left hand", "right hand", 0.02),
        ("left forearm", "pedestal", 0.02),
        ("left elbow", "torso", 0.01),
        ("right upper arm", "torso", 0.01),
        ("left hand", "left upper arm", 0.02),
    ],
)
def test_what_is_kept_apart(one: str, other: str, stop: float) -> None:
    for pair in ((one, other), (other, one)):
        margin = margin_of(*map(named, pair))
        assert margin is not None
        assert margin.stop == stop


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("left hand", "block"),
        ("left forearm", "block"),
        ("left shoulder", "torso"),
        ("left forearm", "left elbow"),
        ("left hand", "left wrist"),
        ("left upper arm", "left elbow"),
    ],
)
def test_what_may_touch(one: str, other: str) -> None:
    assert margin_of(named(one), named(other)) is None
    assert margin_of(named(other), named(one)) is None


def test_neighbors_are_told_by_the_joints_between() -> None:
    upper, hand = named("left upper arm"), named("left hand")
    assert hand.place - upper.place >= NEIGHBORS
    assert margin_of(upper, named("right upper arm")) is not None  # another arm is no neighbor


def test_what_lies_beside_each_other_where_an_arm_hangs() -> None:
    assert may_rest("left elbow", "torso")
    assert may_rest("right upper arm", "torso")
    for one, other in (("left hand", "torso"), ("left elbow", "desk"), ("left forearm", "torso")):
        assert not may_rest(one, other)


def test_each_row_of_the_table_slows_before_it_stops_and_says_why() -> None:
    for row in MARGINS:
        assert row.why
        assert np.isnan(row.stop) or 0.0 < row.stop < row.slow
    assert not MARGINS[-1].one  # the last row fits everything
    assert not MARGINS[-1].other
