"""Work in another process: all that it finds arrives, cancel is at once, nothing is left over."""

import multiprocessing
import os
import signal
import time
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest

from studio.engine.curves import TrialRun
from studio.engine.errors import StudioError
from studio.engine.teaching import LearnerSettings
from studio.engine.work import REPORT_EVERY, Done, Failed, Progress, Report, Work
from tests.engine.long_work import (
    PATIENCE,
    Counting,
    Endless,
    Failing,
    Slow,
    Surroundings,
    is_gone,
)
from tests.engine.sweeps import samples


@pytest.fixture(scope="module")
def shared() -> Iterator[Work]:
    with Work(time.monotonic) as work:
        yield work


@pytest.fixture
def work(shared: Work) -> Work:
    shared.cancel()
    return shared


def reports_until_over(work: Work) -> list[Report]:
    return until(work, lambda report: not isinstance(report, Progress))


def until(work: Work, enough) -> list[Report]:
    reports: list[Report] = []
    begin = time.monotonic()
    while time.monotonic() - begin < PATIENCE:
        report = work.poll()
        if report is not None:
            reports.append(report)
            if enough(report):
                return reports
        time.sleep(0.005)
    raise AssertionError(f"never over: {reports}")


def test_what_it_finds_is_what_is_found_here(work: Work) -> None:
    task = TrialRun(samples(2), LearnerSettings("rbf", 8))
    handle = work.start(task)
    done = reports_until_over(work)[-1]
    assert isinstance(done, Done)
    assert (done.handle, done.task, len(done.points)) == (handle, task, 1)
    (there,), (here,) = done.points, task.points()
    assert there.lesson.curve == pytest.approx(here.lesson.curve, rel=1e-12)
    assert there.reproduction.performance.block_down == here.reproduction.performance.block_down
    measured = [
        each.reproduction.performance.measured_at(np.linspace(0.0, 3.0, 50))
        for each in (there, here)
    ]
    np.testing.assert_allclose(*measured, atol=1e-9)


def test_no_point_is_lost_and_it_is_another_process(work: Work) -> None:
    work.start(Counting(1000))
    reports = reports_until_over(work)
    *numbers, process = reports[-1].points
    assert numbers == list(range(999))
    assert process != os.getpid()
    for before, after in pairwise(reports):
        assert after.points[: len(before.points)] == before.points
    assert work.poll() is None
    assert work.task is None


def test_the_process_is_kept_for_the_next_task(work: Work) -> None:
    processes = set()
    for _ in range(2):
        work.start(Counting(1))
        processes.add(reports_until_over(work)[-1].points[0])
    assert len(processes) == 1


def test_linear_algebra_takes_one_thread_there_unless_somebody_chose_more(monkeypatch) -> None:
    for chosen, found in ((None, "1"), ("3", "3")):
        if chosen is None:
            monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
        else:
            monkeypatch.setenv("OPENBLAS_NUM_THREADS", chosen)
        with Work(time.monotonic) as work:
            work.start(Surroundings())
            assert reports_until_over(work)[-1].points == (found,)
        assert os.environ.get("OPENBLAS_NUM_THREADS") == chosen


def test_progress_is_told_five_times_a_second_at_most() -> None:
    """By the clock that it was given, here a false one: a look each 10 ms."""
    clock = [0.0]
    with Work(lambda: clock[0]) as work:
        work.start(Slow(60, 0.01))
        told: list[float] = []
        begin = time.monotonic()
        while time.monotonic() - begin < PATIENCE:
            report = work.poll()
            clock[0] += 0.01
            time.sleep(0.01)
            if isinstance(report, Progress):
                told.append(clock[0])
                assert 0.0 < report.share <= 1.0
            elif report is not None:
                break
        assert isinstance(report, Done)
        assert len(told) >= 1
        assert (np.diff(told) >= REPORT_EVERY - 1e-9).all()


def test_cancel_is_at_once_even_if_the_task_does_not_listen(work: Work) -> None:
    work.start(Endless())
    (progress,) = until(work, lambda report: True)
    work.cancel()
    assert is_gone(progress.points[0])
    assert work.task is None
    assert work.poll() is None
    work.cancel()  # nothing to do
    work.start(Counting(3))  # and on it goes, with another process, and none of the old one's words
    done = reports_until_over(work)[-1]
    assert done.points[:2] == (0, 1)
    assert done.points[2] != progress.points[0]


def test_cancel_while_the_process_is_starting(work: Work) -> None:
    for _ in range(3):
        work.cancel()
        work.start(Slow(1, 3600.0))  # nobody waits for that
    work.cancel()
    assert work.poll() is None


def test_a_killed_process_is_said_and_replaced(work: Work) -> None:
    work.start(Endless())
    (progress,) = until(work, lambda report: True)
    os.kill(progress.points[0], signal.SIGKILL)
    failed = reports_until_over(work)[-1]
    assert isinstance(failed, Failed)
    assert "Brooding came to nothing: its process ended" in failed.words
    assert failed.points == progress.points
    work.start(Counting(2))
    assert isinstance(reports_until_over(work)[-1], Done)


def test_a_process_killed_while_idle_is_replaced(work: Work) -> None:
    work.start(Counting(1))
    process = reports_until_over(work)[-1].points[0]
    os.kill(process, signal.SIGKILL)
    time.sleep(0.2)
    work.start(Counting(1))
    assert reports_until_over(work)[-1].points[0] != process


@pytest.mark.parametrize(
    ("curable", "words"),
    [
        (True, "Failing came to nothing: record a demonstration first"),
        (False, "a fault of the studio's own, ZeroDivisionError: nothing to divide by"),
    ],
)
def test_errors_come_in_words_and_the_process_lives(work: Work, curable, words: str) -> None:
    work.start(Failing(curable))
    failed = reports_until_over(work)[-1]
    assert isinstance(failed, Failed)
    assert words in failed.words
    assert failed.points == (1,)
    assert ("Traceback" in failed.details) == (not curable)
    work.start(Counting(1))
    assert isinstance(reports_until_over(work)[-1], Done)


def test_what_cannot_be_sent_fails_in_words(work: Work) -> None:
    work.start(TrialRun(lambda: None, LearnerSettings()))
    failed = reports_until_over(work)[-1]
    assert isinstance(failed, Failed)
    assert "cannot be sent" in failed.words


def test_one_thing_at_a_time(work: Work) -> None:
    task = Slow(1, 5.0)
    work.start(task)
    assert work.task is task
    with pytest.raises(StudioError, match="Cancel waiting first"):
        work.start(Counting(1))


def test_nothing_is_left_after_close() -> None:
    before = set(multiprocessing.active_children())
    work = Work(time.monotonic)
    work.close()  # nothing was begun
    assert set(multiprocessing.active_children()) == before
    work.start(Endless())
    process = until(work, lambda report: True)[0].points[0]
    assert len(set(multiprocessing.active_children()) - before) == 1
    work.close()
    assert is_gone(process)
    assert set(multiprocessing.active_children()) == before
    work.close()
