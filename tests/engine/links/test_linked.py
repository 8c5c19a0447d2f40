"""A session with a robot that goes along: sent what the page's robot is, and only when it may."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.links import linked
from studio.engine.links.driver import Heard
from studio.engine.links.linked import Linked
from studio.engine.links.status import FIRST_RATIO, Phase
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES, load_robot
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from tests.engine.links.rig import LEFT, Model
from tests.engine.sessions import do

COLUMNS = [JOINT_NAMES.index(name) for name in LEFT]


class Direct:
    """In place of a link's thread: the model hears at once, and everything is in step."""

    url, trouble, limits, is_open = "model://", "", {}, True
    model: Model

    def __init__(self, link: object, now) -> None:
        self.now, self.ratio, self.ended, self.silent = now, 0.0, False, False
        self.halted = 0
        Direct.newest = self

    @property
    def heard(self) -> Heard | None:
        return None if self.silent else Heard(self.model.state(), self.now())

    def put(self, targets: dict[str, float] | None) -> None:
        self.model.obey(targets)

    def halt(self) -> None:
        self.halted += 1
        self.model.obey(None)

    def order(self, order) -> None:
        order(self)

    def enable(self) -> None:
        self.model.enabled = True

    def disable(self) -> None:
        self.model.enabled = False

    def set_speed(self, ratio: float) -> None:
        self.ratio = ratio

    def end(self) -> None:
        self.ended = True

    close = end


class Desk:
    """A session, its robot, and time that passes tick by tick."""

    def __init__(self, folder: Path) -> None:
        self.time = 0.0
        self.session = Session(folder, linked=Linked(lambda: self.time))
        Direct.model = self.model = Model(self.session.snapshot.world.joint_positions)

    def do(self, *orders: commands.Command) -> Snapshot:
        self.time += CONTROL_PERIOD
        return do(self.session, *orders)

    def until(self, reached, most: int = 900) -> Snapshot:
        for _ in range(most):
            if reached(now := self.do()):
                return now
        raise AssertionError(self.session.snapshot.link.words)

    def link(self) -> Snapshot:
        """Connect, enable, and come to the pose on the page."""
        self.do(commands.ConnectLink("simulated://"))
        self.do()
        self.do(commands.EnableLink())
        self.do(commands.StartLink(confirmed=True))
        return self.until(lambda now: now.link.phase is Phase.READY)


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    monkeypatch.setattr(linked, "LinkThread", Direct)
    made = Desk(tmp_path / "recordings")
    yield made
    made.session.close()


def test_the_robot_follows_while_the_gate_is_armed_and_only_then(desk: Desk) -> None:
    desk.link()
    desk.do(commands.SetLinkSpeed(1.0))
    desk.do(commands.UseDemonstrator(), commands.Record())
    behind, armed = [], 0
    for _ in range(900):
        before = len(desk.model.commands)
        now = desk.do()
        sent = len(desk.model.commands) - before
        assert sent == int(now.gate is not None and now.gate.armed)
        assert now.link.is_moving is bool(sent)
        if sent:
            armed += 1
            asked = [desk.model.commands[-1][name] for name in LEFT]
            behind.append(np.abs(desk.model.positions[COLUMNS] - asked).max())
            assert now.link.phase is Phase.READY
        if now.mode is Mode.IDLE:
            break
    assert armed > 100
    assert max(behind) < 1e-6
    # The whole motion went over, at full speed without being behind: as the page's robot went.
    measured = now.world.joint_positions[COLUMNS]
    assert np.abs(desk.model.positions[COLUMNS] - measured).max() < 0.1


def test_at_first_it_goes_slower_and_says_by_how_much(desk: Desk) -> None:
    desk.link()
    assert Direct.newest.ratio == FIRST_RATIO
    desk.do(commands.UseDemonstrator(), commands.Watch())
    now = desk.until(lambda now: now.link.is_moving and now.link.lag > 0.1)
    assert "behind what is shown" in now.link.words


def test_a_session_that_is_hurried_hurries_no_robot(desk: Desk) -> None:
    """A program may have ticks come as fast as the machine can; a robot's second is a second."""
    desk.link()
    desk.do(commands.SetLinkSpeed(1.0))
    desk.do(commands.UseDemonstrator(), commands.Watch())
    desk.until(lambda now: now.link.is_moving)
    begun, first = desk.time, len(desk.model.commands)
    for _ in range(200):
        desk.time += CONTROL_PERIOD / 20 - CONTROL_PERIOD
        if not desk.do().link.is_moving:
            break
    sent = np.array([[told[name] for name in LEFT] for told in desk.model.commands[first:]])
    assert len(sent) > 50
    way = np.abs(np.diff(sent, axis=0)).sum(axis=0)
    fastest = load_robot().limits_of(LEFT).velocity
    assert (way <= fastest * (desk.time - begun) + 1e-9).all()
    assert way.max() > 0.05


def test_stop_stops_the_robot_as_well(desk: Desk) -> None:
    desk.link()
    desk.do(commands.UseDemonstrator(), commands.Watch())
    desk.until(lambda now: now.link.is_moving)
    count = len(desk.model.commands)
    now = desk.do(commands.Stop())
    assert len(desk.model.commands) == count
    assert (now.link.phase, now.link.is_moving) == (Phase.OFF, False)
    desk.do(commands.UseDemonstrator(), commands.Watch())
    for _ in range(300):
        desk.do()
    assert len(desk.model.commands) == count


def test_the_robot_stops_where_whoever_controls_is_gone(desk: Desk) -> None:
    """The page's Baxter goes on alone; a real one does not."""
    taught(desk)
    desk.do(commands.PlayDemonstration())
    desk.do(commands.StartLink(confirmed=True))
    desk.until(lambda now: now.link.phase is Phase.READY)
    desk.do(commands.TogglePlay())
    desk.until(lambda now: now.link.is_moving)
    count = len(desk.model.commands)
    now = desk.do(commands.LetGo("The browser in control has gone."))
    assert (now.link.phase, now.mode) == (Phase.OFF, Mode.PLAYING)
    assert "browser in control has gone" in now.link.words
    desk.do()
    assert len(desk.model.commands) == count


def test_a_program_that_drives_the_page_s_robot_drives_no_other(desk: Desk) -> None:
    desk.link()
    count = len(desk.model.commands)
    for _ in range(30):
        now = desk.do(commands.SetJointTarget({"left_s0": 0.3}))
    assert now.mode is Mode.DRIVEN
    assert len(desk.model.commands) == count


@pytest.mark.parametrize("command", [commands.StopLink(), commands.DisableLink()])
def test_the_robot_alone_is_stopped(desk: Desk, command: commands.LinkCommand) -> None:
    desk.link()
    desk.do(commands.UseDemonstrator(), commands.Watch())
    desk.until(lambda now: now.link.is_moving)
    count = len(desk.model.commands)
    now = desk.do(command)
    assert now.link.phase is Phase.OFF
    assert desk.model.enabled is isinstance(command, commands.StopLink)
    assert desk.do().mode is not Mode.IDLE  # teaching goes on
    assert len(desk.model.commands) == count


def taught(desk: Desk) -> None:
    """A demonstration is listed, and the robot waits somewhere else."""
    desk.do(commands.UseDemonstrator(), commands.Record())
    desk.until(lambda now: now.mode is Mode.IDLE)
    desk.link()
    desk.model.positions = desk.model.positions.copy()


def test_playing_waits_until_the_robot_was_allowed_to_go_there(desk: Desk) -> None:
    taught(desk)
    desk.model.positions[COLUMNS[0]] += 0.5  # somebody has led it away
    desk.do(commands.PlayDemonstration())
    count = len(desk.model.commands)
    now = desk.until(lambda now: now.mode is Mode.IDLE)
    assert "Paused for the robot" in now.message.text
    assert now.time < 0.2
    assert len(desk.model.commands) == count
    refused = desk.do(commands.StartLink())
    assert refused.message.is_error
    assert "emergency stop" in refused.message.text
    desk.do(commands.StartLink(confirmed=True))
    desk.until(lambda now: now.link.phase is Phase.READY)
    desk.do(commands.TogglePlay())
    now = desk.until(lambda now: now.time > 1.0)
    assert now.link.is_moving
    assert now.mode is Mode.PLAYING


def test_a_robot_goes_along_at_real_time_or_slower(desk: Desk) -> None:
    taught(desk)
    desk.do(commands.SetSpeed(2.0))
    desk.do(commands.PlayDemonstration())
    desk.do(commands.StartLink(confirmed=True))
    desk.until(lambda now: now.link.phase is Phase.READY)
    count = len(desk.model.commands)
    desk.do(commands.Scrub(0.0))
    for _ in range(30):
        now = desk.do()
    assert (now.mode, len(desk.model.commands)) == (Mode.PLAYING, count)
    assert "set the speed" in now.link.words


def test_scrubbing_is_no_way_to_move_a_robot(desk: Desk) -> None:
    taught(desk)
    desk.do(commands.PlayDemonstration())
    desk.do(commands.StartLink(confirmed=True))
    desk.until(lambda now: now.link.phase is Phase.READY)
    desk.do(commands.Stop())
    count = len(desk.model.commands)
    for position in (3.0, 1.0, 4.0):
        desk.do(commands.Scrub(position))
    assert len(desk.model.commands) == count


def test_what_is_lost_is_said_and_not_gone_on_with(desk: Desk) -> None:
    desk.link()
    desk.do(commands.UseDemonstrator(), commands.Watch())
    desk.until(lambda now: now.link.is_moving)
    Direct.newest.silent = True
    now = desk.do()
    assert "connection is lost" in now.message.text
    assert not now.link.is_connected
    count = len(desk.model.commands)
    Direct.newest.silent = False
    for _ in range(30):
        now = desk.do()
    assert (len(desk.model.commands), now.link.phase) == (count, Phase.OFF)


def test_who_cannot_be_told_to_disable_is_not_said_to_be(desk: Desk) -> None:
    desk.link()
    Direct.newest.is_open = False
    now = desk.do(commands.DisableLink())
    assert now.message.is_error
    assert "e-stop" in now.message.text
    assert now.link.phase is Phase.OFF
    assert desk.model.enabled  # nothing was told


def test_a_robot_is_let_alone(desk: Desk) -> None:
    desk.link()
    now = desk.do(commands.DisconnectLink())
    assert (now.link.url, Direct.newest.ended) == ("", True)
    assert desk.do(commands.EnableLink()).message.is_error


@pytest.mark.parametrize(
    "url", ["", "baxter", "http://robot:9090", "rosbridge://", "rosbridge://a:b"]
)
def test_a_wrong_address_is_refused_in_words(desk: Desk, url: str) -> None:
    now = desk.do(commands.ConnectLink(url))
    assert now.message.is_error
    assert "rosbridge://HOST:9090" in now.message.text
    assert now.link.url == ""


def test_without_a_clock_there_is_no_robot(tmp_path: Path) -> None:
    session = Session(tmp_path)
    try:
        now = do(session, commands.ConnectLink("simulated://"))
        assert "studio serve" in now.message.text
    finally:
        session.close()


def test_a_stop_halts_the_link_s_thread_in_whatever_phase(desk: Desk) -> None:
    desk.do(commands.ConnectLink("simulated://"))
    desk.do(commands.Stop())
    assert Direct.newest.halted == 1


def test_a_link_is_known_at_once(desk: Desk) -> None:
    desk.session.post(commands.ConnectLink("simulated://"))
    desk.session.hear()
    assert desk.session.snapshot.link.url == "simulated://"


def test_no_robot_goes_where_a_program_drives_the_page_s(desk: Desk) -> None:
    desk.do(commands.ConnectLink("simulated://"))
    desk.do()
    desk.do(commands.EnableLink())
    desk.do(commands.SetJointTarget({"left_s0": 0.3}))
    refused = desk.do(commands.StartLink(confirmed=True))
    assert refused.message.is_error
    assert "A program drives" in refused.message.text
    assert (refused.link.phase, desk.model.commands) == (Phase.WAITING, [])
    desk.do(commands.Stop())
    desk.do(commands.EnableLink())
    assert desk.do(commands.StartLink(confirmed=True)).link.phase is Phase.STARTING


def test_no_speed_is_told_before_the_robot_is_enabled(desk: Desk) -> None:
    """Nothing leaves; it is told with its share as soon as it is enabled."""
    desk.do(commands.ConnectLink("simulated://"))
    desk.do(commands.SetLinkSpeed(0.7))
    assert Direct.newest.ratio == 0.0
    desk.do()
    desk.do(commands.EnableLink(), commands.SetLinkSpeed(0.6))
    assert (desk.do().link.phase, Direct.newest.ratio) == (Phase.WAITING, 0.6)
    desk.do(commands.SetLinkSpeed(0.5))
    assert Direct.newest.ratio == 0.5
    desk.do(commands.StopLink(), commands.SetLinkSpeed(0.4))
    assert Direct.newest.ratio == 0.5
    desk.do(commands.EnableLink())
    assert (desk.do().link.phase, Direct.newest.ratio) == (Phase.WAITING, 0.4)
