"""Comparing in a session: nothing is simulated twice, the block stands where it was put."""

from pathlib import Path

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.films import LessonFilm, Solo
from studio.engine.performance import SETTLE, in_guards_words
from studio.engine.scene import Scene
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings
from tests.engine.cards_at_hand import take, takes
from tests.engine.lessons_at_hand import alone, held_off, lesson
from tests.engine.sessions import do


@pytest.fixture
def session(tmp_path: Path):
    made = Session(tmp_path)
    yield made
    made.close()


@pytest.fixture
def taught(session: Session) -> Session:
    """A session with two demonstrations, and a network of 30 neurons."""
    session._listed.add(takes(2))
    session._learning.lesson = lesson()
    session.tick()
    return session


def until(session: Session, mode: Mode, most: int = 400) -> Snapshot:
    for _ in range(most):
        if session.tick().mode is mode:
            return session.snapshot
    raise AssertionError(f"never {mode}: {session.snapshot.message.text}")


def played(session: Session) -> Snapshot:
    """Play the reproduction to its end, however long that takes."""
    do(session, commands.PlayReproduction())
    for _ in range(200):  # until all is simulated
        now = session.tick()
        if now.compare.playing[-1].performance is not None and now.time > 0.3:
            break
    for _ in range(120):
        now = do(session, commands.Scrub(99.0))
        if now.reproduction is not None:
            return now
    raise AssertionError(now.message.text)


def test_play_shows_the_newest_network_not_the_one_that_lies_on_the_timeline(
    taught: Session,
) -> None:
    played(taught)
    do(taught, commands.Train(LearnerSettings("rbf", 3)))
    assert taught.snapshot.lesson.settings.neurons == 3
    assert "30 neurons" in taught.snapshot.compare.timeline.title
    now = do(taught, commands.TogglePlay())
    assert "3 neurons" in now.compare.timeline.title
    assert "30 neurons" not in now.compare.timeline.title
    paused = do(taught, commands.TogglePlay())
    assert paused.compare.timeline.title == now.compare.timeline.title


def test_playing_ahead_of_the_playhead_comes_to_what_one_go_comes_to(taught: Session) -> None:
    begun = do(taught, commands.PlayReproduction())
    assert (begun.mode, begun.reproduction, begun.alone) == (Mode.PLAYING, None, True)
    assert begun.duration == pytest.approx(lesson().taught.duration + SETTLE)
    ended = until(taught, Mode.IDLE)
    found, whole = ended.reproduction.performance, alone()
    assert len(found.ticks) == len(whole.ticks)
    for mine, theirs in zip(found.ticks, whole.ticks, strict=True):
        assert np.array_equal(mine.world.joint_positions, theirs.world.joint_positions)
    assert ended.message.text == "The block is down."
    assert ended.time == pytest.approx(ended.duration)
    assert [column.letter for column in ended.compare.table] == ["", "A"]


def test_the_demonstration_on_the_timeline_is_told_and_no_other(taught: Session) -> None:
    assert taught.snapshot.compare.replayed is None
    now = do(taught, commands.PlayDemonstration(2))
    replayed = now.compare.replayed
    assert replayed.demonstration is now.entries[1].demonstration
    do(taught, commands.Rename(2, "other"), commands.Choose(1))
    assert taught.snapshot.compare.replayed is replayed  # as it was put there
    assert do(taught, commands.PlayReproduction()).compare.replayed is None


def test_what_is_over_is_not_simulated_again(taught: Session) -> None:
    first = played(taught).reproduction
    world = taught._activity.world
    again = do(taught, commands.PlayReproduction())
    assert again.mode is Mode.PLAYING
    assert again.reproduction is first
    assert taught._activity.world is world
    assert again.compare.playing[0].performance is first.performance
    back = do(taught, commands.Scrub(1.0), commands.TogglePlay())
    np.testing.assert_array_equal(
        back.world.joint_positions, first.performance.measured_at(np.array([1.0]))[0]
    )


def test_a_moved_block_is_missed_by_who_sees_only_time(taught: Session) -> None:
    moved = do(taught, commands.PlaceBlock(1.0, 0.05))
    assert moved.compare.moved
    np.testing.assert_allclose(moved.world.block_poses[0, :2], (1.0, 0.05), atol=1e-3)
    missed = played(taught)
    assert missed.message.text == "The block stands."
    assert not missed.world.block_down
    assert not missed.compare.table[-1].block_down
    back = do(taught, commands.PutBlockBack())
    assert not back.compare.moved
    usual = Scene().blocks[0].position[:2]
    np.testing.assert_allclose(back.world.block_poses[0, :2], usual, atol=1e-3)
    hit = played(taught)
    assert hit.world.block_down
    assert hit.compare.table[-1].block_down
    do(taught, commands.PlaceBlock(1.0, 0.05), commands.PlayReproduction())
    again = do(taught, commands.Scrub(99.0))  # known, so that it is over at once
    assert not again.world.block_down
    assert not taught.tick().compare.table[-1].block_down


def test_whoever_teaches_is_not_disturbed_by_the_block_nor_by_space(session: Session) -> None:
    do(session, commands.UseDemonstrator(), commands.Watch())
    for order in (commands.PlaceBlock(0.7, 0.1), commands.PutBlockBack(), commands.TogglePlay()):
        refused = do(session, order)
        assert refused.message.is_error
        assert "Stop first" in refused.message.text or "press Stop" in refused.message.text
        assert refused.mode is Mode.WATCHING


def test_a_moved_block_stands_there_for_teaching_too(session: Session) -> None:
    do(session, commands.PlaceBlock(1.0, 0.05), commands.UseDemonstrator())
    watching = do(session, commands.Watch())
    np.testing.assert_allclose(watching.world.block_poses[0, :2], (1.0, 0.05), atol=1e-3)
    other = do(session, commands.Stop(), commands.Configure(Choices("right")))
    assert not other.compare.moved


def test_a_place_where_no_block_can_stand_changes_nothing(taught: Session) -> None:
    x, y, _ = Scene().blocks[1].position
    refused = do(taught, commands.PlaceBlock(x, y))
    assert refused.message.is_error
    assert not refused.compare.moved


def test_b_stands_beside_a_on_one_playhead(taught: Session) -> None:
    first = played(taught).reproduction.performance
    kept = do(taught, commands.KeepToCompare())
    assert kept.compare.kept is lesson()
    taught._learning.lesson = lesson(3)
    done = played(taught)
    now = done.compare
    assert [each.lesson for each in now.playing] == [lesson(3), lesson()]
    assert now.playing[1].performance is first
    assert [column.letter for column in now.table] == ["", "A", "B"]
    assert done.message.text.startswith("A: ")
    half = do(taught, commands.Scrub(2.0))
    np.testing.assert_array_equal(
        half.compare.beside.joint_positions, first.measured_at(np.array([2.0]))[0]
    )
    assert not np.allclose(half.world.joint_positions, half.compare.beside.joint_positions)
    gone = do(taught, commands.ForgetKept(), commands.PlayReproduction())
    assert gone.compare.beside is None
    assert len(gone.compare.playing) == 1


def test_a_trial_that_was_played_is_known(taught: Session) -> None:
    taught._learning.judge(lesson(), alone())
    taught.tick()
    playing = do(taught, commands.PlayReproduction())
    assert playing.compare.playing[0].performance is alone()
    assert playing.reproduction is not None


def test_a_demonstration_is_shown_from_its_recording(taught: Session) -> None:
    shown = do(taught, commands.PlayDemonstration(2))
    assert (shown.mode, shown.alone, shown.ghost) == (Mode.PLAYING, False, None)
    assert shown.compare.timeline.title == take(2).demonstration.name
    assert shown.skeleton is not None
    ended = until(taught, Mode.IDLE)
    assert ended.message.text == "The block is down."
    assert ended.reproduction is None


def test_space_plays_what_there_is(session: Session) -> None:
    nothing = do(session, commands.TogglePlay())
    assert nothing.message.is_error
    session._listed.add(takes(1))
    assert do(session, commands.TogglePlay()).compare.timeline.title == take().demonstration.name
    assert do(session, commands.TogglePlay()).mode is Mode.IDLE
    assert do(session, commands.TogglePlay()).mode is Mode.PLAYING
    do(session, commands.UseDemonstrator(), commands.Watch(), commands.Stop())
    session._learning.lesson = lesson()
    assert do(session, commands.TogglePlay()).alone


def test_speed_and_loop_outlast_what_is_shown(taught: Session) -> None:
    set_before = do(taught, commands.SetSpeed(2.0), commands.SetLoop(True)).compare.timeline
    assert (set_before.speed, set_before.loops, set_before.title) == (2.0, True, "")
    do(taught, commands.PlayDemonstration(), commands.SetSpeed(0.5))
    kept = do(taught, commands.PlayDemonstration(2)).compare.timeline
    assert (kept.speed, kept.loops) == (0.5, True)


def test_stop_pauses_and_what_was_shown_stays(taught: Session) -> None:
    do(taught, commands.PlayDemonstration())
    for _ in range(20):
        taught.tick()
    stopped = do(taught, commands.Stop())
    assert (stopped.mode, stopped.message.text) == (Mode.IDLE, "Stopped.")
    assert 0.5 < stopped.time < 0.8
    assert taught.tick().time == stopped.time


def test_what_the_guard_changed_is_said_with_what_became_of_the_block(session: Session) -> None:
    held = held_off(alone(), 7)
    film = LessonFilm([Solo(lesson(), Scene(), held)], None)
    told = session._comparing.judge(film, session._learning)
    assert told == f"The block is down. {in_guards_words(held)}"
    assert "changed 7 of" in told
    both = LessonFilm([Solo(lesson(), Scene(), alone()), Solo(lesson(3), Scene(), held)], None)
    told = session._comparing.judge(both, session._learning)
    assert told == f"A: The block is down. B: The block is down. {in_guards_words(held)}"


def test_nothing_learned_nothing_kept(session: Session) -> None:
    refused = do(session, commands.KeepToCompare())
    assert refused.message.is_error
    assert "Train first" in refused.message.text


def test_a_field_is_pictured_as_soon_as_it_is_learned(taught: Session) -> None:
    assert taught.tick().compare.field is None
    taught._learning.lesson = lesson(5, "field")
    assert taught.tick().compare.field.lesson is lesson(5, "field")
    taught._learning.lesson = lesson(20, "plain-field")
    plain = taught.tick().compare.field
    assert (plain.lesson, plain.legs) == (lesson(20, "plain-field"), 1)
    taught._learning.lesson = lesson(5, "field")
    taught.tick()
    moved = do(taught, commands.PlaceStart(0, -0.5, 0.0), commands.ShowLeg(1))
    assert moved.compare.field.leg == 1
    assert LearnerSettings("field", 5) == moved.compare.field.lesson.settings
