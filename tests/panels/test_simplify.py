"""Fewer triangles: near where they were, with the same rims, colors and topology."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings, strategies

from studio.panels.simplify import simplified
from studio.panels.triangles import Edges, Triangles

RED, BLUE = (200, 0, 0, 255), (0, 0, 200, 255)


def triangles_of(mesh: trimesh.Trimesh, color: tuple[int, ...] = RED) -> Triangles:
    colors = np.tile(np.array(color, np.uint8), (len(mesh.faces), 1))
    return Triangles.welded(mesh.vertices, mesh.faces, colors)


def ball() -> Triangles:
    return triangles_of(trimesh.creation.icosphere(subdivisions=4, radius=0.3))


def area(mesh: Triangles) -> float:
    return float(np.linalg.norm(mesh.crosses(), axis=1).sum() / 2.0)


def characteristic(mesh: Triangles) -> int:
    """Euler's, 2 for all that is closed and has no holes."""
    return len(mesh.vertices) - len(Edges.of(mesh.faces).ends) + len(mesh.faces)


@given(strategies.floats(0.0005, 0.003))
@settings(deadline=None, derandomize=True, max_examples=6)
def test_a_ball_stays_one_closed_ball(tolerance: float) -> None:
    light = simplified(ball(), tolerance)
    assert len(light.faces) < len(ball().faces)
    radii = np.linalg.norm(light.vertices, axis=1)
    np.testing.assert_allclose(radii, 0.3, atol=2.0 * tolerance)
    assert (Edges.of(light.faces).counts == 2).all()
    assert characteristic(light) == 2
    outward = np.sum(light.crosses() * light.vertices[light.faces].mean(axis=1), axis=1)
    assert (outward > 0.0).all()


def test_more_tolerance_leaves_fewer_triangles() -> None:
    counts = [len(simplified(ball(), tolerance).faces) for tolerance in (5e-4, 2e-3, 8e-3)]
    assert counts[0] > 1.5 * counts[1] > 1.5 * counts[2]


def test_a_box_of_many_triangles_becomes_one_of_few_exactly_where_it_was() -> None:
    box = trimesh.creation.box((0.2, 0.3, 0.4))
    light = simplified(triangles_of(box.subdivide().subdivide().subdivide()), 1e-4)
    assert len(light.faces) <= 768 / 12
    np.testing.assert_allclose(np.abs(light.vertices / (0.1, 0.15, 0.2)).max(axis=1), 1.0)
    assert area(light) == pytest.approx(box.area, rel=1e-4)


def test_a_torus_keeps_its_hole() -> None:
    torus = triangles_of(trimesh.creation.torus(0.1, 0.03, 48, 24))
    light = simplified(torus, 0.002)
    assert len(light.faces) < len(torus.faces) / 2
    assert characteristic(light) == 0


def test_the_line_between_two_colors_stays_straight() -> None:
    sheet = trimesh.creation.box((0.2, 0.2, 0.01)).subdivide_to_size(0.02)
    mesh = triangles_of(sheet)
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    mesh.colors[middles[:, 0] > 0.0] = BLUE
    seam = mesh.vertices[np.unique(mesh.faces[middles[:, 0] > 0.0])][:, 0].min()
    light = simplified(mesh, 5e-4)
    assert len(light.faces) < len(mesh.faces) / 4
    for color, extreme in ((RED, np.max), (BLUE, np.min)):
        used = np.unique(light.faces[(light.colors == color).all(axis=1)])
        assert extreme(light.vertices[used][:, 0]) == pytest.approx(seam, abs=1e-3)
    assert area(light) == pytest.approx(area(mesh), rel=5e-3)


def test_a_rim_stays_where_it_is() -> None:
    x, y = np.meshgrid(np.linspace(0.0, 0.1, 21), np.linspace(0.0, 0.1, 21))
    flat = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    corner = (np.arange(20)[:, None] * 21 + np.arange(20)).ravel()
    quads = np.column_stack([corner, corner + 1, corner + 22, corner + 21])
    faces = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    sheet = Triangles.welded(flat, faces, np.tile(np.array(RED, np.uint8), (len(faces), 1)))
    light = simplified(sheet, 1e-4)
    assert len(light.faces) <= 800 / 50
    assert area(light) == pytest.approx(0.01, rel=1e-3)


def test_the_same_mesh_gives_the_same_result() -> None:
    one, other = simplified(ball(), 0.001), simplified(ball(), 0.001)
    assert one.vertices.tobytes() == other.vertices.tobytes()
    assert one.faces.tobytes() == other.faces.tobytes()


def test_what_has_no_triangle_left_is_no_error() -> None:
    speck = triangles_of(trimesh.creation.icosphere(subdivisions=1, radius=1e-6))
    assert len(simplified(speck, 1e-3).faces) == 0
