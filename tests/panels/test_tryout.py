"""Test many times, on the page: its button, how far it is, what came of it, and why not."""

from dataclasses import replace

import pytest

from studio.engine import commands
from studio.engine.evaluate.interval import rate_of
from studio.engine.evaluate.tryout import TryoutStatus
from studio.engine.learning_status import Underway
from studio.panels.tryout import TRIALS, TryoutPart, told, why_not_test
from tests.panels.controls import Gui


@pytest.fixture
def gui() -> Gui:
    return Gui()


def status(now, successes: int, trials: int, goes_on: bool = False) -> TryoutStatus:
    failures = (("the <block> still stands", trials - successes),) if trials > successes else ()
    rates = rate_of(successes, trials), rate_of(trials, trials)
    return TryoutStatus(now.lesson, TRIALS, *rates, failures, goes_on)


def test_buttons_ask_for_what_they_say(gui) -> None:
    posted: list[commands.Command] = []
    TryoutPart(gui, posted.append)
    gui["Test 100 times"].press()
    gui["Cancel the test"].press()
    assert posted == [commands.TryOut(100), commands.CancelWork()]


def test_without_a_lesson_it_says_why_not(gui, lesson) -> None:
    part = TryoutPart(gui, lambda _: None)
    part.draw(lesson["start"])
    assert gui["Test 100 times"].disabled
    assert "press Train in 3 Learn" in gui.words
    part.draw(lesson["played"])
    assert not gui["Test 100 times"].disabled
    assert gui.words.strip() == ""


def test_what_else_is_being_computed_is_named(lesson) -> None:
    now = lesson["played"]
    busy = replace(now.learning, underway=Underway("training 50 neurons", None))
    assert "Cancel in 3 Learn: training 50 neurons goes on" in why_not_test(
        replace(now, learning=busy)
    )
    testing = replace(now, learning=busy, tryout=status(now, 1, 2, goes_on=True))
    assert why_not_test(testing) == ""


def test_while_it_goes_on_the_bar_grows_and_it_can_be_canceled(gui, lesson) -> None:
    part, now = TryoutPart(gui, lambda _: None), lesson["played"]
    part.draw(replace(now, tryout=TryoutStatus(now.lesson, TRIALS, goes_on=True)))
    assert gui.bars[0].visible
    assert gui.bars[0].value == 0
    assert "on their way" in gui.words
    part.draw(replace(now, tryout=status(now, 30, 40, goes_on=True)))
    assert gui.bars[0].value == 40
    assert gui["Cancel the test"].visible
    assert gui["Test 100 times"].disabled
    assert "(40 of 100 trials)" in gui.words
    part.draw(replace(now, tryout=status(now, 90, 100)))
    assert not gui.bars[0].visible
    assert not gui["Cancel the test"].visible


def test_rates_intervals_and_reasons_are_told(lesson) -> None:
    words = told(status(lesson["played"], 87, 100))
    for part in ("87 %", "79 to 92 %", "100 %", "96 to 100 %", "demonstrations&#x27; replays"):
        assert part in words
    assert "13 × the &lt;block&gt; still stands." in words


def test_what_was_tested_before_is_not_told_of_what_is_learned_now(gui, lesson) -> None:
    part, now = TryoutPart(gui, lambda _: None), lesson["played"]
    older = replace(status(now, 87, 100), lesson=lesson["trained on one"].lesson)
    part.draw(replace(now, tryout=older))
    assert "87 %" not in gui.words
