"""The strip that is always in sight."""

from dataclasses import replace

import pytest

from studio.engine.snapshot import Mode
from studio.panels.status import strip, words


@pytest.mark.parametrize("mode", Mode)
def test_every_mode_has_a_word_and_a_shape_of_its_own(lesson, mode: Mode) -> None:
    def shown(mode: Mode) -> str:
        return strip(replace(lesson["playing"], mode=mode))

    assert mode.value.upper() in shown(mode)
    sign = shown(mode).split(mode.value.upper())[0].split(">")[-1].strip()
    assert sign
    assert all(f"{sign} " not in shown(other) for other in Mode if other is not mode)


def test_an_error_is_told_apart_by_a_word(lesson) -> None:
    assert "Problem:" in words(lesson["error"])
    assert "Problem:" not in words(lesson["start"])


def test_messages_are_escaped(lesson) -> None:
    assert "<b>nowhere</b>" not in words(lesson["error"])
    assert "&lt;b&gt;nowhere" in words(lesson["error"])


def test_playing_says_whether_it_was_learned(lesson) -> None:
    assert "Baxter alone" in strip(lesson["playing"])
    assert "a demonstration" in strip(lesson["replaying"])
    assert "Baxter follows" in strip(lesson["armed"])
    assert "Baxter waits" in strip(lesson["lasso"])
