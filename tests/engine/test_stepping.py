"""The clock in a program's hand: nothing passes but what it asks for, and it cannot be kept."""

import threading
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from studio.engine import stepping
from studio.engine.errors import StudioError
from studio.engine.stepping import MOST_STEPS, Steps


class Session:
    """Counts its ticks; its snapshot is their number."""

    def __init__(self) -> None:
        self.snapshot = 0
        self.heard = 0

    def tick(self) -> int:
        self.snapshot += 1
        return self.snapshot

    def hear(self) -> None:
        self.heard += 1


class Bench:
    """Steps that run on a thread of their own, with a clock that the test turns."""

    def __init__(self) -> None:
        self.time, self.stopping = 0.0, threading.Event()
        self.steps, self.session = Steps(lambda: self.time), Session()
        self.ticked: list[int] = []
        self.lost = threading.Event()

    def take(self, patience: float = 5.0) -> None:
        taken = threading.Event()
        self.steps.take(patience, lambda _: taken.set(), self.lost.set)
        self.thread = threading.Thread(
            target=self.steps.run, args=(self.session, self.stopping, self.ticked.append)
        )
        self.thread.start()
        assert taken.wait(10.0)

    def step(self, ticks: int) -> int:
        done, seen = threading.Event(), []

        def tell(now: int) -> None:
            seen.append(now)
            done.set()

        self.steps.ask(ticks, tell)
        assert done.wait(10.0)
        return seen[0]


@pytest.fixture
def bench(monkeypatch) -> Iterator[Bench]:
    monkeypatch.setattr(stepping, "_LOOK_EVERY", 0.005)
    made = Bench()
    yield made
    made.stopping.set()
    made.steps.give()
    made.thread.join(10.0)
    assert not made.thread.is_alive()


def test_so_many_ticks_pass_as_are_asked_for(bench: Bench) -> None:
    bench.take()
    assert bench.session.snapshot == 0
    assert bench.step(1) == 1
    assert bench.step(41) == 42
    assert bench.ticked == list(range(1, 43))


def test_commands_are_heard_meanwhile(bench: Bench) -> None:
    bench.take()
    before = bench.session.heard
    bench.steps.nudge()
    deadline = threading.Event()
    while bench.session.heard == before:
        assert not deadline.wait(0.001)
    assert bench.session.snapshot == 0


def test_without_a_step_for_long_it_is_lost(bench: Bench) -> None:
    bench.take(patience=5.0)
    bench.time = 4.9
    bench.step(1)
    bench.time = 9.8  # 4.9 s after the last step
    bench.step(1)
    bench.time = 14.9
    assert bench.lost.wait(10.0)
    bench.thread.join(10.0)
    assert not bench.steps.is_held
    with pytest.raises(StudioError, match="take it first"):
        bench.steps.ask(1, lambda _: None)


def test_given_back_it_can_be_taken_anew(bench: Bench) -> None:
    bench.take()
    bench.steps.give()
    bench.thread.join(10.0)
    assert not bench.lost.is_set()
    bench.take()
    assert bench.step(3) == 3


def test_steps_that_go_on_end_when_it_is_given_back(bench: Bench) -> None:
    bench.session.tick = lambda: bench.steps.give() or 7
    bench.take()
    bench.session.snapshot = 7
    assert bench.step(MOST_STEPS) == 7  # answered all the same
    assert bench.ticked == [7]


def test_who_has_it_has_it_alone_and_asks_for_one_thing(bench: Bench) -> None:
    bench.take()
    with pytest.raises(StudioError, match="has the clock already"):
        bench.steps.take(1.0, lambda _: None, lambda: None)
    for ticks in (0, -1, MOST_STEPS + 1):
        with pytest.raises(StudioError, match="steps: 1 to"):
            bench.steps.ask(ticks, lambda _: None)
    gate = threading.Event()
    bench.session.tick = lambda: gate.wait(10.0)
    bench.steps.ask(1, lambda _: None)
    with pytest.raises(StudioError, match="not over"):
        bench.steps.ask(1, lambda _: None)
    gate.set()


def test_nobody_waits_for_steps_that_never_come() -> None:
    """The loop ends between a question and its answer."""
    stopping, told = threading.Event(), []
    steps = Steps(lambda: 0.0)
    steps.take(1.0, told.append, lambda: None)
    steps.ask(5, told.append)
    stopping.set()
    steps.run(SimpleNamespace(snapshot=0), stopping, told.append)
    assert told == [0]


def test_steps_do_not_outlive_their_owner(bench: Bench) -> None:
    bench.take()
    begun, go_on = threading.Event(), threading.Event()
    inner = bench.session.tick

    def tick() -> int:
        begun.set()
        assert go_on.wait(10.0)
        return inner()

    bench.session.tick = tick
    answers: list[str] = []
    done = threading.Event()
    bench.steps.ask(1000, lambda _: answers.append("first"))
    assert begun.wait(10.0)
    bench.steps.give()
    bench.steps.take(5.0, lambda _: None, lambda: None)  # within the tick that goes on
    bench.steps.ask(1, lambda _: (answers.append("second"), done.set()))
    go_on.set()
    assert done.wait(10.0)
    assert (answers, bench.session.snapshot) == (["first", "second"], 2)


def test_given_back_before_the_loop_looks_nothing_is_left_of_it() -> None:
    steps, session, told = Steps(lambda: 0.0), Session(), []
    steps.take(1.0, lambda _: told.append("taken"), lambda: None)
    steps.ask(5, lambda _: told.append("stepped"))
    steps.give()
    assert steps.is_due  # somebody waits for an answer
    steps.run(session, threading.Event(), told.append)
    assert (told, session.snapshot, steps.is_due) == (["stepped"], 0, False)


def test_the_patience_of_one_is_not_used_up_by_another(bench: Bench) -> None:
    bench.take(patience=100.0)
    bench.time = 50.0
    heard = threading.Event()
    with bench.steps._condition:  # the loop does not look in between
        bench.steps.give()
        bench.steps.take(1.0, lambda _: heard.set(), bench.lost.set)
    assert heard.wait(10.0)
    assert bench.step(1) == 1
    assert not bench.lost.is_set()
