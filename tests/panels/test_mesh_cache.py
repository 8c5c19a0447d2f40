"""The cache gives what making anew gives, to the bit, whatever has happened to its files."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.engine.robot import load_robot
from studio.engine.urdf import Mesh
from studio.panels import mesh_cache
from studio.panels.glb import Surface
from studio.panels.mesh_cache import light_surface
from studio.panels.meshes import Look, looks

DETAIL = 0.002
LINK = "left_lower_shoulder"  # the one that is soonest made
LOOK = next(look for look in looks(load_robot()) if look.links[0] == LINK)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(mesh_cache, "cache_folder", lambda: tmp_path / "cache")
    return tmp_path / "cache"


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The links whose surfaces were made, not found."""
    links: list[str] = []
    surface = Look.surface

    def noted(look: Look, detail: float) -> Surface:
        links.append(look.links[0])
        return surface(look, detail)

    monkeypatch.setattr(Look, "surface", noted)
    return links


def alike(one: Surface, other: Surface) -> bool:
    return all(
        getattr(one, name).dtype == getattr(other, name).dtype
        and getattr(one, name).tobytes() == getattr(other, name).tobytes()
        for name in ("vertices", "faces", "colors")
    )


def test_what_is_found_equals_what_is_made(folder: Path, made: list[str]) -> None:
    first, second = light_surface(LOOK, DETAIL), light_surface(LOOK, DETAIL)
    assert made == [LINK]
    assert alike(first, second)
    assert alike(first, LOOK.surface(DETAIL))


def test_the_makers_notice_lies_beside_it(folder: Path) -> None:
    light_surface(LOOK, DETAIL)
    assert "Rethink Robotics" in (folder / "NOTICE").read_text()
    assert len(list(folder.iterdir())) == 2  # and no half-written file


@pytest.mark.parametrize("damage", ["empty", "cut", "flipped", "other"])
def test_a_damaged_file_is_made_anew(
    folder: Path, made: list[str], damage: str, caplog: pytest.LogCaptureFixture
) -> None:
    first = light_surface(LOOK, DETAIL)
    (path,) = folder.glob("*.npz")
    whole = path.read_bytes()
    middle = len(whole) // 2
    if damage == "other":
        np.savez(path, vertices=np.zeros((1, 3)), faces=np.array([[0, 1, 2]]), colors=np.zeros(4))
    else:
        path.write_bytes(
            {
                "empty": b"",
                "cut": whole[:middle],
                "flipped": whole[:middle] + bytes([whole[middle] ^ 64]) + whole[middle + 1 :],
            }[damage]
        )
    assert alike(light_surface(LOOK, DETAIL), first)
    assert len(made) == 2
    assert path.name in caplog.text
    assert alike(light_surface(LOOK, DETAIL), first)
    assert len(made) == 2  # and this time it was kept


def test_another_detail_mesh_place_or_color_is_another_file(
    folder: Path, made: list[str], tmp_path: Path
) -> None:
    visual = LOOK.visuals[0]
    assert isinstance(visual.shape, Mesh)
    moved = replace(visual, T_link_visual=visual.T_link_visual + 1e-3)
    painted = replace(visual, color=(0.1, 0.2, 0.3, 1.0))
    changed = tmp_path / "W2.DAE"
    changed.write_bytes(Path(visual.shape.file).read_bytes() + b"\n")
    other = replace(visual, shape=Mesh(str(changed)))
    light_surface(LOOK, DETAIL)
    light_surface(LOOK, 2.0 * DETAIL)
    for variant in (moved, painted, other):
        light_surface(Look(LOOK.links, (variant,)), DETAIL)
    assert len(made) == len(list(folder.glob("*.npz"))) == 5


def test_a_folder_that_cannot_be_made_is_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setattr(mesh_cache, "cache_folder", lambda: tmp_path / "file" / "cache")
    assert len(light_surface(LOOK, DETAIL).faces) > 0
    assert "next start" in caplog.text
