"""The live loop: it ticks on its own thread, ends cleanly, and a failure is not swallowed."""

import math
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from studio.engine import clock, commands
from studio.engine.clock import LiveLoop
from studio.engine.errors import FileError, StudioError
from studio.engine.live.source import LiveSource
from studio.engine.mcap_file import read_recording
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.session import Session
from studio.engine.snapshot import Mode
from studio.engine.sources.family import Frame
from tests.engine.people import person


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


@pytest.mark.parametrize("rate", [25.0, 60.0])
def test_awaited_frames_leave_the_ticks_at_thirty_a_second(tmp_path, rate: float) -> None:
    live = LiveSource(clock.now)
    live.drive("publisher 1", "studio jsonl")
    with LiveLoop(lambda: Session(tmp_path, live=live)) as loop:
        loop.session.post(commands.UseLive())
        loop.session.post(commands.Watch())
        wait_for(lambda: loop.session.snapshot.mode is Mode.WATCHING)
        begun, before, skipped = time.monotonic(), loop.session.snapshot.time, loop.pace.skipped
        for n in range(int(1.5 * rate)):
            time.sleep(max(0.0, begun + n / rate - time.monotonic()))
            live.put(Frame(n / rate, (person(n / rate),)), clock.now(), True)

        def behind() -> float:
            ticked = loop.session.snapshot.time - before
            ticked += (loop.pace.skipped - skipped) * CONTROL_PERIOD
            return time.monotonic() - begun - ticked

        wait_for(lambda: abs(behind()) < 0.1)  # a busy machine catches up


@pytest.mark.parametrize(
    ("comes", "ticks"),
    [
        (9.0, 10.0 - CONTROL_PERIOD),  # it waited already: at the beginning of the tick's period
        (9.98, 9.98),  # at once
        (11.0, 10.0),  # none came: when the tick is due
    ],
)
def test_an_awaited_frame_brings_its_tick_forward(monkeypatch, comes: float, ticks: float) -> None:
    time_now = [9.5]

    class Waiting:
        def __init__(self, set_at: float) -> None:
            self.set_at = set_at

        def wait(self, timeout: float) -> bool:
            until = max(min(time_now[0] + timeout, self.set_at), time_now[0])
            time_now[0] = until
            return self.set_at <= until

    monkeypatch.setattr(clock, "now", lambda: time_now[0])
    loop = LiveLoop(lambda: None)
    loop._stopping = Waiting(math.inf)
    assert loop._wait_for_tick(SimpleNamespace(awaited=Waiting(comes)), due=10.0)
    assert time_now[0] == pytest.approx(ticks)


def test_ticks_that_are_given_up_are_counted(monkeypatch) -> None:
    """Out of all that were due each was either made or given up, and the pace says which share."""
    time_now, slow = [0.0], [CONTROL_PERIOD / 2]
    monkeypatch.setattr(clock, "now", lambda: time_now[0])
    made = []

    class Slow:
        awaited = None

        def tick(self) -> None:
            made.append(time_now[0])
            time_now[0] += slow[0]

    class Ending:
        def wait(self, timeout: float) -> bool:
            time_now[0] += timeout
            return time_now[0] >= end

    loop = LiveLoop(lambda: None)
    loop._stopping = Ending()
    end = 10.0
    loop._tick_until_stopped(Slow())
    assert (loop.pace.share, loop.pace.skipped) == (1.0, 0)
    slow[0], end = 2 * CONTROL_PERIOD, 40.0
    before = len(made)
    loop._tick_until_stopped(Slow())
    assert loop.pace.skipped + len(made) - before == pytest.approx(30.0 / CONTROL_PERIOD, abs=8)
    assert loop.pace.share == pytest.approx(0.5, abs=0.05)


def test_a_wait_ends_where_it_is_due_or_stopped() -> None:
    stopping = threading.Event()
    due = clock.now() + 0.05
    assert clock.wait_until(due, stopping)
    assert clock.now() >= due
    stopping.set()
    assert not clock.wait_until(clock.now() + 60.0, stopping)


def test_a_program_that_has_the_clock_lets_time_pass(tmp_path: Path) -> None:
    seen: list[float] = []
    with LiveLoop(lambda: Session(tmp_path)) as loop:
        loop.watch(lambda now: seen.append(now.world.time))
        stands, stepped = threading.Event(), threading.Event()
        loop.steps.take(60.0, lambda _: stands.set(), lambda: None)
        assert stands.wait(10.0)
        before = len(seen)
        time.sleep(0.2)
        assert len(seen) == before
        loop.steps.ask(7, lambda _: stepped.set())
        assert stepped.wait(10.0)
        assert len(seen) == before + 7
        loop.steps.give()
        wait_for(lambda: len(seen) > before + 12)
        assert loop.pace.skipped == 0  # the time that stood still was not missed
    assert seen == sorted(set(seen))


def test_it_ends_while_a_program_has_the_clock(tmp_path: Path) -> None:
    with LiveLoop(lambda: Session(tmp_path)) as loop:
        stands = threading.Event()
        loop.steps.take(60.0, lambda _: stands.set(), lambda: None)
        assert stands.wait(10.0)
    assert not any(thread.name == "engine" for thread in threading.enumerate())
