"""The studio's own world as a robot behind a link: nobody needs another one to try things out."""

from collections.abc import Iterator

import numpy as np
import pytest

from studio.engine.links.address import link_at
from studio.engine.links.driver import STALE
from studio.engine.links.link import LinkError, RobotLink
from studio.engine.links.simulated import SimulatedRobot
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES
from tests.engine.links.rig import LiveRig
from tests.engine.links.unhurried import CLOCK
from tests.engine.live.streaming import Clock


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def link(clock: Clock) -> Iterator[SimulatedRobot]:
    made = link_at("simulated://", clock)
    assert isinstance(made, SimulatedRobot)
    made.open()
    yield made
    made.close()


def pass_time(link: RobotLink, clock: Clock, seconds: float, **targets: float) -> np.ndarray:
    for _ in range(round(30 * seconds)):
        clock.time += 1 / 30
        if targets:
            link.send(targets)
        state = link.read() or state  # noqa: F821 - the first tick always has one
    return state.positions


def test_it_obeys_only_with_power_and_holds_without_commands(link, clock: Clock) -> None:
    assert pass_time(link, clock, 0.5, left_s0=0.4)[0] == pytest.approx(0.0, abs=0.01)
    link.enable()
    assert pass_time(link, clock, 1.0, left_s0=0.2)[0] == pytest.approx(0.2, abs=0.01)
    moving = pass_time(link, clock, 0.1, left_s0=1.5)[0]
    assert moving > 0.22
    held = pass_time(link, clock, STALE + 0.5)[0]
    later = pass_time(link, clock, 1.0)[0]
    assert held < 1.0
    assert later == pytest.approx(held, abs=0.01)
    link.disable()
    assert pass_time(link, clock, 0.5, left_s0=-0.5)[0] == pytest.approx(held, abs=0.01)


def test_told_to_hold_it_does_so_at_once(link, clock: Clock) -> None:
    link.enable()
    moving = pass_time(link, clock, 0.1, left_s0=1.5)[0]
    link.stop()
    held = pass_time(link, clock, 0.5)[0]
    assert held == pytest.approx(moving, abs=0.12)  # a motor's way to a halt
    assert pass_time(link, clock, 1.0)[0] == pytest.approx(held, abs=0.01)
    assert pass_time(link, clock, 1.5, left_s0=1.5)[0] > held + 0.3


def test_its_time_is_the_clock_s_but_for_long_pauses(link, clock: Clock) -> None:
    assert link.read() is not None
    assert link.read() is None
    before = link._world.state.time
    clock.time += 3600.0
    assert link.read() is not None
    assert link._world.state.time - before <= 15 * CONTROL_PERIOD


def test_closed_it_says_so(link) -> None:
    link.close()
    link.close()
    with pytest.raises(LinkError, match="not open"):
        link.read()
    assert set(JOINT_NAMES) == set(link.limits)


def test_it_goes_along_like_any_other() -> None:
    with LiveRig(link_at("simulated://", CLOCK)) as rig:
        rig.moving()
        rig.until(lambda: rig.measured("left_s0") > 0.02)
