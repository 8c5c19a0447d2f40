"""The house holds: who may import whom, and who may read a clock."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MODULES = sorted((ROOT / "studio").rglob("*.py"))
# The simulated world, and the robot in it: whoever imports them must be the thread that owns it.
PHYSICS = ("studio/engine/world.py", "studio/engine/world_robot.py")


def imports(path: Path) -> Iterator[str]:
    """Yield the full name of everything that a module imports, wherever in it that stands."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are absolute here"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def named(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def within(name: str, *packages: str) -> bool:
    return any(name == package or name.startswith(f"{package}.") for package in packages)


@pytest.mark.parametrize("path", MODULES, ids=named)
def test_layers(path: Path) -> None:
    place = named(path)
    for name in imports(path):
        if place.startswith("studio/rbf/"):
            assert not within(name, "studio") or within(name, "studio.rbf")
        if place.startswith("studio/remote/"):
            assert not within(name, "studio") or within(name, "studio.remote")
        if place.startswith("studio/engine/"):
            assert not within(name, "viser", "studio.panels", "studio.live", "studio.cli")
        if place.startswith("studio/panels/"):
            assert not within(name, "studio.live", "studio.cli")
        else:
            assert not within(name, "viser")
        if place not in PHYSICS:
            assert not within(name, "pybullet", "pybullet_data")
        if place != "studio/engine/parallel.py":  # joblib there runs tasks, and loads no file
            assert not within(name, "joblib")
        assert not within(name, "pickle", "shelve", "marshal", "dill")


def test_rbf_knows_numpy_and_scipy_only() -> None:
    import sys  # noqa: PLC0415

    allowed = {*sys.stdlib_module_names, "numpy", "scipy", "studio"}
    for path in (ROOT / "studio" / "rbf").rglob("*.py"):
        assert {name.split(".")[0] for name in imports(path)} <= allowed


def test_a_program_needs_two_packages_and_nothing_of_the_engine() -> None:
    import sys  # noqa: PLC0415

    allowed = {*sys.stdlib_module_names, "msgspec", "websockets", "studio"}
    for path in (ROOT / "studio" / "remote").rglob("*.py"):
        assert {name.split(".")[0] for name in imports(path)} <= allowed


def test_only_the_live_loop_reads_a_clock() -> None:
    for path in (ROOT / "studio" / "engine").rglob("*.py"):
        clocks = [name for name in imports(path) if within(name, "time", "datetime", "sched")]
        assert not clocks or path.name == "clock.py", named(path)


def test_nothing_is_loaded_by_pickle() -> None:
    for path in MODULES:
        assert "allow_pickle=True" not in path.read_text()


def test_modules_stay_small() -> None:
    """Around 150 lines; twice that is two things in one."""
    lengths = {named(path): len(path.read_text().splitlines()) for path in MODULES}
    assert {name: n for name, n in lengths.items() if n > 300} == {}
    assert sorted(lengths.values())[len(lengths) // 2] <= 180
