"""The robot's part of the page: every button says why it does nothing, and Stop is Stop."""

from collections.abc import Iterator
from dataclasses import replace

import pytest
import viser

from studio.engine import commands
from studio.engine.links.status import LinkStatus, Phase
from studio.engine.snapshot import Snapshot
from studio.panels import robot_link
from studio.panels.robot_link import RobotLine, RobotPanel, described
from tests.panels.people import use

URL = "rosbridge://baxter:9090"
HEARD = LinkStatus(url=URL, is_connected=True, words="Not enabled.")
STATES = {
    "none": LinkStatus(),
    "lost": LinkStatus(url=URL, words="no rosbridge <answers>"),
    "heard": HEARD,
    "pressed": replace(HEARD, stop="The e-stop is pressed."),
    "released": replace(HEARD, stop="The e-stop is released.", resets=True),
    "enabling": replace(HEARD, phase=Phase.ENABLING),
    "waiting": replace(HEARD, phase=Phase.WAITING, is_enabled=True),
    "starting": replace(HEARD, phase=Phase.STARTING, is_enabled=True, is_moving=True),
    "ready": replace(HEARD, phase=Phase.READY, is_enabled=True),
}


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    made = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield made
    made.stop()


class Shown:
    def __init__(self, gui: viser.GuiApi, start: Snapshot) -> None:
        self.posted: list[commands.Command] = []
        self.controls = True  # whoever acts
        self.panel = RobotPanel(gui, self.posted.append, lambda: self.controls)
        self.start = start

    def draw(self, state: str, is_safe: bool = False) -> set[str]:
        """Draw a state; return the names of the buttons that can be pressed."""
        self.panel._safe.value = is_safe
        self.panel.draw(replace(self.start, link=STATES[state]))
        buttons = ("_connect", "_leave", "_enable", "_start", "_disable")
        return {name[1:] for name in buttons if not getattr(self.panel, name).disabled}

    @property
    def is_safe(self) -> bool:
        return self.panel._safe.value

    def press(self, name: str) -> None:
        for act in getattr(self.panel, f"_{name}")._impl.update_cb:
            act(None)

    @property
    def words(self) -> str:
        return self.panel._state.content


@pytest.fixture
def shown(server, lesson) -> Shown:
    return Shown(server.gui, lesson["start"])


@pytest.mark.parametrize(
    ("state", "is_safe", "can", "words"),
    [
        ("none", False, {"connect"}, "Connect a robot first."),
        ("lost", False, {"leave", "disable"}, "see its power, its network"),
        ("heard", False, {"leave", "disable", "enable"}, "Enable its motors first."),
        ("pressed", True, {"leave", "disable"}, "The e-stop is pressed."),
        ("released", True, {"leave", "disable", "enable"}, "The e-stop is released."),
        ("enabling", True, {"leave", "disable"}, "Enable its motors first."),
        ("waiting", False, {"leave", "disable"}, "Tick the box above first"),
        ("waiting", True, {"leave", "disable", "start"}, "It is enabled; Stop ends that."),
        ("starting", True, {"leave", "disable"}, "It is on its way."),
        ("ready", True, {"leave", "disable", "start"}, "It is enabled; Stop ends that."),
    ],
)
def test_what_can_be_done_and_why_not(shown: Shown, state, is_safe, can, words) -> None:
    assert shown.draw(state, is_safe) == can
    assert words in shown.words


def test_buttons_ask_for_what_they_say(shown: Shown) -> None:
    shown.panel._address.value = URL
    shown.draw("waiting", is_safe=True)
    for name in ("connect", "enable", "start", "disable", "leave"):
        shown.press(name)
    assert shown.posted == [
        commands.ConnectLink(URL),
        commands.EnableLink(),
        commands.StartLink(confirmed=True),
        commands.DisableLink(),
        commands.DisconnectLink(),
    ]


def test_each_first_move_is_confirmed_by_itself(shown: Shown) -> None:
    shown.draw("waiting", is_safe=True)
    shown.press("start")
    shown.press("start")
    assert shown.posted == [commands.StartLink(confirmed=True), commands.StartLink()]


def test_the_box_waits_for_an_enabled_robot_and_says_so(shown: Shown) -> None:
    for state, link in STATES.items():
        shown.draw(state, is_safe=True)
        can_be_ticked = state in ("waiting", "ready")
        assert shown.panel._safe.disabled is not can_be_ticked
        assert shown.is_safe is can_be_ticked  # what was confirmed before is over
        if not can_be_ticked:
            assert robot_link.why_not_start(link, is_safe=True) in shown.words


def test_who_only_watches_uses_nobodys_confirmation(shown: Shown) -> None:
    shown.draw("waiting")
    use(shown.panel._safe, True)  # which only whoever controls can: tests/panels/test_shared.py
    shown.controls = False
    shown.press("start")
    assert (shown.is_safe, shown.posted) == (True, [])
    shown.controls = True
    shown.press("start")
    assert (shown.is_safe, shown.posted) == (False, [commands.StartLink(confirmed=True)])


def test_a_speed_that_was_refused_is_not_shown_for_long(shown: Shown) -> None:
    shown.draw("waiting")
    use(shown.panel._speed.control, 80.0)
    for _ in range(12):
        shown.draw("waiting")
    assert shown.panel._speed.control.value == pytest.approx(30.0)
    assert shown.posted == [commands.SetLinkSpeed(0.8)]


def test_the_line_is_in_sight_only_with_a_robot(server, lesson) -> None:
    line = RobotLine(server.gui)
    line.draw(lesson["start"])
    assert not line._line.visible
    line.draw(replace(lesson["start"], link=STATES["lost"]))
    assert line._line.visible
    assert "no rosbridge &lt;answers&gt;" in line._line.content
    assert "moves" in described(STATES["starting"])
