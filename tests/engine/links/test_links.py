"""The laws that every link keeps, each before its stand-in: over real sockets."""

from collections.abc import Iterator

import pytest

from studio.engine.links import coppeliasim, rosbridge
from studio.engine.links.address import link_at
from studio.engine.links.driver import STALE
from studio.engine.links.gatekeeper import JUMP
from studio.engine.links.status import Phase
from studio.engine.links.tracking import ASIDE
from tests.engine.links.coppeliasim_server import CoppeliaSimServer
from tests.engine.links.rig import HASTE, LEFT, LiveRig
from tests.engine.links.rosbridge_server import RosbridgeServer
from tests.engine.links.unhurried import CLOCK

StandIn = RosbridgeServer | CoppeliaSimServer


@pytest.fixture(params=[RosbridgeServer, CoppeliaSimServer], ids=["rosbridge", "coppeliasim"])
def robot(request) -> Iterator[StandIn]:
    with request.param(CLOCK, HASTE) as server:
        server.arms.positions["left_e1"] = 0.6  # away from the limit that is next to zero
        yield server
        assert server.complaints == []


@pytest.fixture
def rig(robot: StandIn) -> Iterator[LiveRig]:
    with LiveRig(link_at(robot.url, CLOCK)) as made:
        made.move("left_e1", 0.6)
        yield made


def test_joints_come_and_go_by_name_and_sign(robot: StandIn, rig: LiveRig) -> None:
    for number, joint in enumerate(robot.arms.positions):
        robot.arms.positions[joint] = 0.3 + 0.02 * number
        rig.move(joint, 0.3 + 0.02 * number - (0.6 if joint == "left_e1" else 0.0))
    rig.started()
    rig.permitted = True
    for number, joint in enumerate(LEFT):
        for _ in range(5):
            rig.move(joint, 0.01 if number % 2 else -0.01)
            rig.tick()
    rig.until(lambda: abs(robot.arms.positions["left_w2"] - 0.3 - 0.02 * 6 + 0.05) < 0.005)
    for number, (joint, angle) in enumerate(robot.arms.positions.items()):
        way = 0.0 if joint not in LEFT else 0.05 if number % 2 else -0.05
        assert angle == pytest.approx(0.3 + 0.02 * number + way, abs=0.01), joint
    assert all(name in LEFT for _, targets in robot.arms.commands for name in targets)


def test_nothing_is_sent_before_enabling_and_confirming(robot: StandIn, rig: LiveRig) -> None:
    rig.permitted = True
    rig.heard()
    rig.until(lambda: rig.thread.heard is not None)
    for _ in range(10):
        rig.tick()
    assert robot.arms.commands == []
    rig.enable()
    for _ in range(10):
        rig.tick()
    assert (rig.phase, robot.arms.commands) == (Phase.WAITING, []), rig.why


def test_limits(robot: StandIn, rig: LiveRig) -> None:
    robot.arms.positions["left_s0"] = 1.65  # 0.05 rad before the end
    rig.move("left_s0", 1.65)
    rig.started()
    rig.permitted = True
    for _ in range(20):
        rig.move("left_s0", 0.9 * JUMP * 0.2)
        rig.tick()
    told = [targets["left_s0"] for _, targets in robot.arms.commands if "left_s0" in targets]
    assert max(told) == pytest.approx(1.70168, abs=1e-4)
    assert max(robot.arms.positions["left_s0"], 1.7) < 1.7017


def test_watchdog_a_studio_that_stalls_sends_nothing(robot: StandIn, rig: LiveRig) -> None:
    rig.moving()
    CLOCK.sleep(2 * STALE)  # the session's ticks have stopped, the link's thread goes on
    count = len(robot.arms.commands)
    CLOCK.sleep(STALE)
    assert len(robot.arms.commands) == count
    stands = dict(robot.arms.positions)
    CLOCK.sleep(0.1)
    assert robot.arms.positions == stands
    rig.until(lambda: len(robot.arms.commands) > count)  # it was not lost


def test_watchdog_disarming_ends_commands(robot: StandIn, rig: LiveRig) -> None:
    rig.moving()
    rig.permitted = False
    rig.tick()
    rig.settle()
    count = len(robot.arms.commands)
    for _ in range(10):
        rig.move("left_s0", 0.01)
        rig.tick()
    assert len(robot.arms.commands) == count
    assert rig.phase is Phase.READY


def test_a_robot_that_is_behind_holds_where_it_is_when_commands_end(robot, rig: LiveRig) -> None:
    """Whatever was commanded last leads it no further."""
    rig.started()
    rig.permitted, robot.arms.ratio = True, 0.0
    for _ in range(6):
        rig.move("left_s0", 0.01)
        rig.tick()
    rig.permitted = False
    rig.tick()
    rig.settle()
    CLOCK.sleep(STALE * HASTE)  # in which a Baxter's own controller gives up
    stood, robot.arms.ratio = robot.arms.positions["left_s0"], 1.0
    CLOCK.sleep(STALE)
    assert robot.arms.positions["left_s0"] == pytest.approx(stood, abs=0.002)
    rig.permitted = True
    rig.until(lambda: robot.arms.positions["left_s0"] > stood + 0.03)  # it was told to go there


def fallen(robot: StandIn, rig: LiveRig, words: str) -> None:
    """It has ended, in words, and nothing follows by itself."""
    rig.until(lambda: rig.phase is Phase.OFF)
    assert words in rig.why
    assert "Enable and confirm anew" in rig.why
    if robot.silent:  # the link may wait for it
        CLOCK.sleep(STALE)
    else:
        rig.settle()
    count = len(robot.arms.commands)
    for _ in range(10):
        rig.tick()
    assert len(robot.arms.commands) == count


def test_disabled_in_mid_motion(robot: StandIn, rig: LiveRig) -> None:
    rig.moving()
    robot.power_off()
    fallen(robot, rig, "was disabled")
    rig.started()  # and with both anew it goes on


def test_emergency_stop(robot: StandIn, rig: LiveRig) -> None:
    rig.moving()
    robot.press()
    fallen(robot, rig, "paused" if isinstance(robot, CoppeliaSimServer) else "e-stop is pressed")


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """That a robot is gone is heard of by no answer; it is looked for again and again."""
    monkeypatch.setattr(coppeliasim, "_ANSWERS_WITHIN", 2.0)
    monkeypatch.setattr(rosbridge, "_CONNECTS_WITHIN", 2.0)


@pytest.mark.usefixtures("impatient")
def test_a_lost_connection_and_its_return(robot: StandIn, rig: LiveRig) -> None:
    rig.moving()
    robot.kill()
    rig.until(lambda: rig.phase is Phase.OFF)
    assert "Enable and confirm anew" in rig.why
    count = len(robot.arms.commands)
    robot.revive()
    rig.until(lambda: rig.seen.state is not None and rig.seen.age < STALE)
    for _ in range(10):
        rig.tick()
    assert (len(robot.arms.commands), rig.phase) == (count, Phase.OFF)
    rig.started()


def test_a_robot_that_says_nothing_any_more(robot: StandIn, rig: LiveRig) -> None:
    rig.moving()
    robot.silent = True
    fallen(robot, rig, "")
    robot.silent = False


def test_a_joint_that_turns_the_other_way(robot: StandIn, rig: LiveRig) -> None:
    robot.arms.signs["left_s0"] = -1.0
    rig.heard()
    rig.enable()
    rig.move("left_s0", 0.6)
    rig.confirm()
    rig.until(lambda: rig.phase is Phase.OFF)
    assert "left_s0 went elsewhere" in rig.why
    assert -ASIDE - 0.1 < robot.arms.positions["left_s0"] < 0.0


def test_a_disabled_robot_stays_where_it_is(robot: StandIn, rig: LiveRig) -> None:
    rig.moving()
    rig.thread.order(lambda link: link.disable())
    rig.until(lambda: not robot.arms.powered)
    fallen(robot, rig, "")
