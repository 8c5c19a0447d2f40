"""The thread of a link: the newest command wins, is sent once, never late; nobody waits for it."""

import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest

from studio.engine.links.driver import STALE, LinkThread
from studio.engine.links.link import LinkError, RobotState
from studio.engine.robot import JOINT_NAMES
from tests.engine.links.unhurried import PATIENCE, eventually
from tests.engine.live.streaming import Clock


class Bench:
    """A link that remembers, blocks and fails when a test says so."""

    url, limits = "bench://", {"left_s0": (-1.0, 1.0)}

    def __init__(self) -> None:
        self.sent: list[dict[str, float]] = []
        self.told: list[str] = []
        self.free, self.lost, self.news = threading.Event(), "", False
        self.opened = self.closed = 0
        self.free.set()

    def open(self) -> None:
        self.opened += 1
        if self.lost:
            raise LinkError(self.lost)

    def read(self) -> RobotState | None:
        if self.lost:
            raise LinkError(self.lost)
        news, self.news = self.news, False
        return RobotState(np.zeros(len(JOINT_NAMES)), True) if news else None

    def send(self, targets: dict[str, float]) -> None:
        self.free.wait()
        self.sent.append(dict(targets))

    def enable(self) -> None:
        self.told.append("enable")

    def disable(self) -> None:
        self.told.append("disable")

    def stop(self) -> None:
        self.told.append("stop")

    def set_speed(self, ratio: float) -> None:
        raise OSError("the network is gone")

    def close(self) -> None:
        self.closed += 1


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def thread(bench: Bench, clock: Clock) -> Iterator[LinkThread]:
    made = LinkThread(bench, clock)
    eventually(lambda: made.is_open)
    yield made
    bench.free.set()
    made.close()
    assert not made._thread.is_alive()


def test_each_is_sent_once_and_the_newest_wins(bench: Bench, thread: LinkThread) -> None:
    thread.put({"left_s0": 0.1})
    eventually(lambda: bench.sent == [{"left_s0": 0.1}])
    bench.free.clear()  # the network hangs while it sends
    thread.put({"left_s0": 0.2})
    eventually(lambda: thread._slot is None)
    put = threading.Thread(target=lambda: [thread.put({"left_s0": a}) for a in (0.3, 0.4, 0.5)])
    put.start()
    put.join(PATIENCE)
    assert not put.is_alive()  # nobody waits
    bench.free.set()
    eventually(lambda: len(bench.sent) == 3)
    time.sleep(0.05)
    assert bench.sent[1:] == [{"left_s0": 0.2}, {"left_s0": 0.5}]


def test_what_has_grown_old_is_never_sent(bench: Bench, thread: LinkThread, clock: Clock) -> None:
    bench.free.clear()
    thread.put({"left_s0": 0.1})
    eventually(lambda: thread._slot is None)
    thread.put({"left_s0": 0.2})
    clock.time += STALE + 0.01
    bench.free.set()
    eventually(lambda: len(bench.sent) == 1)
    time.sleep(0.05)
    assert bench.sent == [{"left_s0": 0.1}]


def test_nothing_replaces_what_waits(bench: Bench, thread: LinkThread) -> None:
    bench.free.clear()
    thread.put({"left_s0": 0.1})
    eventually(lambda: thread._slot is None)
    thread.put({"left_s0": 0.2})
    thread.put(None)
    bench.free.set()
    time.sleep(0.05)
    assert bench.sent == [{"left_s0": 0.1}]


def test_orders_go_before_commands(bench: Bench, thread: LinkThread) -> None:
    bench.free.clear()
    thread.put({"left_s0": 0.1})
    eventually(lambda: thread._slot is None)
    thread.put({"left_s0": 0.2})
    thread.order(lambda link: link.disable())
    thread.order(lambda link: bench.told.append(f"{len(bench.sent)} sent"))
    bench.free.set()
    eventually(lambda: len(bench.sent) == 2)
    assert bench.told == ["disable", "1 sent"]


def test_a_lost_link_is_opened_anew_and_sends_nothing_old(bench: Bench, thread: LinkThread) -> None:
    bench.news = True
    eventually(lambda: thread.heard is not None)
    bench.lost = "the cable was pulled"
    eventually(lambda: not thread.is_open)
    assert thread.heard is None
    assert thread.trouble == "the cable was pulled"
    thread.put({"left_s0": 0.1})
    thread.order(lambda link: link.enable())
    bench.lost = ""
    eventually(lambda: thread.is_open)
    time.sleep(0.05)
    assert (bench.sent, bench.told, thread.trouble) == ([], [], "")
    assert bench.closed >= 1


def test_a_fault_of_a_library_is_a_lost_link(bench: Bench, thread: LinkThread) -> None:
    thread.order(lambda link: link.set_speed(1.0))
    eventually(lambda: thread.trouble == "the network is gone")
    eventually(lambda: thread.is_open)
    thread.order(lambda link: 1 / 0)
    eventually(lambda: "ZeroDivisionError" in thread.trouble)


def test_states_have_their_age(bench: Bench, thread: LinkThread, clock: Clock) -> None:
    bench.news = True
    eventually(lambda: thread.heard is not None)
    assert thread.heard.age(clock.time + 0.1) == pytest.approx(0.1)


def test_orders_that_wait_at_the_end_are_done_and_targets_are_not(
    bench: Bench, thread: LinkThread
) -> None:
    bench.free.clear()
    thread.put({"left_s0": 0.1})
    eventually(lambda: thread._slot is None)
    thread.put({"left_s0": 0.2})
    thread.enable()
    thread.order(lambda link: link.disable())
    thread.end()
    bench.free.set()
    thread.close()
    assert (bench.told, bench.sent) == (["disable", "stop"], [{"left_s0": 0.1}])


@pytest.mark.parametrize("ends", ["halted", "late"])
def test_no_motor_is_powered_after_a_stop_or_late(
    bench: Bench, thread: LinkThread, clock: Clock, ends: str
) -> None:
    bench.free.clear()
    thread.put({"left_s0": 0.1})
    eventually(lambda: thread._slot is None)
    thread.enable()
    thread.order(lambda link: bench.told.append("asked later"))
    if ends == "halted":
        thread.halt()
    else:
        clock.time += STALE + 0.01
    bench.free.set()
    eventually(lambda: bench.told)
    assert bench.told[0] == "asked later"
    eventually(lambda: bench.told[1:] == ["stop"])


def test_motors_are_powered_when_asked_in_time(bench: Bench, thread: LinkThread) -> None:
    thread.enable()
    eventually(lambda: bench.told == ["enable"])


@pytest.mark.parametrize("how", ["nothing more", "halted", "stalled"])
def test_a_robot_is_told_once_where_commands_end(
    bench: Bench, thread: LinkThread, clock: Clock, how: str
) -> None:
    thread.put({"left_s0": 0.1})
    eventually(lambda: thread.sent == 1)
    time.sleep(0.02)
    assert bench.told == []
    if how == "stalled":
        clock.time += STALE + 0.01
    else:
        thread.halt() if how == "halted" else thread.put(None)
    eventually(lambda: bench.told == ["stop"])
    thread.put(None)
    clock.time += STALE + 0.01
    time.sleep(0.02)
    assert bench.told == ["stop"]
    thread.put({"left_s0": 0.2})
    eventually(lambda: thread.sent == 2)
    thread.put(None)
    eventually(lambda: bench.told == ["stop", "stop"])


def test_a_robot_to_which_nothing_was_sent_is_not_told_to_hold(
    bench: Bench, thread: LinkThread, clock: Clock
) -> None:
    thread.put(None)
    thread.halt()
    clock.time += STALE + 0.01
    time.sleep(0.02)
    assert bench.told == []
