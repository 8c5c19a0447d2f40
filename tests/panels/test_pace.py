"""Whether the studio keeps up is said in words and by a shape, and in sight where it does not."""

from studio.engine.pace import Pace
from studio.panels.pace import PaceLine, in_words
from tests.panels.controls import Gui


def test_ticks_that_were_given_up_stay_told() -> None:
    assert in_words(Pace()) == "✔ 30 of 30 ticks a second, none skipped."
    assert "1,234 skipped" in in_words(Pace(1.0, 1234))
    late = in_words(Pace(0.5, 45))
    assert late.startswith("▲ Too busy: 15 of 30")
    assert "45 skipped" in late


def test_who_falls_behind_is_told_at_once() -> None:
    gui = Gui()
    lines = PaceLine(gui, always=False), PaceLine(gui, always=True)
    for pace, seen in ((Pace(), False), (Pace(0.8, 30), True), (Pace(0.99, 30), False)):
        for line in lines:
            line.draw(pace)
        assert [line._line.visible for line in lines] == [seen, True]
