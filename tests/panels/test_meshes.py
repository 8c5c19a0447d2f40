"""The robot's links made light: drawn once each, and to the eye what the maker gave."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from studio.engine import robot as robot_module
from studio.engine.robot import load_robot
from studio.panels.glb import Surface
from studio.panels.meshes import FINE, Look, looks
from studio.panels.triangles import Triangles

LINKS = ("head", "left_lower_elbow", "left_lower_shoulder", "left_wrist", "left_hand")
PIXEL, PIXELS = 0.0005, 900  # [m], and how many from side to side


def look_of(link: str) -> Look:
    return next(look for look in looks(load_robot()) if link in look.links)


@cache
def light_one(link: str) -> Surface:
    return look_of(link).surface(FINE)


def outline(mesh: Triangles | Surface, view: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return what a mesh covers, seen along the last axis of a view (3, 3)."""
    pixels = PIXELS / 2.0 + (mesh.vertices @ view.T)[:, :2] / PIXEL
    image = Image.new("1", (PIXELS, PIXELS))
    draw = ImageDraw.Draw(image)
    for corners in pixels[mesh.faces].round().astype(int).tolist():
        draw.polygon([tuple(corner) for corner in corners], fill=1)
    return np.asarray(image)


def outlines(link: str, light: Surface) -> list[tuple[float, float]]:
    """Return from four sides what only one of both covers: as a share, and per outline [m]."""
    full = look_of(link).triangles()
    turned = np.linalg.qr(np.array([[1.0, 2.0, 3.0], [-2.0, 1.0, 0.5], [0.3, 0.1, 1.0]]))[0]
    found = []
    for view in (np.eye(3), np.eye(3)[[1, 2, 0]], np.eye(3)[[2, 0, 1]], turned):
        a, b = outline(full, view), outline(light, view)
        rim = np.sum(a[1:] != a[:-1]) + np.sum(a[:, 1:] != a[:, :-1])
        found.append((float(np.sum(a ^ b) / np.sum(a)), float(PIXEL * np.sum(a ^ b) / rim)))
    return found


@pytest.mark.parametrize("link", LINKS)
def test_a_light_link_has_the_outline_of_the_full_one(link: str) -> None:
    shares, distances = zip(*outlines(link, light_one(link)), strict=True)
    assert max(shares) < 0.01
    assert max(distances) < FINE


def test_a_link_made_too_light_has_not() -> None:
    link = "left_lower_elbow"
    shares, distances = zip(*outlines(link, look_of(link).surface(20.0 * FINE)), strict=True)
    assert max(shares) > 0.02
    assert max(distances) > FINE


@pytest.mark.parametrize("link", LINKS)
def test_a_light_link_is_light_and_keeps_size_and_colors(link: str) -> None:
    full, light = look_of(link).triangles(), light_one(link)
    assert len(light.faces) < 0.6 * len(full.faces)
    for extreme in (np.min, np.max):
        np.testing.assert_allclose(
            extreme(light.vertices, 0), extreme(full.vertices, 0), atol=0.0015
        )
    area = np.linalg.norm(full.crosses(), axis=1).sum()
    ours = Triangles(light.vertices, light.faces, light.colors[light.faces[:, 0]])
    assert np.linalg.norm(ours.crosses(), axis=1).sum() == pytest.approx(area, rel=0.03)
    assert {*map(tuple, light.colors)} == {*map(tuple, full.colors)}


def test_every_link_that_shows_something_is_drawn_once() -> None:
    robot = load_robot()
    drawn = [link for look in looks(robot) for link in look.links]
    assert sorted(drawn) == sorted({visual.link for visual in robot.visuals})
    pairs = [look.links for look in looks(robot) if len(look.links) == 2]
    assert all(right == left.replace("left_", "right_") for left, right in pairs)
    assert len(pairs) >= 7  # the arms' meshes travel once for both


def test_without_the_wheel_of_meshes_simple_shapes_are_drawn(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(robot_module, "description_folder", lambda: None)
    plain = replace(load_robot())  # a copy that has not looked for its meshes yet
    found = looks(plain)
    assert not any(look.has_meshes for look in found)
    assert all(len(look.surface(FINE).faces) > 0 for look in found)
    assert "example-robot-data" in caplog.text
