"""The playhead's laws: never outside, never drifting, and the same however often one looks."""

import math

import pytest
from hypothesis import given, settings, strategies

from studio.engine.errors import StudioError
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.timeline import FASTEST, SLOWEST, Timeline

lawful = settings(deadline=None, derandomize=True, max_examples=100)
durations = strategies.one_of(strategies.just(0.0), strategies.floats(1e-3, 600.0))
speeds = strategies.floats(SLOWEST, FASTEST)
clocks = strategies.floats(-1e5, 1e5)
waits = strategies.floats(0.0, 100.0)
touches = strategies.one_of(
    strategies.tuples(strategies.just("scrub"), strategies.floats(-10.0, 700.0)),
    strategies.tuples(strategies.just("step"), strategies.integers(-50, 50)),
    strategies.tuples(strategies.just("at_speed"), speeds),
    strategies.tuples(strategies.just("looping"), strategies.booleans()),
    strategies.sampled_from([("play",), ("pause",), ("toggle",)]),
)


def touched(timeline: Timeline, touch: tuple, now: float) -> Timeline:
    name, *arguments = touch
    return getattr(timeline, name)(*arguments, now)


@given(durations, clocks, strategies.lists(strategies.tuples(waits, touches), max_size=12))
@lawful
def test_it_is_never_outside(duration, now, story) -> None:
    timeline = Timeline(duration)
    for wait, touch in story:
        now += wait
        timeline = touched(timeline, touch, now)
        for look in (now, now + 0.01, now + 1e4, now - 50.0):
            assert 0.0 <= timeline.playhead(look) <= duration


@given(durations, clocks, strategies.lists(strategies.tuples(waits, touches), max_size=8), waits)
@lawful
def test_looking_changes_nothing(duration, now, story, wait) -> None:
    """Two roads to one answer, to the bit: look at the end only, or a hundred times on the way."""
    timeline = Timeline(duration)
    for before, touch in story:
        now += before
        timeline = touched(timeline, touch, now)
    at_once = timeline.playhead(now + wait)
    for k in range(100):
        timeline.playhead(now + wait * k / 100)
        timeline.is_playing(now + wait * k / 100)
    assert timeline.playhead(now + wait) == at_once


@given(
    strategies.integers(1, 20_000),
    strategies.integers(0, 1_000_000),
    strategies.sampled_from([0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0]),
)
@lawful
def test_ticks_add_up_exactly(length, ticks, speed) -> None:
    """In 1/64 s everything is exact in binary: N ticks at speed s are N s ticks, modulo a loop."""
    tick = 1.0 / 64.0
    timeline = Timeline(length * tick).at_speed(speed, 5.0).looping(True, 5.0).play(5.0)
    run = ticks * speed
    expected = run if run <= length else math.fmod(run, length)
    assert timeline.playhead(5.0 + ticks * tick) == expected * tick


def test_a_day_of_looping_does_not_drift() -> None:
    timeline, ticks = Timeline(7.3, loops=True).play(0.0), 30 * 3600 * 24
    shown = timeline.playhead(ticks / 30.0)
    assert shown == pytest.approx(math.fmod(3600 * 24, 7.3), abs=1e-9)


@given(durations, speeds, strategies.booleans(), clocks, waits, speeds, strategies.booleans())
@lawful
def test_changing_speed_or_loop_keeps_the_place(d, speed, loops, now, wait, other, also) -> None:
    timeline = Timeline(d, speed, loops).play(now)
    now += wait
    at, playing = timeline.playhead(now), timeline.is_playing(now)
    faster = timeline.at_speed(other, now)
    assert (faster.playhead(now), faster.speed) == (at, other)
    assert faster.is_playing(now) == playing
    assert timeline.looping(also, now).playhead(now) == at


@given(strategies.floats(1.0, 60.0), speeds, clocks, strategies.floats(0.0, 1.0))
@lawful
def test_scrubbing_while_playing_goes_on_from_there(duration, speed, now, share) -> None:
    timeline = Timeline(duration, speed, loops=True).play(now).scrub(share * duration, now + 0.3)
    assert timeline.playhead(now + 0.3) == share * duration
    assert timeline.is_playing(now + 0.3)
    later = math.fmod(share * duration + 0.5 * speed, duration)
    gap = abs(timeline.playhead(now + 0.8) - later)
    assert min(gap, duration - gap) < 1e-9
    standing = timeline.pause(now + 0.8)
    assert standing.scrub(0.0, now + 1.0).playhead(now + 9.0) == 0.0


@given(strategies.floats(1e-3, 60.0), speeds, clocks)
@lawful
def test_at_the_end_it_pauses_and_play_begins_anew(duration, speed, now) -> None:
    timeline = Timeline(duration, speed).play(now)
    assert timeline.is_playing(now)
    after = now + duration / speed + 1e-3
    assert timeline.playhead(after) == duration
    assert not timeline.is_playing(after)
    again = timeline.play(after)
    assert again.playhead(after) == 0.0
    assert again.is_playing(after)
    assert timeline.toggle(after) == again
    assert not again.toggle(after).is_playing(after)
    looped = timeline.looping(True, after).play(after)  # a loop goes on where it stands
    assert looped.playhead(after) == duration
    assert 0.0 < looped.playhead(after + duration / speed / 2) < duration


@given(clocks, speeds, strategies.booleans(), strategies.lists(touches, max_size=6))
@lawful
def test_without_length_it_stands_at_nothing(now, speed, loops, story) -> None:
    timeline = Timeline(0.0, speed, loops).play(now)
    for touch in story:
        timeline = touched(timeline, touch, now)
        assert timeline.playhead(now + 5.0) == 0.0
        assert not timeline.is_playing(now)


def test_steps_go_from_tick_to_tick() -> None:
    timeline = Timeline(1.0).scrub(0.05, 0.0)  # one tick and a half
    ticks = [timeline.step(n, 0.0).playhead(0.0) / CONTROL_PERIOD for n in (1, 2, -1, -2, 99, -99)]
    assert ticks == pytest.approx([2, 3, 1, 0, 30, 0])
    at = timeline.step(1, 0.0)
    for n in (1, 3, 12):
        there_and_back = at.step(n, 0.0).step(-n, 0.0)
        assert there_and_back.playhead(0.0) == pytest.approx(at.playhead(0.0), abs=1e-12)
    walked = Timeline(20.0)
    for k in range(1, 601):
        walked = walked.step(1, 0.0)
        assert walked.playhead(0.0) == pytest.approx(k / 30, abs=1e-9)
    playing = timeline.play(0.0).step(1, 0.5)
    assert not playing.is_playing(0.5)
    assert playing.playhead(9.0) == pytest.approx(round(0.55 * 30 - 0.5) / 30 + 1 / 30)


def test_something_else_begins_paused_at_its_beginning() -> None:
    other = Timeline(3.0, 2.0, loops=True).play(0.0).lasting(5.0)
    assert other == Timeline(5.0, 2.0, loops=True)
    assert not other.is_playing(1.0)


def test_a_clock_that_runs_back_moves_nothing() -> None:
    timeline = Timeline(3.0).play(10.0)
    assert timeline.playhead(2.0) == 0.0


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: Timeline(-1.0),
        lambda: Timeline(math.nan),
        lambda: Timeline(1.0, speed=2.1),
        lambda: Timeline(1.0, speed=math.nan),
        lambda: Timeline(1.0, touched=1.5),
        lambda: Timeline(1.0, running_since=math.inf),
        lambda: Timeline(1.0).scrub(math.nan, 0.0),
        lambda: Timeline(1.0).play(math.inf),
        lambda: Timeline(1.0).play(0.0).playhead(math.nan),
    ],
)
def test_nonsense_is_refused(wrong) -> None:
    with pytest.raises(StudioError):
        wrong()
