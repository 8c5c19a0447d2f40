"""The strip that is always in sight."""

import math
from dataclasses import replace

import pytest

from studio.engine.live.latency import LatencyChain, Spread
from studio.engine.live.status import LiveStatus
from studio.engine.pipeline import Lag
from studio.engine.snapshot import Mode, SourceStatus
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
    assert "Baxter comes to you" in strip(lesson["coming"])
    assert "Baxter follows" in strip(lesson["armed"])
    assert "Baxter waits" in strip(lesson["lasso"])


def test_how_far_it_is_behind_is_told_while_it_follows(lesson) -> None:
    following = replace(lesson["armed"], lag=Lag(math.radians(12.0), 0.14))
    assert "12°, 0.1 s behind" in strip(following)
    assert "behind" not in strip(lesson["lasso"])


def test_live_the_way_from_frame_to_command_is_told(lesson) -> None:
    live = LiveStatus(latency=LatencyChain(total=Spread(0.0042, 0.03)))
    source = SourceStatus("live stream", 10, 0.0, has_hand_states=True, is_live=True)
    following = replace(lesson["armed"], live=live, source=source)
    assert "4 ms to command" in strip(following)
    assert "to command" not in strip(replace(following, source=lesson["armed"].source))
    assert "to command" not in strip(replace(following, live=LiveStatus()))
