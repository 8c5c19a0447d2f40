"""The page's server: where it says it is, silent, and true when the engine ends."""

import logging
import socket
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.clock import LiveLoop
from studio.engine.pace import Pace
from studio.engine.session import Session
from studio.panels import app as app_module
from studio.panels.app import App
from tests.browser.opened import NoScene

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
def test_all_is_drawn_from_teaching_to_playing_without_a_browser(
    loop, caplog: pytest.LogCaptureFixture
) -> None:
    """Every panel draws every state; a fault in one of them would be logged."""
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
        before = app.scene._person._bones.colors.sum()
        app.page._view.toggle()
        until(lambda _: app.scene._person._bones.colors.sum() > before, "dark")
        session.post(commands.PlayReproduction())
        until(lambda now: now.reproduction is not None, "played")
        session.post(commands.Configure(Choices("right", "paper", "open")))
        session.post(commands.Watch())
        until(lambda now: now.gate is not None and now.gate.armed, "armed")
        session.post(commands.Stop())
        session.post(commands.Remove(1))
        until(lambda now: not now.entries, "removed")
        assert not app.scene.lacks_meshes
    assert errors(caplog) == []


def errors(caplog: pytest.LogCaptureFixture) -> list[logging.LogRecord]:
    return [record for record in caplog.records if record.levelno >= logging.ERROR]


def soon(reached: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 20.0
    while not reached():
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.fixture
def session(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(app_module, "SceneView", NoScene)
    made = Session(tmp_path)
    made.tick()
    yield made
    made.close()


def first_panel(app: App) -> object:
    return app.page._always[0]  # state and Stop, before the messages


def test_the_scene_is_as_dark_as_the_page(session, monkeypatch: pytest.MonkeyPatch) -> None:
    shades: list[bool] = []
    monkeypatch.setattr(NoScene, "shade", lambda _, is_dark: shades.append(is_dark))
    with App(SimpleNamespace(session=session, pace=Pace()), port=0) as app:
        soon(lambda: shades[-1:] == [False])
        app.page._view.toggle()
        soon(lambda: shades[-1:] == [True])


@pytest.mark.parametrize("part", [lambda app: app.scene, first_panel, lambda app: app.page.steps])
@pytest.mark.parametrize("times", [1, 10**9])
def test_a_fault_in_one_part_is_told_and_ends_nothing_else(
    session, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, part, times: int
) -> None:
    """Once, or every time: all other parts go on being drawn, and the log holds it once."""
    raised = 0

    with App(SimpleNamespace(session=session, pace=Pace()), port=0) as app:
        page, broken = app.page, part(app)
        method = "draw" if hasattr(broken, "draw") else "is_open"
        real = getattr(broken, method)

        def fault(*given: object) -> object:
            nonlocal raised
            raised += 1
            if raised <= times:
                raise ZeroDivisionError("in a panel")
            return real(*given)

        monkeypatch.setattr(broken, method, fault)
        soon(lambda: page.trouble._line.visible)
        assert "Internal fault: ZeroDivisionError: in a panel" in page.trouble._line.content
        session.post(commands.UseDemonstrator())
        told = session.tick().message.text
        soon(lambda: told in page.messages._words.content)
        seen = raised
        soon(lambda: raised > seen + 3)  # the drawing goes on
        assert app._drawing.is_alive()
    (record,) = errors(caplog)
    assert record.exc_info[0] is ZeroDivisionError


def test_an_export_is_sent_beside_the_drawing(
    session, caplog: pytest.LogCaptureFixture, tmp_path: Path
) -> None:
    """A file that has gone by then is told on the page, and is no fault."""
    with App(SimpleNamespace(session=session, pace=Pace()), port=0) as app:
        app.page._export._deliver((tmp_path / "gone.csv",))
        soon(lambda: "gone.csv of the last export was not sent" in app.page.trouble._line.content)
    assert errors(caplog) == []
