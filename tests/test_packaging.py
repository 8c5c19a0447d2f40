"""From a wheel, an editable install, or a clone: the data are there, and nobody's recordings."""

import os
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PRIVATE = "recordings/demonstration-007.mcap"
BRIDGES = ("webcam.py", "webcam-requirements.txt", "kinect.py")  # run by path, imported by nobody


def run(*command: str | Path, cwd: Path, **environment: str) -> str:
    done = subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env={name: v for name, v in os.environ.items() if name != "PYTHONPATH"} | environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def clone(tmp_path_factory) -> Path:
    """Return a copy of the project in which a user has recorded something."""
    copy = tmp_path_factory.mktemp("clone") / "project"
    unwanted = shutil.ignore_patterns(".git", ".venv", "__pycache__", ".*_cache", ".hypothesis")
    shutil.copytree(ROOT, copy, ignore=unwanted)
    (copy / PRIVATE).write_bytes(b"what a user did at home")
    return copy


@pytest.fixture(scope="module")
def wheel(clone: Path) -> Path:
    run(
        sys.executable,
        "-m",
        "build",
        "--wheel",
        "--no-isolation",
        "--outdir",
        "dist",
        ".",
        cwd=clone,
    )
    (built,) = (clone / "dist").glob("*.whl")
    return built


def test_the_wheel_has_the_data_and_no_users_recording(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    assert not [name for name in names if "demonstration-007" in name]
    assert not [name for name in names if name.startswith(("tests/", "recordings/"))]
    for name in ("urdf/baxter.urdf", "seeds/table1.csv", "recordings/samples/never-arms.jsonl"):
        assert f"studio/data/{name}" in names
    assert {f"studio/bridges/{name}" for name in BRIDGES} <= set(names)
    assert [name for name in names if name.endswith("licenses/NOTICE")]


# Prints where the data are, whether the samples are among them, and where recordings would go.
PROBE = """
from studio.engine.resources import recordings_folder, resource_root, samples_folder
from studio.engine.robot import load_robot
load_robot()
print(resource_root(), len(list(samples_folder().glob("*.mcap"))), recordings_folder(), sep="|")
"""


def test_a_wheel_works_from_any_folder(wheel: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    zipfile.ZipFile(wheel).extractall(site)
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    where = {"PYTHONPATH": str(site), "XDG_DATA_HOME": str(tmp_path / "home")}
    found = run(sys.executable, "-c", PROBE, cwd=elsewhere, **where).strip().split("|")
    assert found == [
        str(site / "studio" / "data"),
        "4",
        str(tmp_path / "home" / "teaching-studio" / "recordings"),
    ]
    shown = run(sys.executable, "-m", "studio", "--version", cwd=elsewhere, **where)
    assert shown.startswith("studio ")


def test_a_clone_works_by_python_dash_m(clone: Path) -> None:
    found = run(sys.executable, "-c", PROBE, cwd=clone).strip().split("|")
    assert found == [str(clone), "4", str(clone / "recordings")]
    sample = Path("recordings") / "samples" / "demonstration-1.mcap"
    assert "studio mcap" in run(sys.executable, "-m", "studio", "inspect", sample, cwd=clone)


def test_an_editable_install_works_from_any_folder(clone: Path, tmp_path: Path) -> None:
    venv.create(tmp_path / "venv", with_pip=False, symlinks=True)
    python = tmp_path / "venv" / "bin" / "python"
    site = Path(
        run(
            python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=tmp_path
        ).strip()
    )
    (site / "dependencies.pth").write_text(sysconfig.get_path("purelib"))
    run(
        *(sys.executable, "-m", "pip", "--python", python, "install", "--quiet"),
        *("--no-deps", "--no-build-isolation", "--no-index", "--editable", clone),
        cwd=tmp_path,
    )
    found = run(python, "-c", PROBE, cwd=tmp_path).strip().split("|")
    assert found == [str(clone), "4", str(clone / "recordings")]
    shown = run(tmp_path / "venv" / "bin" / "studio", "--version", cwd=tmp_path)
    assert shown.startswith("studio ")
