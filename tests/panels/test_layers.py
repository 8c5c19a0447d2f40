"""Panels send commands and draw snapshots: nothing of the engine runs in them."""

import ast
import re
from pathlib import Path

import pytest

PANELS = sorted((Path(__file__).resolve().parents[2] / "studio" / "panels").glob("*.py"))
RUNNING = {"session", "clock", "activity", "pipeline", "follow", "mcap_file", "experiment"}


def engine_modules(path: Path) -> set[str]:
    tree = ast.parse(path.read_text())
    found = [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    return {name.split(".")[2] for name in found if name.startswith("studio.engine.")}


@pytest.mark.parametrize("path", PANELS, ids=lambda path: path.stem)
def test_only_the_page_itself_touches_what_runs(path: Path) -> None:
    allowed = {"clock"} if path.name == "app.py" else set()
    assert engine_modules(path) & RUNNING <= allowed


@pytest.mark.parametrize("path", PANELS, ids=lambda path: path.stem)
def test_nothing_slow_or_sleeping(path: Path) -> None:
    text = path.read_text()
    assert "update_cfg" not in text
    assert not re.search(r"\bsleep\(", text)
