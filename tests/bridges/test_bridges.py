"""Bridges stand alone: they know nothing of the studio, and the studio nothing of them."""

import ast
from pathlib import Path

import pytest

STUDIO = Path(__file__).resolve().parents[2] / "studio"
BRIDGES = sorted((STUDIO / "bridges").glob("*.py"))


def imported(path: Path) -> set[str]:
    names = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return names


@pytest.mark.parametrize("path", BRIDGES, ids=lambda path: path.name)
def test_a_bridge_imports_nothing_of_the_studio(path: Path) -> None:
    assert not [name for name in imported(path) if name.startswith("studio")]


def test_the_studio_imports_no_bridge() -> None:
    for path in STUDIO.rglob("*.py"):
        assert not [name for name in imported(path) if name.startswith("studio.bridges")], path


def test_pins_are_exact() -> None:
    lines = (STUDIO / "bridges" / "webcam-requirements.txt").read_text().splitlines()
    pins = [line for line in lines if not line.startswith("#")]
    assert "mediapipe==0.10.21" in pins
    assert all(pin.count("==") == 1 for pin in pins)
