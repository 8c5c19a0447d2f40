"""The tour, headless: it teaches, learns, plays and fails as it says, and can be left."""

from pathlib import Path

import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.tour import ENOUGH, FAREWELL, STAGES, TAKES, TOO_FEW, Caption, Tour

MOST = 120.0  # [s]
EVERY = 3  # ticks between two looks: the page looks ten times a second


class Guided:
    """A session on the tour, at the speed of its ticks."""

    def __init__(self, session: Session) -> None:
        self.session, self.tour = session, Tour()
        self.ticks = 0
        self.seen: list[Caption] = []

    @property
    def time(self) -> float:
        return self.ticks * CONTROL_PERIOD

    def look(self) -> Snapshot:
        for _ in range(EVERY):
            now = self.session.tick()
            self.ticks += 1
        for command in self.tour.advance(now, self.time):
            self.session.post(command)
        caption = self.tour.caption(now)
        if caption is not None and caption not in self.seen:
            self.seen.append(caption)
        return now


@pytest.fixture
def guided(tmp_path: Path):
    session = Session(tmp_path / "recordings")
    yield Guided(session)
    session.close()


def test_it_runs_the_papers_experiment_in_two_minutes(guided: Guided) -> None:
    guided.session.post(commands.Configure(Choices("right", "paper")))
    guided.tour.begin()
    learned, fell = [], {}
    while guided.tour.is_on:
        now = guided.look()
        assert guided.time < MOST, guided.seen[-1]
        if now.lesson is not None and now.lesson not in learned:
            learned.append(now.lesson)
        if now.reproduction is not None:
            fell[now.lesson.settings] = now.reproduction.performance.block_down
    assert guided.tour.farewell == FAREWELL
    assert [each.settings for each in learned] == [ENOUGH, TOO_FEW, ENOUGH]
    assert fell == {ENOUGH: True, TOO_FEW: False}
    now = guided.session.tick()
    assert len(now.entries) == TAKES
    assert all(entry.included and entry.block_down for entry in now.entries)
    assert now.choices == Choices()
    assert {each.number for each in guided.seen} == set(range(1, len(STAGES) + 1))
    assert {each.step for each in guided.seen} == {"source", "teach", "learn", "compare"}
    words = " ".join(each.words for each in guided.seen)
    for told in ("Lasso, Open, Closed", "Baxter follows", "times the floor", "too few"):
        assert told in words


def test_whoever_leaves_keeps_what_is_there(guided: Guided) -> None:
    guided.tour.begin()
    while not guided.look().entries:
        pass
    guided.tour.leave("You took over.")
    assert not guided.tour.is_on
    assert guided.tour.caption(guided.session.snapshot) is None
    taught = len(guided.session.snapshot.entries)
    guided.session.post(commands.Stop())
    for _ in range(10):
        guided.look()
    now = guided.session.snapshot
    assert (len(now.entries), now.mode) == (taught, Mode.IDLE)
    assert guided.tour.farewell == "You took over."


def test_others_demonstrations_are_left_out_and_stay(guided: Guided) -> None:
    guided.session.post(commands.UseDemonstrator())
    guided.session.post(commands.Record())
    while not guided.session.tick().entries:
        pass
    guided.tour.begin()
    for _ in range(3):
        guided.look()
    (own,) = guided.session.snapshot.entries
    assert not own.included


def test_what_goes_wrong_ends_it_in_words(guided: Guided) -> None:
    guided.tour.begin()
    guided.look()
    guided.session.post(commands.Remove(999))
    guided.look()
    assert not guided.tour.is_on
    assert "no such demonstration" in guided.tour.farewell


def test_it_does_not_wait_for_ever(guided: Guided) -> None:
    guided.tour.begin()
    now = guided.session.snapshot
    guided.tour.advance(now, 0.0)
    guided.tour.advance(now, 1000.0)
    assert "too long" in guided.tour.farewell
