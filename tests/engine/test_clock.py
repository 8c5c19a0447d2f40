"""The live loop: it ticks on its own thread, ends cleanly, and a failure is not swallowed."""

import threading
import time
from pathlib import Path

import pytest

from studio.engine import commands
from studio.engine.clock import LiveLoop
from studio.engine.errors import FileError, StudioError
from studio.engine.mcap_file import read_recording
from studio.engine.session import Session
from studio.engine.snapshot import Mode


def wait_for(condition, seconds: float = 20.0) -> None:
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def test_it_ticks_by_itself_and_keeps_what_was_recorded(tmp_path: Path) -> None:
    with LiveLoop(lambda: Session(tmp_path)) as loop:
        loop.session.post(commands.UseDemonstrator())
        loop.session.post(commands.Record())
        wait_for(lambda: loop.session.snapshot.recorded > 10)
        assert loop.session.snapshot.mode is Mode.RECORDING
    assert len(read_recording(tmp_path / "demonstration-001.mcap").samples) > 10
    assert not any(thread.name == "engine" for thread in threading.enumerate())


def test_what_keeps_it_from_starting_is_raised() -> None:
    def fail() -> Session:
        raise FileError("the robot is missing")

    with pytest.raises(FileError, match="the robot is missing"), LiveLoop(fail):
        pass


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_loop_that_ended_says_so(tmp_path: Path) -> None:
    released = threading.Event()

    class Broken(Session):
        def tick(self):
            if released.wait(10.0):
                raise RuntimeError("a bug")

    with LiveLoop(lambda: Broken(tmp_path)) as loop:
        released.set()

        def ended() -> bool:
            try:
                return loop.session is None
            except StudioError:
                return True

        wait_for(ended)
        with pytest.raises(StudioError, match="not running"):
            _ = loop.session
