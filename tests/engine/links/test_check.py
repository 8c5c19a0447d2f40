"""The check finds each fault that a robot may have, and leaves it without power."""

from collections.abc import Iterator
from unittest.mock import ANY

import numpy as np
import pytest

from studio.engine.links import check, consent, coppeliasim, moving_check, rosbridge
from studio.engine.links.address import link_at
from studio.engine.links.check import RISES, Finding, Looking, look
from studio.engine.links.driver import LinkThread
from studio.engine.links.moving_check import MovingCheck
from studio.engine.robot import ARM_JOINTS, CONTROL_PERIOD, JOINT_NAMES, load_robot
from studio.engine.skeleton import SIDES
from tests.engine.links.coppeliasim_server import CoppeliaSimServer
from tests.engine.links.rig import HASTE
from tests.engine.links.rosbridge_server import RosbridgeServer
from tests.engine.links.unhurried import CLOCK, PATIENCE, eventually


@pytest.fixture(autouse=True)
def hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    """Less is looked at; and all the time is given to what has to come."""
    monkeypatch.setattr(check, "LISTENS", 0.1)
    monkeypatch.setattr(check, "CONNECTS_WITHIN", PATIENCE)
    monkeypatch.setattr(check, "SLOWEST", 1.0)
    monkeypatch.setattr(moving_check, "SPEED", 0.2)
    monkeypatch.setattr(moving_check, "_LOOKS", 0.1)
    monkeypatch.setattr(moving_check, "_SETTLES", 0.5)


@pytest.fixture(params=[RosbridgeServer, CoppeliaSimServer], ids=["rosbridge", "coppeliasim"])
def robot(request) -> Iterator[RosbridgeServer | CoppeliaSimServer]:
    with request.param(CLOCK, HASTE) as server:
        server.arms.positions["left_e1"] = 0.6
        yield server
        assert server.complaints == []


@pytest.fixture
def looking(robot) -> Iterator[Looking]:
    thread = LinkThread(link_at(robot.url, CLOCK), CLOCK)
    yield Looking(thread, CLOCK, lambda: CLOCK.sleep(CONTROL_PERIOD / HASTE))
    thread.close()


def by_name(findings) -> dict[str, Finding]:
    return {each.name: each for each in findings}


def test_a_robot_that_is_well(robot, looking: Looking) -> None:
    found = by_name(look(looking))
    assert [each.passed for each in found.values()] == [True] * 5 + [None]
    assert "left_e1 +34°" in found["order and sign"].words
    assert robot.arms.commands == []
    assert not robot.arms.powered


@pytest.mark.parametrize("robot", [RosbridgeServer], indirect=True)
def test_each_joint_is_moved_and_brought_back(robot, looking: Looking) -> None:
    list(look(looking))
    before = dict(robot.arms.positions)
    asked: list[str] = []

    def ask(question: str) -> bool | None:
        asked.append(question)
        return "press" not in question

    found = by_name(MovingCheck(looking, "left", ask).findings())
    assert {each.passed for each in found.values()} == {True, None}
    assert found["emergency stop pressed"].passed is None
    assert [name.split()[0] for name in found if name.startswith("left_")] == [
        f"left_{joint}" for joint in ARM_JOINTS
    ]
    assert len(asked) == len(ARM_JOINTS) + 1
    after = robot.arms.positions
    assert max(abs(after[name] - before[name]) for name in after) < 0.02
    assert not robot.arms.powered


@pytest.mark.parametrize("robot", [RosbridgeServer], indirect=True)
@pytest.mark.parametrize("fault", ["sign", "swapped", "person"])
def test_a_wrong_joint_is_found(robot, looking: Looking, fault: str) -> None:
    if fault == "sign":
        robot.arms.signs["left_s0"] = -1.0
    elif fault == "swapped":
        inner = robot.arms.obey
        names = {"left_s0": "left_w0", "left_w0": "left_s0"}
        robot.arms.obey = lambda targets: inner({names.get(n, n): a for n, a in targets.items()})
    list(look(looking))
    answer = False if fault == "person" else None
    findings = MovingCheck(looking, "left", lambda _: answer).findings()
    assert next(findings).passed is True
    assert next(findings) == Finding("left_s0 +6°", False, ANY)
    findings.close()  # a person has seen enough
    eventually(lambda: not robot.arms.powered)  # the last thing that it is told
    left = looking.thread.sent
    CLOCK.sleep(0.1)
    assert looking.thread.sent == left


def test_a_pressed_stop_is_told(robot, looking: Looking) -> None:
    robot.press()
    found = by_name(look(looking))
    assert found["emergency stop"].passed is False


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """That nobody is there is heard of by no answer."""
    monkeypatch.setattr(coppeliasim, "_ANSWERS_WITHIN", 0.2)
    monkeypatch.setattr(rosbridge, "_CONNECTS_WITHIN", 0.2)


@pytest.mark.usefixtures("impatient")
def test_nobody_there(robot, looking: Looking, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check, "CONNECTS_WITHIN", 0.25)
    robot.kill()
    found = list(look(looking))
    assert found[-1].passed is False
    assert found[-1].words


def test_what_a_person_should_see_is_what_the_kinematics_say() -> None:
    """Stretched out: swings about the vertical, downward bends, and rolls about the arm."""
    robot, rest = load_robot(), np.zeros(len(JOINT_NAMES))
    for side in SIDES:
        shoulder, hand = f"{side}_upper_shoulder", f"{side}_hand"
        begun = robot.link_poses(rest)
        arm = begun[hand][:3, 3] - begun[shoulder][:3, 3]
        for joint, words in RISES.items():
            risen = rest.copy()
            risen[JOINT_NAMES.index(f"{side}_{joint}")] = 0.1
            after = robot.link_poses(risen)
            moved = after[hand][:3, 3] - begun[hand][:3, 3]
            turned = after[hand][:3, :3] @ begun[hand][:3, :3].T
            axis = np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0]])
            axis = np.array([*axis, turned[1, 0] - turned[0, 1]]) / 2 / np.sin(0.1)
            if "down" in words:
                assert moved[2] < -0.02
            elif "counterclockwise" in words:
                assert axis == pytest.approx([0, 0, 1], abs=1e-6)
            else:  # a screw that is turned clockwise goes away from who looks
                assert "clockwise" in words
                assert axis @ arm / np.linalg.norm(arm) > 0.9


@pytest.mark.parametrize("robot", [RosbridgeServer], indirect=True)
def test_interrupted_by_a_person_it_takes_the_power_off(robot, looking: Looking) -> None:
    list(look(looking))

    def ask(_: str) -> bool | None:
        assert robot.arms.powered
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        list(MovingCheck(looking, "left", ask).findings())
    looking.thread.close()
    eventually(lambda: not robot.arms.powered)


@pytest.mark.parametrize("robot", [RosbridgeServer], indirect=True)
def test_a_watchdog_to_which_nothing_was_sent_has_not_passed(robot, looking: Looking) -> None:
    list(look(looking))
    checked = MovingCheck(looking, "left", lambda _: None)
    assert checked._begin().passed
    checked._memory = consent.stop(checked._memory, "Somebody stopped it.")
    found = checked._watchdog()
    assert not found.passed
    assert "nothing was sent" in found.words
