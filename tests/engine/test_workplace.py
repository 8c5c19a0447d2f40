"""Work in the ticks themselves: the same reports as another process gives, a point a look."""

import pytest

from studio.engine.errors import StudioError
from studio.engine.work import Done, Failed, Progress
from studio.engine.workplace import InTicks
from tests.engine.long_work import Counting, Endless, Failing


def test_a_point_at_every_look() -> None:
    work = InTicks()
    task = Counting(3)
    handle = work.start(task)
    reports = [work.poll() for _ in range(4)]
    assert [type(report) for report in reports] == [Progress, Progress, Done, type(None)]
    assert [len(report.points) for report in reports[:3]] == [1, 2, 3]
    assert reports[2].points[:2] == (0, 1)
    assert all((report.handle, report.task) == (handle, task) for report in reports[:3])
    assert work.task is None


def test_one_thing_at_a_time_until_it_is_canceled() -> None:
    work = InTicks()
    work.start(Endless())
    with pytest.raises(StudioError, match="Cancel brooding first"):
        work.start(Counting(1))
    work.cancel()
    assert (work.task, work.poll()) == (None, None)
    work.start(Counting(1))
    assert isinstance(work.poll(), Done)


def test_what_a_person_can_cure_is_told_in_words() -> None:
    work = InTicks()
    work.start(Failing(curable=True))
    work.poll()
    failed = work.poll()
    assert isinstance(failed, Failed)
    assert failed.words == "Failing came to nothing: record a demonstration first"
    assert failed.points == (1,)
    assert work.task is None


def test_a_fault_of_the_studio_is_not_hidden() -> None:
    work = InTicks()
    work.start(Failing(curable=False))
    work.poll()
    with pytest.raises(ZeroDivisionError):
        work.poll()
    assert (work.task, work.poll()) == (None, None)
