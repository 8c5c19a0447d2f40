"""The live stream in words: the cure where nobody sends, every count, every link measured."""

from dataclasses import replace

import pytest

from studio.engine.live.latency import LatencyChain, Spread
from studio.engine.live.status import Counts, LiveStatus
from studio.engine.snapshot import SourceStatus
from studio.panels.readiness import next_step, why_not_teach
from studio.panels.source import described as source_described
from studio.panels.status import strip
from studio.panels.streams import described, instructions

NOBODY = LiveStatus(address="ws://127.0.0.1:8765")
FLOWING = replace(
    NOBODY,
    publishers=1,
    driver="publisher 3 (127.0.0.1:50123)",
    protocol="node-kinect2",
    stream=2,
    rate=29.97,
    age=0.012,
    counts=Counts(received=1234, used=1000, dropped=200, late=30, too_fast=4),
    latency=LatencyChain(waiting=Spread(0.0012, 0.0034), total=Spread(0.0101, 0.0222)),
)
LIVE = SourceStatus("live stream", 1234, 0.0, has_hand_states=True, is_live=True)


def test_where_no_streams_are_taken_nothing_is_said() -> None:
    assert described(None) == ""


def test_nobody_sends_and_the_cure_is_said() -> None:
    words = described(NOBODY)
    assert "Nobody sends yet" in words
    assert "studio play FILE --to ws://127.0.0.1:8765" in words
    assert "table" not in words


def test_who_drives_and_what_became_of_it() -> None:
    words = described(FLOWING)
    for said in ("publisher 3", "node-kinect2", "30 frames a second", "1,234 messages", "30 late"):
        assert said in words
    assert "unreadable" not in words  # none were
    for figure in ("1.2", "3.4", "10.1", "22.2"):
        assert f">{figure}<" in words
    assert "from the sensor" not in words  # not known without stamps


@pytest.mark.parametrize(
    ("live", "words"),
    [
        (replace(FLOWING, rate=0.0), "has stopped sending"),
        (replace(NOBODY, publishers=2), "2 connected"),
        (replace(NOBODY, publishers=1), "has not sent a frame yet"),
    ],
)
def test_states_in_between(live: LiveStatus, words: str) -> None:
    live = replace(live, counts=Counts(received=1, unreadable=1))
    assert words in described(live)


def test_what_publishers_say_is_escaped() -> None:
    assert "<b>me" not in described(replace(FLOWING, driver="<b>me</b>"))


def test_a_newcomer_is_led_to_the_stream(lesson) -> None:
    start = lesson["start"]
    assert "live stream" in next_step(replace(start, live=FLOWING))
    assert "1 Source: choose" in next_step(replace(start, live=NOBODY))
    chosen = replace(start, live=NOBODY, source=LIVE)
    assert "let a sensor send" in next_step(chosen)
    assert "Record" in next_step(replace(chosen, live=FLOWING))
    assert why_not_teach(chosen) == ""  # Baxter may wait for who comes


def test_a_source_without_an_end_has_no_length(lesson) -> None:
    assert "until Stop" in source_described(replace(lesson["start"], source=LIVE))
    assert " of 0 s" not in strip(replace(lesson["armed"], duration=0.0))


def test_rate_and_losses_are_said_with_a_shape() -> None:
    """Dropped, late and too fast: 234 of 1,234 messages never moved Baxter."""
    words = described(FLOWING)
    assert "● <b>30 frames/s</b>" in words
    assert "▲ <b>234 lost</b> (19.0%)" in words
    assert "✔ <b>0 lost</b>" in described(replace(FLOWING, counts=Counts(received=9, used=9)))
    assert "○ <b>nothing comes in</b>" in described(NOBODY)


def test_the_commands_to_copy_send_to_this_studio() -> None:
    assert ">studio webcam</code>" in instructions(NOBODY)
    elsewhere = replace(NOBODY, address="ws://127.0.0.1:8770")
    assert ">studio webcam --to ws://127.0.0.1:8770</code>" in instructions(elsewhere)
    assert ">studio play FILE --to ws://127.0.0.1:8770</code>" in instructions(elsewhere)
    assert instructions(None) == ""
