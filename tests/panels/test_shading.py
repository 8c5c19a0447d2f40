"""What is round is smooth, what is angular is not."""

import numpy as np
import trimesh

from studio.panels.shading import shaded
from tests.panels.test_simplify import BLUE, ball, triangles_of


def test_a_ball_is_one_smooth_surface() -> None:
    assert len(shaded(ball()).vertices) == len(ball().vertices)


def test_a_box_has_each_corner_once_a_side() -> None:
    surface = shaded(triangles_of(trimesh.creation.box((0.2, 0.3, 0.4))))
    assert (len(surface.vertices), len(surface.faces)) == (24, 12)
    assert len(np.unique(surface.vertices.round(9), axis=0)) == 8  # and all at one place


def test_a_can_is_round_and_has_two_rims() -> None:
    can = triangles_of(trimesh.creation.cylinder(0.1, 0.3, sections=32))
    assert len(shaded(can).vertices) == 2 * 32 * 2 + 2  # the rims twice, the lids' middles once


def test_colors_meet_without_mixing() -> None:
    mesh = ball()
    mesh.colors[: len(mesh.faces) // 2] = BLUE
    surface = shaded(mesh)
    shades = surface.colors[surface.faces]
    assert (shades == shades[:, :1]).all()
    np.testing.assert_array_equal(shades[:, 0], mesh.colors)


def test_every_triangle_stays_in_its_place() -> None:
    mesh = triangles_of(trimesh.creation.box((0.2, 0.3, 0.4)).subdivide())
    surface = shaded(mesh)
    np.testing.assert_array_equal(surface.vertices[surface.faces], mesh.vertices[mesh.faces])
