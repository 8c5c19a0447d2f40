"""The timeline's controls: what they ask for, and that they never fight with who uses them."""

from dataclasses import replace

import pytest

from studio.engine import commands
from studio.panels.timeline import (
    BACK,
    END,
    ON,
    PAUSE,
    PLAY,
    SPEEDS,
    START,
    TimelinePanel,
    nearest,
    title,
)
from tests.panels.controls import Gui


def panel() -> tuple[TimelinePanel, Gui, list[commands.Command]]:
    gui, posted = Gui(), []
    return TimelinePanel(gui, posted.append), gui, posted


def test_with_nothing_to_play_it_says_what_play_would_do(lesson) -> None:
    for state, words in (
        ("start", "Nothing to play yet: record a demonstration in 2 Teach."),
        ("recorded", "Play shows the chosen demonstration again."),
        ("trained", "Play lets Baxter do alone what it learned."),
        ("recording", "Somebody teaches"),
    ):
        timeline, gui, _ = panel()
        timeline.draw(lesson[state])
        assert words in gui.words
        assert gui["Time [s]"].disabled


def test_the_slider_follows_the_playhead_and_the_button_its_state(lesson) -> None:
    timeline, gui, _ = panel()
    now = lesson["halfway"]
    timeline.draw(now)
    slider = gui["Time [s]"]
    assert slider.value == pytest.approx(now.time, abs=0.01)
    assert slider.max == pytest.approx(now.duration, abs=0.01)
    assert not slider.disabled
    assert PAUSE in gui["Go"].options
    timeline.draw(lesson["played"])
    assert slider.value == slider.max
    assert PLAY in gui["Go"].options
    told = len(slider.told)
    timeline.draw(lesson["played"])
    assert [name for name in slider.told[told:] if name != "disabled"] == []


@pytest.mark.parametrize(
    ("button", "order"),
    [
        (PLAY, commands.TogglePlay()),
        (PAUSE, commands.TogglePlay()),
        (BACK, commands.StepBy(-1)),
        (ON, commands.StepBy(1)),
        (START, commands.Scrub(0.0)),
    ],
)
def test_each_button_asks_for_what_it_says(lesson, button: str, order: commands.Command) -> None:
    timeline, gui, posted = panel()
    timeline.draw(lesson["halfway"])
    gui["Go"].press(button)
    assert posted == [order]


def test_the_end_is_that_of_what_is_shown(lesson) -> None:
    timeline, gui, posted = panel()
    timeline.draw(lesson["halfway"])
    gui["Go"].press(END)
    assert posted == [commands.Scrub(pytest.approx(lesson["halfway"].duration, abs=0.01))]


def test_while_somebody_drags_the_slider_it_is_theirs(lesson) -> None:
    timeline, gui, posted = panel()
    now = lesson["halfway"]
    timeline.draw(now)
    gui["Time [s]"].press(1.25)
    assert posted == [commands.Scrub(1.25)]
    for _ in range(3):
        timeline.draw(now)
        assert gui["Time [s]"].value == 1.25
    for _ in range(2):
        timeline.draw(now)
    assert gui["Time [s]"].value == pytest.approx(now.time, abs=0.01)


def test_speed_and_loop_are_the_sessions_own(lesson) -> None:
    timeline, gui, posted = panel()
    now = lesson["halfway"]
    status = replace(now.compare.timeline, speed=0.25, loops=True)
    timeline.draw(replace(now, compare=replace(now.compare, timeline=status)))
    assert (gui["Speed"].value, gui["Loop"].value) == ("0.25x", True)
    gui["Speed"].press("2x")
    gui["Loop"].press(False)
    assert posted == [commands.SetSpeed(2.0), commands.SetLoop(False)]


def test_the_speeds_offered_reach_from_a_quarter_to_twice() -> None:
    assert min(SPEEDS.values()) == 0.25
    assert max(SPEEDS.values()) == 2.0
    assert nearest(0.97) == "1x"
    for name, speed in SPEEDS.items():
        assert nearest(speed) == name


def test_what_is_shown_is_named_as_words_and_not_as_html(lesson) -> None:
    now = lesson["halfway"]
    status = replace(now.compare.timeline, title="<b>mine</b>")
    words = title(replace(now, compare=replace(now.compare, timeline=status)))
    assert "&lt;b&gt;mine" in words
    assert "▶" in words
    assert "❚❚" in title(lesson["played"])
