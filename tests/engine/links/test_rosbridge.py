"""Baxter through rosbridge, faults included; the laws that all links share are in test_links.py."""

import json
import math
import socket
import sys
import threading
import time
from collections.abc import Iterator

import pytest

from studio.engine.errors import StudioError
from studio.engine.links import gatekeeper, rosbridge
from studio.engine.links.address import link_at
from studio.engine.links.driver import STALE
from studio.engine.links.link import LinkError
from studio.engine.links.rosbridge import Rosbridge
from studio.engine.links.status import Phase
from tests.engine.links.rig import HASTE, LiveRig
from tests.engine.links.rosbridge_server import OTHERS, TYPES, RosbridgeServer
from tests.engine.links.unhurried import CLOCK, eventually


@pytest.fixture
def robot() -> Iterator[RosbridgeServer]:
    with RosbridgeServer(CLOCK, HASTE) as server:
        server.arms.positions["left_e1"] = 0.6
        yield server
        assert server.complaints == []


@pytest.fixture
def rig(robot: RosbridgeServer) -> Iterator[LiveRig]:
    with LiveRig(link_at(robot.url, CLOCK)) as made:
        made.move("left_e1", 0.6)
        yield made


def ops(robot: RosbridgeServer, operation: str) -> dict[str, dict]:
    return {each["topic"]: each for each in robot.heard if each["op"] == operation}


def test_what_is_subscribed_and_announced(robot: RosbridgeServer, rig: LiveRig) -> None:
    rig.heard()
    subscribed, announced = ops(robot, "subscribe"), ops(robot, "advertise")
    assert {*subscribed, *announced} == {*TYPES}
    for topic, message in {**subscribed, **announced}.items():
        assert message["type"] == TYPES[topic]
    assert all(each["queue_length"] == 1 for each in subscribed.values())
    assert ops(robot, "publish") == {}  # nothing is sent by connecting


def test_it_begins_at_three_tenths_of_its_speed(robot: RosbridgeServer, rig: LiveRig) -> None:
    rig.heard()
    rig.enable()
    rig.until(lambda: robot.arms.ratio == pytest.approx(0.3))
    assert robot.arms.powered


@pytest.mark.parametrize(
    "order", [list, lambda names: names[::-1], sorted], ids=["told", "reversed", "sorted"]
)
def test_any_order_with_others_between(robot: RosbridgeServer, rig: LiveRig, order) -> None:
    robot.order = order
    robot.arms.positions |= {"left_s0": 0.4, "right_w2": -0.3}
    rig.heard()
    assert rig.measured("left_s0") == pytest.approx(0.4)
    assert rig.measured("right_w2") == pytest.approx(-0.3)
    assert rig.measured("head_pan") == pytest.approx(OTHERS["head_pan"])
    assert rig.seen.state.untold == ()


def test_a_joint_that_is_missing_cannot_be_started(robot: RosbridgeServer, rig: LiveRig) -> None:
    robot.untold = {"left_w1"}
    rig.heard()
    assert rig.seen.state.untold == ("left_w1",)
    with pytest.raises(StudioError, match="left_w1"):
        rig.started()


def test_a_joint_that_falls_silent_in_mid_motion(robot: RosbridgeServer, rig: LiveRig) -> None:
    rig.moving()
    robot.untold = {"left_w1"}
    rig.until(lambda: rig.phase is Phase.OFF)
    assert "does not tell left_w1" in rig.why


def test_not_a_number_in_mid_motion(robot: RosbridgeServer, rig: LiveRig) -> None:
    rig.moving()
    robot.arms.positions["left_s1"] = math.nan  # as Python's json writes it, and rosbridge, too
    rig.until(lambda: rig.phase is Phase.OFF)
    assert "left_s1" in rig.why


def test_a_late_network(robot: RosbridgeServer, rig: LiveRig) -> None:
    rig.moving()
    robot.delay = 8 * STALE  # it still comes 100 times a second: only the stamps tell
    rig.until(lambda: rig.phase is Phase.OFF)
    rig.until(lambda: rig.seen.state is not None and rig.seen.age > STALE)
    with pytest.raises(StudioError, match="not heard"):
        rig.enable()


@pytest.mark.parametrize(
    "garbage",
    [
        "no json",
        "[]",
        "{}",
        json.dumps({"op": "publish"}),
        json.dumps({"op": "publish", "topic": "/robot/state", "msg": None}),
        json.dumps({"op": "publish", "topic": "/robot/joint_states", "msg": {"name": 5}}),
        json.dumps({"op": "status", "level": "error", "msg": "x"}),
        json.dumps({"op": "fragment", "data": "x"}),
    ],
)
def test_garbage_between_is_nothing(robot: RosbridgeServer, rig: LiveRig, garbage: str) -> None:
    rig.heard()
    for _ in range(5):
        robot.send(garbage)
        rig.tick()
    assert rig.seen.age < STALE


def test_nothing_but_garbage_is_a_lost_robot(robot: RosbridgeServer, rig: LiveRig) -> None:
    rig.moving()
    robot.changed = lambda text: text[:-3]
    rig.until(lambda: rig.phase is Phase.OFF)


def test_a_huge_message_ends_the_connection_and_no_more(robot, rig: LiveRig) -> None:
    rig.moving()
    names = [f"joint{number}" for number in range(100_000)]
    message = {"name": names, "position": [0.0] * len(names)}
    topic = "/robot/joint_states"
    robot.send(json.dumps({"op": "publish", "topic": topic, "msg": message}))
    rig.until(lambda: rig.phase is Phase.OFF)
    rig.until(lambda: rig.seen.state is not None and rig.seen.age < STALE)  # it came back
    assert rig.phase is Phase.OFF


def test_a_stop_is_reset_by_enabling_only_once_it_is_released(robot, rig: LiveRig) -> None:
    rig.heard()
    robot.press()
    rig.until(lambda: rig.seen.state is not None and bool(rig.seen.state.stop))
    with pytest.raises(StudioError, match="turn the red button"):
        rig.enable()
    robot.release()
    rig.until(lambda: rig.seen.state.resets)
    assert robot.arms.stopped
    rig.enable()
    assert rig.phase is Phase.WAITING
    assert not robot.arms.stopped


def test_a_robot_that_does_not_power_its_motors(robot, rig: LiveRig, monkeypatch) -> None:
    monkeypatch.setattr(gatekeeper, "_ENABLES_WITHIN", 20)
    robot.enables = False
    rig.heard()
    rig.enable()
    assert rig.phase is Phase.OFF
    assert "did not power" in rig.why


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rosbridge, "_CONNECTS_WITHIN", 0.2)


@pytest.mark.usefixtures("impatient")
def test_a_server_that_accepts_and_says_nothing() -> None:
    with socket.create_server(("127.0.0.1", 0)) as deaf:
        link = Rosbridge("rosbridge://deaf", "127.0.0.1", deaf.getsockname()[1], time.monotonic)
        with pytest.raises(LinkError, match="no rosbridge answers"):
            link.open()
        link.close()


@pytest.mark.usefixtures("impatient")
def test_nobody_there() -> None:
    with socket.create_server(("127.0.0.1", 0)) as gone:
        port = gone.getsockname()[1]
    link = Rosbridge("rosbridge://gone", "127.0.0.1", port, time.monotonic)
    with pytest.raises(LinkError, match="rosbridge_websocket"):
        link.open()
    link.close()
    link.close()
    with pytest.raises(LinkError, match="ended the connection"):
        link.read()


def test_the_extra_is_named_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "roslibpy", None)
    with pytest.raises(LinkError, match=r"teaching-studio\[ros\]"):
        rosbridge.Rosbridge("rosbridge://x", "x", 1, time.monotonic).open()


def test_closing_leaves_no_thread_of_ours(robot: RosbridgeServer) -> None:
    with LiveRig(link_at(robot.url, CLOCK)) as rig:
        rig.heard()
    assert not [each for each in threading.enumerate() if each.name == "robot link"]


def arrived(robot: RosbridgeServer) -> list[dict]:
    return [each for each in robot.heard if each.get("topic", "").startswith("/robot/")]


def deaf_in_mid_motion(robot: RosbridgeServer, rig: LiveRig) -> int:
    """The robot's side reads no more, and goes on to tell; return how much it had read."""
    rig.moving()
    rig.settle()
    before = len(arrived(robot))
    robot.deafen()
    for _ in range(3):
        rig.move("left_s0", 0.001)
        rig.tick()
    return before


def test_a_robot_s_side_that_reads_no_more_is_sent_nothing_old(robot, rig: LiveRig) -> None:
    before = deaf_in_mid_motion(robot, rig)
    rig.until(lambda: rig.phase is Phase.OFF)
    assert "does not read" in rig.why
    rig.until(lambda: not rig.thread.is_open)
    CLOCK.sleep(STALE)
    robot.hear_again()
    rig.until(lambda: rig.seen.state is not None and rig.seen.age < STALE)  # connected anew
    rig.settle()
    late = [each for each in arrived(robot)[before:] if each["op"] == "publish"]
    assert len(late) <= 1  # the one that was on its way: who has it in hand keeps it
    assert rig.phase is Phase.OFF
    rig.started()


def test_a_connection_that_is_let_alone_in_mid_motion_flushes_nothing(robot, rig) -> None:
    before = deaf_in_mid_motion(robot, rig)
    rig.thread.close()
    assert not rig.thread._thread.is_alive()
    robot.hear_again()
    CLOCK.sleep(STALE)
    assert len([each for each in arrived(robot)[before:] if each["op"] == "publish"]) <= 1


def test_what_is_ordered_at_the_end_is_read_before_the_end(robot, rig: LiveRig) -> None:
    rig.moving()
    rig.thread.order(lambda link: link.disable())
    rig.thread.close()
    eventually(lambda: not robot.arms.powered)
