"""What goes wrong on the page is told, logged once, and ends nothing else."""

import logging

import pytest

from studio.engine.errors import StudioError
from studio.panels.trouble import SHOWN, TroubleLine
from tests.panels.controls import Gui


@pytest.fixture
def gui() -> Gui:
    return Gui()


@pytest.fixture
def line(gui: Gui) -> TroubleLine:
    return TroubleLine(gui)


def faulty() -> None:
    raise ZeroDivisionError("<b>by nothing</b>")


def refused() -> None:
    raise StudioError("model.json is gone")


def test_work_is_done(line: TroubleLine, gui: Gui) -> None:
    done = []
    line.attempt(lambda: done.append(1))
    line.draw()
    assert done == [1]
    assert gui.words == ""


def test_a_fault_is_told_each_time_and_traced_once(line: TroubleLine, gui: Gui, caplog) -> None:
    for _ in range(30):
        line.attempt(faulty)
    line.draw()
    assert "Internal fault: ZeroDivisionError: &lt;b&gt;by nothing" in gui.words
    assert "reload it" in gui.words
    assert "holds still" not in gui.words  # of the page's fault the robot knows nothing
    (record,) = caplog.records
    assert record.levelno == logging.ERROR
    assert record.exc_info[0] is ZeroDivisionError


def test_an_error_in_words_is_no_fault(line: TroubleLine, gui: Gui, caplog) -> None:
    line.attempt(refused)
    line.draw()
    assert "model.json is gone" in gui.words
    assert caplog.records == []


def test_it_goes_when_nothing_was_wrong_for_a_while(line: TroubleLine, gui: Gui, caplog) -> None:
    line.attempt(refused)
    shown = 0
    line.draw()
    while gui.words and shown < 2 * SHOWN:
        line.draw()
        shown += 1
        if shown == SHOWN // 2:
            line.attempt(faulty)  # the newest counts
    assert shown == SHOWN // 2 + SHOWN
