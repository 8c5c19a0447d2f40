"""The page's server: where it says it is, silent, and true when the engine ends."""

import socket
import time
import urllib.request
from pathlib import Path

import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.clock import LiveLoop
from studio.engine.session import Session
from studio.panels.app import App

PLAIN = 0.02  # [m] the robot's detail: making it light takes the longer the finer


@pytest.fixture
def loop(tmp_path: Path, request: pytest.FixtureRequest):
    with LiveLoop(lambda: Session(tmp_path), getattr(request, "param", 1.0)) as running:
        yield running


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def test_the_page_answers_on_loopback_only(loop, capfd: pytest.CaptureFixture[str]) -> None:
    with App(loop, port=free_port(), detail=PLAIN) as app:
        assert app.url.startswith("http://127.0.0.1:")
        with urllib.request.urlopen(app.url, timeout=20) as answer:
            assert answer.status == 200
            assert b"<html" in answer.read().lower()
    assert capfd.readouterr().out == ""  # standard output belongs to the commands


def test_a_busy_port_is_left_alone(loop) -> None:
    with socket.socket() as busy:
        busy.bind(("127.0.0.1", free_port()))
        busy.listen()
        taken = busy.getsockname()[1]
        with App(loop, port=taken, detail=PLAIN) as app:
            port = int(app.url.rsplit(":", 1)[1])
            assert port != taken
            with urllib.request.urlopen(app.url, timeout=20) as answer:
                assert answer.status == 200


@pytest.mark.parametrize("loop", [10.0], indirect=True)
def test_all_is_drawn_from_teaching_to_playing_without_a_browser(loop) -> None:
    """Every panel draws every state; an error on the drawing thread would fail this test."""
    from studio.engine.teaching import LearnerSettings  # noqa: PLC0415

    session = loop.session

    def until(reached, what: str) -> None:
        deadline = time.monotonic() + 60.0
        while not reached(session.snapshot):
            assert time.monotonic() < deadline, f"never {what}: {session.snapshot.message.text}"
            time.sleep(0.01)

    with App(loop, port=free_port(), detail=PLAIN) as app:
        app.scene.wait()
        session.post(commands.UseDemonstrator())
        session.post(commands.Record())
        until(lambda now: now.entries, "taught")
        session.post(commands.Train(LearnerSettings("rbf", 20)))
        until(lambda now: now.lesson is not None, "trained")
        session.post(commands.PlayReproduction())
        until(lambda now: now.reproduction is not None, "played")
        session.post(commands.Configure(Choices("right", "paper", "open")))
        session.post(commands.Watch())
        until(lambda now: now.gate is not None and now.gate.armed, "armed")
        session.post(commands.Stop())
        session.post(commands.Remove(1))
        until(lambda now: not now.entries, "removed")
        assert not app.scene.lacks_meshes
