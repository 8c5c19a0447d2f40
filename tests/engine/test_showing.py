"""The playhead of a session: its ticks are its clock, and it says once when all has been seen."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.errors import StudioError
from studio.engine.films import Seen
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.showing import Show
from studio.engine.snapshot import Mode
from studio.engine.timeline import Timeline

LENGTH = 30 * CONTROL_PERIOD


@dataclass
class Film:
    """Remembers what was looked at; ready and whole when told."""

    is_ready: bool = True
    is_whole: bool = True
    duration: float = LENGTH
    motion: float = LENGTH / 2
    title: str = "made up"
    words: str = ""
    world: None = None
    advanced: int = 0
    looked: list[float] = field(default_factory=list)

    def advance(self) -> None:
        self.advanced += 1

    def at(self, time: float) -> Seen:
        self.looked.append(time)
        return Seen(None, f"guard at {time:.3f}")

    def close(self) -> None:
        self.title = "closed"


def ticks(show: Show, count: int) -> Iterator[float]:
    for _ in range(count):
        assert show.step()
        yield show.time


def test_it_plays_in_step_with_the_ticks_and_ends_once() -> None:
    show = Show(Film(), Timeline(), None)
    assert show.mode is Mode.PLAYING
    times, through = [], 0
    for time in ticks(show, 40):
        times.append(time)
        through += show.is_through
        assert show.guarded == f"guard at {time:.3f}"
    expected = np.minimum(np.arange(40) * CONTROL_PERIOD, LENGTH)
    np.testing.assert_allclose(times, expected, atol=1e-9)
    assert through == 1
    assert show.mode is Mode.IDLE
    show.steer(commands.TogglePlay())
    list(ticks(show, 40))
    assert not show.is_through


def test_it_waits_for_its_film_and_is_not_through_before_that_is_whole() -> None:
    film = Film(is_ready=False, is_whole=False)
    show = Show(film, Timeline(), None)
    assert set(ticks(show, 5)) == {0.0}
    assert show.mode is Mode.PLAYING
    film.is_ready = True
    assert list(ticks(show, 3))[-1] == pytest.approx(2 * CONTROL_PERIOD)
    show.steer(commands.Scrub(99.0))
    list(ticks(show, 2))
    assert not show.is_through
    film.is_whole = True
    list(ticks(show, 1))
    assert show.is_through
    assert film.advanced == 11


@pytest.mark.parametrize("speed", [0.25, 0.5, 2.0])
def test_speed_changes_how_fast_it_goes_from_where_it_is(speed: float) -> None:
    show = Show(Film(), Timeline(), None)
    at = list(ticks(show, 8))[-1]
    show.steer(commands.SetSpeed(speed))
    assert list(ticks(show, 4))[-1] == pytest.approx(at + 4 * speed * CONTROL_PERIOD)


def test_a_loop_begins_anew_and_says_so_once() -> None:
    show = Show(Film(), Timeline(loops=True), None)
    through = sum(show.is_through for _ in ticks(show, 100))
    assert through == 1
    assert show.mode is Mode.PLAYING
    assert show.time < LENGTH


def test_going_back_by_hand_is_no_end() -> None:
    show = Show(Film(), Timeline(), None)
    list(ticks(show, 20))
    show.steer(commands.Scrub(0.1))
    list(ticks(show, 1))
    assert not show.is_through
    assert show.time == pytest.approx(0.1 + CONTROL_PERIOD)


def test_steps_are_ticks_and_pause() -> None:
    show = Show(Film(), Timeline(), None)
    list(ticks(show, 11))
    for by, place in ((1, 11), (-3, 8), (-99, 0), (2, 2)):
        show.steer(commands.StepBy(by))
        list(ticks(show, 3))
        assert show.time == pytest.approx(place * CONTROL_PERIOD)
        assert show.mode is Mode.IDLE


def test_pausing_says_so_once_and_keeps_all_in_place() -> None:
    show = Show(Film(), Timeline(), None)
    at = list(ticks(show, 5))[-1]
    assert show.pause() == "Stopped."
    assert show.pause() == ""
    assert set(ticks(show, 5)) == {at}
    show.close()
    assert show.film.title == "closed"


def test_the_next_show_takes_over_speed_and_loop_but_not_the_place() -> None:
    first = Show(Film(), Timeline(speed=0.5, loops=True), None)
    list(ticks(first, 20))
    second = Show(Film(duration=1.0), first.timeline, None)
    assert (second.timeline.speed, second.timeline.loops, second.time) == (0.5, True, 0.0)


def test_an_impossible_speed_is_refused_and_nothing_changes() -> None:
    show = Show(Film(), Timeline(), None)
    with pytest.raises(StudioError, match="speed"):
        show.steer(commands.SetSpeed(7.0))
    assert show.timeline.speed == 1.0
