"""The tracker's environment, with an installer that only pretends."""

import os
import sys
from pathlib import Path

import pytest

from studio import webcam_environment
from studio.engine.errors import StudioError
from studio.webcam_environment import TRACKER, tracker_python

NAME = f"webcam-python{sys.version_info[0]}.{sys.version_info[1]}"


class Installer:
    """Runs commands in pretense, and fails before the one that it is told to."""

    def __init__(self, fails_at: int = -1, error: type[BaseException] = StudioError) -> None:
        self.commands: list[list[str]] = []
        self._fails_at, self._error = fails_at, error

    def __call__(self, command: list[str]) -> None:
        if len(self.commands) == self._fails_at:
            raise self._error("Could not find a version that satisfies mediapipe")
        self.commands.append(command)
        if command[1:3] == ["-m", "venv"]:
            python = Path(command[3]) / "bin" / "python"
            python.parent.mkdir(parents=True)
            python.touch()


@pytest.fixture
def python() -> str:
    if not webcam_environment.PYTHONS[0] <= sys.version_info[:2] <= webcam_environment.PYTHONS[1]:
        pytest.skip("MediaPipe has no wheel for this Python")
    return sys.executable


def test_it_is_made_once_and_says_so_first(python: str, tmp_path: Path) -> None:
    said: list[str] = []
    installer = Installer()
    found = tracker_python(python, tmp_path / "cache", said.append, installer)
    assert found == tmp_path / "cache" / NAME / "bin" / "python"
    assert found.exists()
    assert "310 MB" in said[0]
    assert str(found.parents[1]) in said[0]
    _, install, check = installer.commands
    assert {"--no-deps", str(TRACKER.with_name("webcam-requirements.txt"))} <= set(install)
    assert "make_tracker" in check[-1]
    again = Installer(fails_at=0)
    assert tracker_python(python, tmp_path / "cache", said.append, again) == found
    assert len(said) == 2
    assert len(list((tmp_path / "cache").iterdir())) == 1


@pytest.mark.parametrize("step", [0, 1, 2])
@pytest.mark.parametrize("error", [StudioError, KeyboardInterrupt, OSError])
def test_an_interrupted_setup_leaves_nothing(
    python: str, tmp_path: Path, step: int, error: type[BaseException]
) -> None:
    with pytest.raises((StudioError, KeyboardInterrupt)):
        tracker_python(python, tmp_path, print, Installer(step, error))
    assert list(tmp_path.iterdir()) == []
    tracker_python(python, tmp_path, print, Installer())
    assert [each.name for each in tmp_path.iterdir()] == [NAME]


def test_what_a_killed_setup_left_is_no_environment_and_goes_in_time(
    python: str, tmp_path: Path
) -> None:
    fresh, old = (tmp_path / f"{NAME}-unfinished-{name}" for name in ("fresh", "old"))
    for folder in (fresh, old):
        folder.mkdir()
    os.utime(old, (0, 0))
    installer = Installer()
    tracker_python(python, tmp_path, print, installer)
    assert len(installer.commands) == 3
    assert sorted(tmp_path.iterdir()) == sorted([tmp_path / NAME, fresh])


def test_other_pins_and_a_lost_marker_make_it_anew(python: str, tmp_path: Path, monkeypatch):
    folder = tmp_path / "cache"
    interpreter = tracker_python(python, folder, print, Installer())
    remains = interpreter.parent / "of-the-former"
    remains.touch()
    pins = tmp_path / "pins.txt"
    pins.write_text("mediapipe==0.10.99\n")
    monkeypatch.setattr(webcam_environment, "REQUIREMENTS", pins)
    for _ in range(2):
        installer = Installer()
        assert tracker_python(python, folder, print, installer) == interpreter
        assert len(installer.commands) == 3
        assert not remains.exists()
        assert [each.name for each in folder.iterdir()] == [NAME]
        (folder / NAME / "made-from.txt").unlink()


def test_two_at_once_share_the_first_ones(python: str, tmp_path: Path) -> None:
    class Slow(Installer):
        def __call__(self, command: list[str]) -> None:
            if len(self.commands) == 2:
                (tracker_python(python, tmp_path, print, Installer()).parent / "first").touch()
            super().__call__(command)

    found = tracker_python(python, tmp_path, print, Slow())
    assert (found.parent / "first").exists()
    assert [each.name for each in tmp_path.iterdir()] == [NAME]


def test_each_failure_names_its_cure(python: str, tmp_path: Path) -> None:
    for step, words in ((0, "python3-venv"), (1, "online"), (2, "does not start here")):
        with pytest.raises(StudioError, match=words) as raised:
            tracker_python(python, tmp_path, print, Installer(step))
        assert "Could not find a version" in str(raised.value)


def test_pythons_without_mediapipe(tmp_path: Path) -> None:
    other = tmp_path / "python3.13"
    other.write_text("#!/bin/sh\necho 3 13\n")
    other.chmod(0o755)
    with pytest.raises(StudioError, match=r"Python 3\.9 to 3\.12, and .* is 3\.13.*--python"):
        tracker_python(str(other), tmp_path / "cache", print, Installer())
    with pytest.raises(StudioError, match="no Python that runs"):
        tracker_python(str(tmp_path / "none"), tmp_path / "cache", print, Installer())
    assert not (tmp_path / "cache").exists()


def test_a_command_that_fails_is_told_by_its_last_words() -> None:
    noise = "print('first'); print(); raise SystemExit('the cause')"
    with pytest.raises(StudioError, match="first\nthe cause"):
        webcam_environment.run_quietly([sys.executable, "-c", noise])
    webcam_environment.run_quietly([sys.executable, "-c", "pass"])
