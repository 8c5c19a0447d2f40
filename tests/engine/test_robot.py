import logging
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh
import yourdfpy

from studio.engine import robot as robot_module
from studio.engine.errors import StudioError
from studio.engine.robot import (
    JOINT_NAMES,
    JointLimits,
    description_folder,
    load_robot,
    urdf_path,
    urdf_without_visuals,
)
from studio.engine.skeleton import SIDES, FloatArray
from studio.engine.urdf import Box, Cylinder, Mesh, PlacedShape, Shape, Sphere

MOVED_LINKS = "upper_shoulder lower_shoulder upper_elbow lower_elbow upper_forearm lower_forearm"


@pytest.fixture(scope="module")
def folder() -> Path:
    found = description_folder()
    if found is None:
        pytest.skip("the wheel example-robot-data is not installed")
    return found


@pytest.fixture(scope="module")
def upstream(folder: Path) -> yourdfpy.URDF:
    return yourdfpy.URDF.load(str(folder / "urdf" / "baxter.urdf"), load_meshes=False)


@pytest.fixture(scope="module")
def ours() -> yourdfpy.URDF:
    return yourdfpy.URDF.load(str(urdf_path()), load_meshes=False)


def rigid_links(urdf: yourdfpy.URDF, root: str) -> Iterator[tuple[yourdfpy.Link, FloatArray]]:
    """Yield all links that fixed joints tie to ``root``, with their transforms in it."""
    yield urdf.link_map[root], np.eye(4)
    for joint in urdf.robot.joints:
        if joint.parent == root and joint.type == "fixed":
            T = np.eye(4) if joint.origin is None else joint.origin
            for link, below in rigid_links(urdf, joint.child):
                yield link, T @ below


def rigid_roots(urdf: yourdfpy.URDF) -> list[str]:
    """Return the first link of each rigid group that our joints move, and the base."""
    return ["base", *(j.child for j in urdf.robot.joints if j.name in JOINT_NAMES)]


def inertia_of_group(urdf: yourdfpy.URDF, root: str) -> tuple[float, FloatArray, FloatArray]:
    """Return mass, center (3,) and inertia (3, 3) about the group's first link's origin."""
    mass, moment, inertia = 0.0, np.zeros(3), np.zeros((3, 3))
    for link, T_group_link in rigid_links(urdf, root):
        if link.inertial is None:
            continue
        origin = np.eye(4) if link.inertial.origin is None else link.inertial.origin
        T = T_group_link @ origin
        turn, at = T[:3, :3], T[:3, 3]
        mass += link.inertial.mass
        moment += link.inertial.mass * at
        steiner = np.dot(at, at) * np.eye(3) - np.outer(at, at)
        inertia += turn @ link.inertial.inertia @ turn.T + link.inertial.mass * steiner
    return mass, moment / mass, inertia


def test_names_are_left_then_right_then_head() -> None:
    robot = load_robot()
    assert robot.joint_names == JOINT_NAMES
    assert JOINT_NAMES[:7] == robot.arm_joints("left")
    assert JOINT_NAMES[7:14] == robot.arm_joints("right")
    assert JOINT_NAMES[14:] == ("head_pan",)
    assert robot.arm_joints("left")[0] == "left_s0"
    assert robot.arm_joints("left")[-1] == "left_w2"


def test_every_movable_link_and_the_hands_keep_their_names() -> None:
    names = {link.name for link in load_robot().links}
    arms = {f"{side}_{part}" for side in SIDES for part in (*MOVED_LINKS.split(), "wrist", "hand")}
    assert names == arms | {"base", "head"}


def test_limits_are_the_wheels(upstream: yourdfpy.URDF) -> None:
    limits = load_robot().limits
    for index, name in enumerate(JOINT_NAMES):
        theirs = upstream.joint_map[name].limit
        assert limits.lower[index] == theirs.lower
        assert limits.upper[index] == theirs.upper
        assert limits.velocity[index] == theirs.velocity
        assert limits.effort[index] == theirs.effort


def test_masses_and_inertias_of_rigid_groups_are_the_wheels(
    upstream: yourdfpy.URDF, ours: yourdfpy.URDF
) -> None:
    assert sorted(rigid_roots(ours)) == sorted(rigid_roots(upstream))
    for root in rigid_roots(ours):
        mass, center, inertia = inertia_of_group(ours, root)
        their_mass, their_center, their_inertia = inertia_of_group(upstream, root)
        assert mass == pytest.approx(their_mass, abs=1e-9), root
        np.testing.assert_allclose(center, their_center, atol=1e-8, err_msg=root)
        np.testing.assert_allclose(inertia, their_inertia, atol=1e-7, err_msg=root)


def test_pybullet_has_nothing_to_invent(ours: yourdfpy.URDF) -> None:
    for link in ours.robot.links:
        assert link.inertial is not None, link.name
        assert np.linalg.eigvalsh(link.inertial.inertia).min() > 0, link.name


def test_joints_have_the_wheels_damping(upstream: yourdfpy.URDF, ours: yourdfpy.URDF) -> None:
    for name in JOINT_NAMES:
        damping = upstream.joint_map[name].dynamics.damping
        assert ours.joint_map[name].dynamics.damping == damping


def test_meshes_are_placed_as_in_the_wheel(upstream: yourdfpy.URDF) -> None:
    ours = {
        (visual.link, Path(visual.shape.file).name): visual.T_link_visual
        for visual in load_robot().visuals
        if isinstance(visual.shape, Mesh)
    }
    for root in rigid_roots(upstream):
        for link, T_group_link in rigid_links(upstream, root):
            for visual in link.visuals:
                if visual.geometry.mesh is None:
                    continue
                name = Path(visual.geometry.mesh.filename).name
                T = T_group_link @ (np.eye(4) if visual.origin is None else visual.origin)
                if (found := root.replace("wrist", "hand"), name) in ours:
                    T[2, 3] -= 0.11355 if found != root else 0.0  # the hand on the wrist
                else:
                    found = root
                np.testing.assert_allclose(ours.pop((found, name)), T, atol=1e-6)
    assert not ours


def test_shapes_to_collide_are_portable_and_everywhere() -> None:
    for link in load_robot().links:
        assert link.collisions, link.name
        assert all(isinstance(s.shape, Box | Cylinder | Sphere) for s in link.collisions)


def _solid(shape: Shape) -> trimesh.Trimesh:
    match shape:
        case Box(size):
            return trimesh.creation.box(size)
        case Cylinder(radius, length):
            return trimesh.creation.cylinder(radius, length)
        case Sphere(radius):
            return trimesh.creation.icosphere(radius=radius)
        case Mesh(file):
            return trimesh.load(file, force="mesh")


def _bounds(placed: list[tuple[Shape, FloatArray]]) -> FloatArray:
    solids = [_solid(shape).apply_transform(T) for shape, T in placed]
    corners = np.array([solid.bounds for solid in solids])
    return np.array([corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)])


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("part", [*MOVED_LINKS.split(), "wrist", "hand"])
def test_shapes_to_collide_fit_the_meshes(part: str) -> None:
    name = f"left_{part}"
    robot = load_robot()
    (link,) = (link for link in robot.links if link.name == name)
    collides = _bounds([(s.shape, s.T_link_shape) for s in link.collisions])
    looks = _bounds([(v.shape, v.T_link_visual) for v in robot.visuals if v.link == name])
    np.testing.assert_allclose(collides, looks, atol=0.02)


@pytest.mark.usefixtures("folder")
def test_meshes_resolve_to_files() -> None:
    meshes = [v.shape for v in load_robot().visuals if isinstance(v.shape, Mesh)]
    assert len(meshes) == 2 + 2 + 2 * 8  # torso and pedestal, head and screen, two arms
    assert all(Path(mesh.file).is_file() for mesh in meshes)


def test_without_the_wheel_simple_shapes_are_shown_with_a_warning(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(robot_module, "description_folder", lambda: None)
    bare = load_robot.__wrapped__()
    with caplog.at_level(logging.WARNING):
        visuals = bare.visuals
    assert not any(isinstance(visual.shape, Mesh) for visual in visuals)
    assert {visual.link for visual in visuals} == {link.name for link in bare.links}
    assert "example-robot-data" in caplog.text
    shown = [v for v in visuals if v.link == "left_wrist"]
    (wrist,) = (link for link in bare.links if link.name == "left_wrist")
    assert [v.shape for v in shown] == [s.shape for s in wrist.collisions]
    assert shown[0].color == wrist.visuals[0].color


def test_the_lean_description_differs_in_looks_alone(ours: yourdfpy.URDF) -> None:
    assert b"<visual>" not in urdf_without_visuals()
    assert urdf_without_visuals().count(b"<collision>") == sum(
        len(link.collisions) for link in ours.robot.links
    )


def test_limits_of_some_joints_come_in_their_order() -> None:
    robot = load_robot()
    some = robot.limits_of(["right_e1", "left_s1"])
    assert isinstance(some, JointLimits)
    np.testing.assert_array_equal(some.lower, [-0.05, -2.147])
    np.testing.assert_array_equal(some.upper, [2.618, 1.047])
    np.testing.assert_array_equal(some.velocity, [1.5, 1.5])
    np.testing.assert_array_equal(some.effort, [50.0, 50.0])


def test_an_unknown_joint_is_refused_with_the_nearest_one() -> None:
    with pytest.raises(StudioError, match=r"'left_s3'.*'left_s"):
        load_robot().joint_index("left_s3")


def test_the_shared_robot_cannot_be_changed() -> None:
    with pytest.raises(ValueError, match="read-only"):
        load_robot().limits.lower[0] = 0.0


def test_placed_shapes_carry_rigid_transforms() -> None:
    shapes: list[PlacedShape] = [s for link in load_robot().links for s in link.collisions]
    for placed in shapes:
        turn = placed.T_link_shape[:3, :3]
        np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
