"""``studio webcam``: what is typed reaches the tracker, in an environment of its own."""

import os
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio import webcam_command
from studio.bridges import webcam
from studio.engine.errors import FileError, StudioError
from studio.webcam_command import Webcam

PATHS = st.none() | st.sampled_from([Path("a video.mp4"), Path("--odd"), Path("ü")])


@pytest.fixture
def became(monkeypatch, tmp_path: Path) -> list:
    """What this process would have become: program, arguments, environment."""
    told: list = []
    monkeypatch.delenv("STUDIO_TOKEN", raising=False)
    monkeypatch.setattr(webcam_command, "tracker_python", lambda *_: tmp_path / "python")
    monkeypatch.setattr(os, "execve", lambda *given: told.append(given))
    return told


def test_both_send_to_the_same_address_by_default() -> None:
    assert Webcam().to == webcam.STUDIO


@given(
    given_options=st.builds(
        Webcam,
        camera=st.integers(0, 20),
        video=PATHS,
        to=st.sampled_from(["ws://127.0.0.1:8765", "ws://box:1/?token=a=b"]),
        out=PATHS,
        mirror=st.booleans(),
        speed=st.floats(0, 100),
        loop=st.booleans(),
    )
)
@settings(deadline=None, derandomize=True)
def test_every_option_reaches_the_tracker(given_options: Webcam) -> None:
    tracker, *arguments = given_options.arguments()
    assert tracker == webcam.__file__
    understood = webcam.parse(arguments)
    for name in ("camera", "video", "to", "out", "mirror", "speed", "loop"):
        assert getattr(understood, name) == getattr(given_options, name)


def test_it_becomes_the_tracker(became, tmp_path: Path) -> None:
    Webcam(camera=3).run()
    ((program, arguments, environment),) = became
    assert program == tmp_path / "python"
    assert arguments[:3] == [str(program), "-I", webcam.__file__]
    assert environment == dict(os.environ)


@pytest.mark.parametrize("option", [None, "the option's"])
def test_a_token_goes_where_others_cannot_read_it(became, monkeypatch, option: str | None) -> None:
    monkeypatch.setenv("STUDIO_TOKEN", "the environment's")
    Webcam(token=option).run()
    ((_, arguments, environment),) = became
    assert not any("option's" in each or "environment's" in each for each in arguments)
    assert environment["STUDIO_TOKEN"] == (option or "the environment's")


def test_what_cannot_be_is_told_before_anything_is_set_up(monkeypatch, tmp_path: Path) -> None:
    monkeypatch.setattr(webcam_command, "tracker_python", lambda *_: sys.exit("too early"))
    with pytest.raises(FileError, match="no such file"):
        Webcam(video=tmp_path / "none.mp4").run()
    with pytest.raises(StudioError, match="--to: expected an address such as ws://"):
        Webcam(to="ws://127.0.0.1:notaport").run()
    (tmp_path / "precious").write_text("kept")
    with pytest.raises(FileError, match="precious: is there already"):
        Webcam(out=tmp_path / "precious").run()
    assert (tmp_path / "precious").read_text() == "kept"
