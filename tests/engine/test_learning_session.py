"""A session that learns in another process: it ticks on, tells what it waits for, and can stop."""

import time
from collections.abc import Callable, Iterator

import pytest

from studio.engine import commands
from studio.engine.resources import samples_folder
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings, learn
from studio.engine.work import Work
from tests.engine.long_work import PATIENCE
from tests.engine.sessions import do, read


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    made = Session(tmp_path_factory.mktemp("recordings"), work=Work(time.monotonic))
    for sample in sorted(samples_folder().glob("*.mcap"))[:2]:
        read(made, commands.UseFile(sample))
    yield made
    made.close()


def until(session: Session, reached: Callable[[Snapshot], bool]) -> Snapshot:
    end = time.monotonic() + PATIENCE
    while not reached(now := session.tick()):
        assert time.monotonic() < end, now.message.text
        time.sleep(0.01)
    return now


def test_training_shows_in_the_mode_and_ends_in_a_lesson(session: Session) -> None:
    settings = LearnerSettings("rbf", 12)
    begun = do(session, commands.Train(settings))
    assert (begun.mode, begun.lesson) == (Mode.TRAINING, None)
    assert begun.learning.underway.words == "training 12 neurons"
    before = begun.world.time
    trained = until(session, lambda now: now.lesson is not None)
    assert trained.mode is Mode.IDLE
    assert trained.world.time > before  # the world went on meanwhile
    assert trained.message.text == "Learned with 12 neurons. Now let Baxter play it."
    assert trained.lesson.curve == pytest.approx(learn(trained.lesson.taught, settings).curve)
    known = until(session, lambda now: bool(now.learning.equations)).learning.equations
    assert known["mse left_s0"].value == trained.lesson.mse[0]


def test_stop_cancels_and_leaves_what_was_learned(session: Session) -> None:
    lesson = session.snapshot.lesson
    assert do(session, commands.Train(LearnerSettings("field", 200))).mode is Mode.TRAINING
    refused = do(session, commands.Train(LearnerSettings("rbf", 5)))
    assert refused.message.is_error
    assert "Press Cancel first: training 200 neurons goes on" in refused.message.text
    stopped = do(session, commands.Stop())
    assert stopped.mode is Mode.IDLE
    assert stopped.message.text == "Canceled: training 200 neurons."
    assert stopped.lesson is lesson


def test_a_guess_gives_a_reproduction_to_look_at(session: Session) -> None:
    do(session, commands.Guess(LearnerSettings("rbf", 2), falls=False))
    known = until(session, lambda now: now.learning.outcome is not None)
    assert known.reproduction.performance.block_down is False
    assert known.lesson.settings.neurons == 2
    assert known.learning.right == 1
    with_equations = until(session, lambda now: "hand mean" in now.learning.equations)
    shown = with_equations.learning.equations["hand mean"].value
    assert shown == pytest.approx(1000.0 * known.reproduction.deviation.hand_mean)


def test_ticks_go_on_while_it_learns(session: Session) -> None:
    do(session, commands.Train(LearnerSettings("field", 20)))
    for _ in range(30):  # a tick that waited would find it learned
        assert session.tick().mode is Mode.TRAINING
    do(session, commands.CancelWork())


def test_the_curve_comes_by_itself(session: Session) -> None:
    do(session, commands.ChooseLearner(LearnerSettings("rbf", 9)))
    whole = until(session, lambda now: not now.learning.curve.missing)
    assert whole.mode is Mode.IDLE
    assert whole.learning.curve.suggestion.neurons in range(5, 31)
