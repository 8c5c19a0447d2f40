"""What a session has on the wire: from commands, through gatekeeper and link, to either stand-in.

All that runs in the live studio takes part, but for the browser: a command is heard where a robot
would hear it, or it is not.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.links.linked import Linked
from studio.engine.links.status import Phase
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES
from studio.engine.session import Session
from studio.engine.skeleton import FloatArray
from studio.engine.snapshot import Snapshot
from tests.engine.links.arms_model import JOINTS
from tests.engine.links.coppeliasim_server import CoppeliaSimServer
from tests.engine.links.rig import HASTE, LEFT
from tests.engine.links.rosbridge_server import RosbridgeServer
from tests.engine.links.unhurried import CLOCK
from tests.engine.sessions import do

COLUMNS = [JOINT_NAMES.index(joint) for joint in LEFT]
StandIn = RosbridgeServer | CoppeliaSimServer
_ARRIVES = 10  # ticks, in which all that is on its way has come there
_MOST = 600  # ticks, for whatever has to come


@dataclass
class Studio:
    """A session, and the robot at the other end of the wire."""

    session: Session
    robot: StandIn

    def tick(self, *orders: commands.Command) -> Snapshot:
        """Do a tick in the time that a robot's motors have for it here."""
        CLOCK.sleep(CONTROL_PERIOD / HASTE)
        return self.at_once(*orders)

    def at_once(self, *orders: commands.Command) -> Snapshot:
        """Do a tick in which no time passes for the robot, however long the machine takes."""
        with CLOCK.standing():
            return do(self.session, *orders)

    def until(self, reached: Callable[[Snapshot], object], *orders: commands.Command) -> Snapshot:
        now = self.tick(*orders)
        for _ in range(_MOST):
            if reached(now):
                return now
            now = self.tick()
        raise AssertionError(f"never: {now.message.text} {now.link.phase} {now.link.words}")

    @property
    def heard(self) -> int:
        return len(self.robot.arms.commands)

    def on_the_way(self) -> int:
        """How much the robot has heard once all has come there."""
        for _ in range(_ARRIVES):
            self.tick()
        return self.heard

    def follow(self) -> None:
        """Let the demonstrator begin, the robot be led, enabled and confirmed, and go along."""
        pose = self.tick(commands.UseDemonstrator(), commands.Watch()).world.joint_positions
        angles = dict(zip(JOINT_NAMES, pose.tolist(), strict=True))
        self.robot.arms.lead({joint: angles[joint] for joint in JOINTS})
        before = self.heard
        self.until(lambda now: now.link.is_connected)
        self.until(lambda now: now.link.phase is Phase.WAITING, commands.EnableLink())
        assert self.heard == before  # nobody has confirmed
        start = commands.StartLink(confirmed=True)
        self.until(lambda now: now.link.phase is Phase.READY, start)
        before = self.on_the_way()
        while not self.at_once().gate.armed:  # nobody need wait for that
            assert self.heard == before
        self.until(lambda now: self.has_come_along(pose, now.world.joint_positions))

    def has_come_along(self, begun: FloatArray, page: FloatArray) -> bool:
        """Tell whether the page's robot has moved, and the other is where it is."""
        there = np.array([self.robot.arms.positions[joint] for joint in LEFT])
        page_moved, apart = np.abs(page - begun).max(), np.abs(page[COLUMNS] - there).max()
        return bool(page_moved > 0.05 and apart < 0.04)


@pytest.fixture(params=[RosbridgeServer, CoppeliaSimServer], ids=["rosbridge", "coppeliasim"])
def studio(request, tmp_path: Path) -> Iterator[Studio]:
    with request.param(CLOCK, HASTE) as robot:
        session = Session(tmp_path / "recordings", linked=Linked(CLOCK))
        yield Studio(session, robot)
        session.close()
        assert robot.complaints == []


def ended(studio: Studio, phase: Phase = Phase.OFF) -> None:
    """Nothing more is on the wire, and the robot stands, whatever the page's does."""
    before, now = studio.on_the_way(), studio.session.snapshot
    assert (now.link.phase, now.link.is_moving) == (phase, False)
    stands = dict(studio.robot.arms.positions)
    assert studio.on_the_way() == before
    assert studio.robot.arms.positions == pytest.approx(stands, abs=1e-6)


def test_the_robot_follows_and_each_way_to_stop_it_does(studio: Studio) -> None:
    robot = studio.robot
    studio.tick(commands.ConnectLink(robot.url), commands.SetLinkSpeed(1.0))
    studio.until(lambda now: now.link.is_connected)
    assert studio.on_the_way() == 0  # it is listened to
    assert not robot.arms.powered

    studio.follow()
    studio.tick(commands.Stop())
    ended(studio)
    for order in (commands.DisableLink(), commands.LetGo("The browser in control has gone.")):
        studio.follow()
        studio.tick(order)
        ended(studio)
        assert robot.arms.powered is not isinstance(order, commands.DisableLink)

    studio.follow()
    robot.press()
    studio.until(lambda now: now.link.phase is Phase.OFF)
    assert studio.session.snapshot.link.stop
    ended(studio)
    assert {joint for _, told in robot.arms.commands for joint in told} == {*LEFT}
