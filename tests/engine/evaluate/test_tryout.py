"""The browser's test: what a session tells of it, from the first trial to the last, or a cancel."""

import pytest

from studio.engine import commands
from studio.engine.errors import StudioError
from studio.engine.evaluate.interval import rate_of
from studio.engine.evaluate.runs import Conditions, Trial
from studio.engine.evaluate.subject import subject_of_lesson
from studio.engine.evaluate.trial import Outcome
from studio.engine.evaluate.tryout import TryoutPoint, TryoutRun, TryoutStatus
from studio.engine.evaluate.variation import Variations
from studio.engine.resources import samples_folder
from studio.engine.scene import Scene
from studio.engine.session import Session
from studio.engine.snapshot import Mode
from studio.engine.teaching import LearnerSettings
from tests.engine.lessons_at_hand import lesson
from tests.engine.sessions import do, read

DONE, MISSED = Outcome(True, ""), Outcome(False, "the block still stands")


def test_each_trial_is_done_by_what_was_learned_and_by_a_demonstration_in_turn() -> None:
    run = TryoutRun(lesson(), Scene(), 2)
    points = list(run.points())
    assert len(points) == run.size == 2
    subject, usual = subject_of_lesson(lesson(), Scene()), Conditions(Scene(), Variations(), 0)
    for trial, point in enumerate(points):
        assert point.alone == Trial(subject.motion, trial, usual).run()
        assert point.replayed == Trial(subject.replays[trial % 2], trial, usual).run()


def test_a_status_counts_what_is_known_so_far() -> None:
    run = TryoutRun(lesson(), Scene(), 10)
    begun = TryoutStatus.of(run, (), goes_on=True)
    assert (begun.rate, begun.asked, begun.goes_on) == (None, 10, True)
    points = [TryoutPoint(DONE, DONE), TryoutPoint(MISSED, DONE), TryoutPoint(DONE, MISSED)]
    found = TryoutStatus.of(run, points, goes_on=False)
    assert (found.rate, found.replayed) == (rate_of(2, 3), rate_of(2, 3))
    assert found.failures == (("the block still stands", 1),)
    assert found.words == (
        "2 of 3 times the task was done; by the demonstrations' own replays 2 times."
    )
    with pytest.raises(StudioError, match="trials: 1 to"):
        TryoutRun(lesson(), Scene(), 0)


def test_a_session_tests_in_its_ticks_and_keeps_what_was_known_at_cancel(
    tmp_path, monkeypatch
) -> None:
    monkeypatch.setattr(Trial, "run", lambda _: DONE)  # what a trial is, is shown above
    session = Session(tmp_path)
    try:
        refused = do(session, commands.TryOut(2))
        assert "Train first: there is nothing learned to test" in refused.message.text
        read(session, commands.UseFile(sorted(samples_folder().glob("*.mcap"))[0]))
        trained = do(session, commands.Train(LearnerSettings("rbf", 12)))
        assert trained.tryout.lesson is None
        begun = do(session, commands.TryOut(2))
        assert begun.tryout.goes_on
        assert begun.tryout.lesson is begun.lesson
        assert begun.mode is Mode.IDLE  # the robot may play meanwhile
        assert begun.learning.underway.words == "testing 2 times"
        done = session.tick()
        assert not done.tryout.goes_on
        assert done.tryout.rate.trials == 2
        assert done.learning.underway is None
        assert done.message.text == done.tryout.words
        do(session, commands.TryOut(100))
        canceled = do(session, commands.CancelWork())
        assert canceled.message.text == "Canceled: testing 100 times."
        assert not canceled.tryout.goes_on
        assert canceled.tryout.rate.trials == 1
    finally:
        session.close()
