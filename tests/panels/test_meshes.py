"""Surfaces made light: no smaller, no larger, no other color, no crack that was not there."""

import io
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings, strategies

from studio.engine import robot as robot_module
from studio.engine.robot import load_robot
from studio.panels.meshes import FINE, Surface, looks, simplified


def surface_of(mesh: trimesh.Trimesh, color: tuple[int, int, int, int] = (9, 8, 7, 255)) -> Surface:
    colors = np.tile(np.array(color, np.uint8), (len(mesh.vertices), 1))
    return Surface(mesh.vertices, mesh.faces, mesh.vertex_normals, colors)


def area(surface: Surface) -> float:
    return float(trimesh.Trimesh(surface.vertices, surface.faces, process=False).area)


@given(strategies.floats(0.002, 0.05))
@settings(deadline=None, derandomize=True, max_examples=30)
def test_a_ball_keeps_its_size(detail: float) -> None:
    ball = surface_of(trimesh.creation.icosphere(subdivisions=4, radius=0.3))
    light = simplified(ball, detail)
    assert len(light.faces) <= len(ball.faces)
    radii = np.linalg.norm(light.vertices, axis=1)
    assert radii.min() >= 0.3 - detail
    assert radii.max() <= 0.3 + 1e-9
    assert area(light) == pytest.approx(area(ball), rel=0.06)
    np.testing.assert_allclose(np.linalg.norm(light.normals, axis=1), 1.0)
    assert (np.sum(light.normals * light.vertices, axis=1) > 0.0).all()  # outward still


def test_a_coarse_grid_leaves_few_triangles() -> None:
    ball = surface_of(trimesh.creation.icosphere(subdivisions=4, radius=0.3))
    assert len(simplified(ball, 0.1).faces) < len(ball.faces) / 5


def test_edges_stay_sharp_and_closed() -> None:
    box = trimesh.creation.box((0.2, 0.3, 0.4))
    flat = trimesh.Trimesh(
        box.triangles.reshape(-1, 3), np.arange(36).reshape(-1, 3), process=False
    )
    light = simplified(surface_of(flat), FINE)
    assert len(light.faces) == 12
    assert len(light.vertices) == 24  # each corner once a side
    assert len(np.unique(light.vertices.round(9), axis=0)) == 8  # and all at one place
    assert area(light) == pytest.approx(box.area)


def test_triangles_smaller_than_the_detail_vanish() -> None:
    speck = surface_of(trimesh.creation.icosphere(subdivisions=1, radius=0.0004))
    moved = replace(speck, vertices=speck.vertices + 0.001)
    assert len(simplified(moved, 0.002).faces) == 0


def test_neighbors_of_two_colors_stay_two() -> None:
    ball = surface_of(trimesh.creation.icosphere(subdivisions=3, radius=0.3))
    ball.colors[ball.vertices[:, 2] > 0.0] = (200, 0, 0, 255)
    light = simplified(ball, 0.02)
    assert len(np.unique(light.colors, axis=0)) == 2


def test_a_file_of_it_holds_the_same() -> None:
    light = simplified(surface_of(trimesh.creation.icosphere(subdivisions=3, radius=0.3)), 0.02)
    scene = trimesh.load_scene(io.BytesIO(light.as_glb()), file_type="glb")
    (mesh,) = scene.geometry.values()
    assert len(mesh.faces) == len(light.faces)
    np.testing.assert_allclose(
        mesh.bounds, [light.vertices.min(0), light.vertices.max(0)], atol=1e-4
    )


def test_every_link_that_shows_something_is_drawn_once() -> None:
    robot = load_robot()
    drawn = [link for look in looks(robot) for link in look.links]
    assert sorted(drawn) == sorted({visual.link for visual in robot.visuals})
    pairs = [look.links for look in looks(robot) if len(look.links) == 2]
    assert all(right == left.replace("left_", "right_") for left, right in pairs)
    assert len(pairs) >= 7  # the arms' meshes travel once for both


def test_baxter_keeps_its_size() -> None:
    for look in looks(load_robot()):
        if look.links[0] in ("left_lower_elbow", "head"):
            fine, light = look.surface(1e-5), look.surface(FINE)
            assert len(light.faces) < len(fine.faces)
            assert area(light) == pytest.approx(area(fine), rel=0.08)
            for extreme in (np.min, np.max):
                np.testing.assert_allclose(
                    extreme(light.vertices, 0), extreme(fine.vertices, 0), atol=FINE
                )


def test_without_the_wheel_of_meshes_simple_shapes_are_drawn(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(robot_module, "description_folder", lambda: None)
    plain = replace(load_robot())  # a copy that has not looked for its meshes yet
    found = looks(plain)
    assert not any(look.has_meshes for look in found)
    assert all(len(look.surface(FINE).faces) > 0 for look in found)
    assert "example-robot-data" in caplog.text
