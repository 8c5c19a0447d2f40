"""The file holds the surface; read back by another program, and by the specification."""

import io
import json
import struct

import numpy as np
import pytest
import trimesh

from studio.engine.errors import StudioError
from studio.panels.glb import Surface, glb
from studio.panels.shading import shaded
from tests.panels.test_simplify import ball, triangles_of

GRID = 4.0 / 32767.0  # [m]


def parsed(data: bytes) -> tuple[dict, bytes]:
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    (size,) = struct.unpack_from("<I", data, 12)
    assert data[16:20] == b"JSON"
    start = 20 + size
    assert start % 4 == 0
    assert data[start + 4 : start + 8] == b"BIN\0"
    return json.loads(data[20:start]), data[start + 8 :]


def test_positions_colors_and_triangles_come_back() -> None:
    surface = shaded(ball())
    description, numbers = parsed(glb(surface))
    places, colors, corners = (
        numbers[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        for view in description["bufferViews"]
    )
    steps = np.frombuffer(places, "<i2").reshape(-1, 4)[:, :3]
    np.testing.assert_allclose(steps / 32767.0, surface.vertices, atol=0.51 * GRID)
    np.testing.assert_array_equal(np.frombuffer(colors, np.uint8).reshape(-1, 4), surface.colors)
    np.testing.assert_array_equal(np.frombuffer(corners, "<u2").reshape(-1, 3), surface.faces)
    position = description["accessors"][0]
    assert (position["min"], position["max"]) == (
        steps.min(axis=0).tolist(),
        steps.max(axis=0).tolist(),
    )


def test_another_reader_finds_the_same_triangles() -> None:
    surface = shaded(triangles_of(trimesh.creation.box((0.2, 0.3, 0.4))))
    scene = trimesh.load_scene(io.BytesIO(glb(surface)), file_type="glb", process=False)
    (mesh,) = scene.geometry.values()
    assert len(mesh.faces) == 12


def test_normals_are_declared_but_not_sent() -> None:
    """Without the declaration the page shades flat; it computes the numbers itself."""
    description, _ = parsed(glb(shaded(ball())))
    normals = description["accessors"][
        description["meshes"][0]["primitives"][0]["attributes"]["NORMAL"]
    ]
    assert "bufferView" not in normals
    assert normals["count"] == description["accessors"][0]["count"]


def test_a_surface_of_many_vertices_gets_longer_indices() -> None:
    count = 70_000
    faces = np.arange(count - 1).repeat(3).reshape(-1, 3) % (count - 2) + np.arange(3)
    many = Surface(np.zeros((count, 3)), faces, np.zeros((count, 4), np.uint8))
    description, numbers = parsed(glb(many))
    view = description["bufferViews"][2]
    assert description["accessors"][3]["componentType"] == 5125
    indices = np.frombuffer(numbers, "<u4", faces.size, view["byteOffset"])
    np.testing.assert_array_equal(indices.reshape(-1, 3), faces)


def test_a_surface_too_large_is_refused() -> None:
    far = Surface(np.full((3, 3), 1.2), np.array([[0, 1, 2]]), np.zeros((3, 4), np.uint8))
    with pytest.raises(StudioError, match=r"1\.20 m"):
        glb(far)
