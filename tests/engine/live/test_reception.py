"""Who drives and who waits, what is answered and how often, without any socket."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.live.reception import (
    ANSWER_EVERY,
    FASTEST,
    FLOOD,
    SILENCE,
    FloodError,
    Reception,
    TokenBucket,
)
from studio.engine.live.source import LiveSource
from tests.engine.live.streaming import Clock, demonstrated, message

FRAMES = demonstrated()


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def live(clock: Clock) -> LiveSource:
    return LiveSource(clock)


@pytest.fixture
def desk(live: LiveSource, clock: Clock) -> Reception:
    return Reception(live, clock)


def test_the_first_to_be_understood_drives(desk: Reception, live: LiveSource) -> None:
    babbler, greeting = desk.welcome("a")
    assert greeting["status"] == "ready"
    assert "error" in desk.receive(babbler, "good morning")
    sensor, _ = desk.welcome("b")
    assert desk.receive(sensor, message(FRAMES[0])) == {
        "status": "driving",
        "protocol": "studio jsonl",
    }
    assert desk.receive(sensor, message(FRAMES[1])) is None
    assert (live.status().driver, live.status().protocol) == ("b", "studio jsonl")


def test_others_wait_and_the_next_takes_over(desk: Reception, live, clock: Clock) -> None:
    first, _ = desk.welcome("first")
    desk.receive(first, message(FRAMES[0]))
    second, greeting = desk.welcome("second")
    assert greeting["status"] == "waiting"
    assert "first drives" in greeting["reason"]
    assert desk.receive(second, message(FRAMES[0])) is None  # it knows already
    assert live.status().counts.waiting == 1
    before = live.status().stream
    desk.leave(first)
    assert live.status().driver == ""
    assert desk.receive(second, message(FRAMES[3], "node-kinect2"))["status"] == "driving"
    assert (live.status().driver, live.status().stream) == ("second", before + 1)


def test_a_silent_driver_loses_its_seat_and_is_told(desk: Reception, live, clock: Clock) -> None:
    first, _ = desk.welcome("first")
    desk.receive(first, message(FRAMES[0]))
    second, _ = desk.welcome("second")
    clock.time += SILENCE - 0.1
    assert desk.receive(second, message(FRAMES[0])) is None
    clock.time += 0.2
    assert desk.receive(second, message(FRAMES[1]))["status"] == "driving"
    assert desk.receive(first, message(FRAMES[1]))["status"] == "waiting"
    assert live.status().driver == "second"
    desk.leave(first)  # changes nothing for who drives
    assert live.status().driver == "second"


def test_garbage_does_not_keep_a_seat(desk: Reception, live, clock: Clock) -> None:
    first, _ = desk.welcome("first")
    second, _ = desk.welcome("second")
    desk.receive(first, message(FRAMES[0]))
    for _ in range(7):
        clock.time += 1.0
        desk.receive(first, "garbage")
    assert desk.receive(second, message(FRAMES[0]))["status"] == "driving"


def test_errors_name_the_place_and_are_not_repeated_at_once(desk: Reception, clock: Clock) -> None:
    sensor, _ = desk.welcome("sensor")
    broken = json.loads(message(FRAMES[0]))
    broken["positions"][3][1] = "high"
    answer = desk.receive(sensor, json.dumps(broken))
    assert "joint 3 (head)" in answer["error"]
    assert desk.receive(sensor, "{") is None
    clock.time += ANSWER_EVERY
    assert "JSON" in desk.receive(sensor, "{")["error"]


def test_a_connection_speaks_one_protocol(desk: Reception, clock: Clock) -> None:
    sensor, _ = desk.welcome("sensor")
    desk.receive(sensor, message(FRAMES[0], "node-kinect2"))
    assert '"bodies"' in desk.receive(sensor, '{"hello": 1}')["error"]


def test_what_comes_late_is_told(desk: Reception) -> None:
    sensor, _ = desk.welcome("sensor")
    desk.receive(sensor, message(FRAMES[5]))
    assert "late" in desk.receive(sensor, message(FRAMES[4]))["error"]


@pytest.mark.parametrize("rate", [200.0, 1000.0, 4000.0])
def test_too_many_are_not_read(desk: Reception, live, clock: Clock, rate: float) -> None:
    sensor, _ = desk.welcome("sensor")
    answers = []
    text = message(FRAMES[0], "node-kinect2")
    for _ in range(int(2 * rate)):
        clock.time += 1 / rate
        answers.append(desk.receive(sensor, text))
    counts = live.status().counts
    read = counts.received - counts.too_fast
    assert 2 * FASTEST <= read <= 2 * FASTEST + 61
    told = [answer["error"] for answer in answers if answer and "error" in answer]
    assert 1 <= len(told) <= 2
    assert "too fast" in told[0]


def test_a_flood_is_sent_away(desk: Reception, clock: Clock) -> None:
    sensor, _ = desk.welcome("sensor")
    for _ in range(int(FLOOD)):
        desk.receive(sensor, "x")
    with pytest.raises(FloodError):
        desk.receive(sensor, "x")


def test_garbage_costs_more_than_frames(desk: Reception, live, clock: Clock) -> None:
    sensor, _ = desk.welcome("sensor")
    for _ in range(3000):
        clock.time += 0.001
        desk.receive(sensor, "garbage")
    assert live.status().counts.unreadable < 3 * FASTEST / 10 + 10


@settings(deadline=None, derandomize=True)
@given(st.lists(st.floats(0.0, 0.5), max_size=200), st.floats(1, 50), st.floats(1, 20))
def test_a_bucket_never_lets_more_through(gaps: list[float], rate: float, burst: float) -> None:
    bucket, now, taken = TokenBucket(rate, burst, 0.0), 0.0, 0
    for gap in gaps:
        now += gap
        taken += bucket.take(now)
    assert taken <= burst + rate * now + 1e-6


@settings(deadline=None, derandomize=True, max_examples=300)
@given(st.data())
def test_mutated_messages_are_answered_never_raised(data) -> None:
    """A small share of the socket's fuzzing; the rest is in the bench."""
    clock = Clock()
    live = LiveSource(clock)
    desk = Reception(live, clock)
    sensor, _ = desk.welcome("sensor")
    kind = data.draw(st.sampled_from(["jsonl", "node-kinect2", "kinectron"]))
    text = message(FRAMES[data.draw(st.integers(0, 60))], kind)
    start = data.draw(st.integers(0, len(text)))
    cut = data.draw(st.integers(0, 60))
    text = text[:start] + data.draw(st.text(max_size=8)) + text[start + cut :]
    answer = desk.receive(sensor, text)
    counts = live.status().counts
    assert answer is not None
    assert (counts.unreadable == 1) is ("error" in answer)
