"""What is shown is what was: of recordings the samples, of performances the ticks."""

import numpy as np
import pytest

from studio.engine.films import BUDGET, DemonstrationFilm, LessonFilm, Solo
from studio.engine.moment import performance_at
from studio.engine.performance import SETTLE, joint_columns
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.scene import Scene
from tests.engine.cards_at_hand import sample, take
from tests.engine.lessons_at_hand import alone, lesson


def known(neurons: int = 30) -> Solo:
    return Solo(lesson(neurons), Scene(), alone(neurons))


def test_a_demonstration_is_shown_as_it_was_recorded() -> None:
    film, shown = DemonstrationFilm(take()), take().demonstration
    samples = sample().samples
    assert film.is_ready
    assert film.is_whole
    assert film.world is None
    assert shown.duration < film.duration <= shown.duration + SETTLE + 2 * CONTROL_PERIOD
    for place in (0, 7, 40, len(shown.times) - 1):
        tick = samples[shown.first_sample + place]
        seen = film.at((place + 1) * CONTROL_PERIOD)
        np.testing.assert_allclose(seen.world.joint_positions, tick.world.joint_positions)
        np.testing.assert_allclose(seen.world.block_poses, tick.world.block_poses, atol=1e-12)
        assert seen.ghost is None
    assert film.at(0.3).skeleton is not film.at(0.6).skeleton


def test_what_the_block_does_after_a_demonstration_is_shown_too() -> None:
    film = DemonstrationFilm(take())
    assert not film.at(0.0).world.block_down
    assert film.at(film.duration).world.block_down
    beyond = film.at(film.duration + 99.0).world
    last = film.at(film.duration).world
    np.testing.assert_array_equal(beyond.joint_positions, last.joint_positions)


@pytest.mark.parametrize("time", [0.0, 1.234, 3.0, 99.0])
def test_a_known_performance_is_shown_and_not_simulated(time: float) -> None:
    film = LessonFilm([known()], take())
    assert film.world is None
    assert film.is_whole
    moment = performance_at(alone(), time)
    seen = film.at(time)
    np.testing.assert_array_equal(seen.world.joint_positions, moment.joints)
    np.testing.assert_array_equal(seen.world.block_poses, moment.block_poses)
    assert seen.world.block_down == alone().ticks[moment.index].world.block_down
    assert seen.beside is None


def test_a_new_performance_is_simulated_ahead_of_the_fastest_playhead() -> None:
    film = LessonFilm([Solo(lesson(), Scene()), Solo(lesson(3), Scene())], None)
    assert BUDGET // 2 > 2, "ticks a robot in one of the session's, against two at double speed"
    ticks = 0
    while not film.is_whole:
        film.advance()
        ticks += 1
        assert ticks < 150
    assert film.is_ready
    seen = film.at(2.0)
    np.testing.assert_array_equal(seen.world.joint_positions, performance_at(alone(), 2.0).joints)
    np.testing.assert_array_equal(seen.beside.joint_positions, performance_at(alone(3), 2.0).joints)
    film.close()
    film.world.close()


def test_the_ghost_and_its_person_go_along_at_their_share() -> None:
    film, shown = LessonFilm([known()], take(2)), take(2).demonstration
    half = film.lesson.taught.duration / 2
    seen = film.at(half)
    expected = shown.at(np.array([shown.duration / 2]))[0]
    np.testing.assert_allclose(seen.ghost[joint_columns(shown.joints)], expected)
    middle = (shown.first_sample + shown.last_sample) / 2
    stamps = [s.skeleton.time for s in sample(2).samples[: int(middle) + 2] if s.skeleton]
    assert seen.skeleton.time == pytest.approx(stamps[-1], abs=0.11)
    np.testing.assert_array_equal(film.at(99.0).ghost, film.at(film.duration).ghost)
