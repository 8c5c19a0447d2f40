"""The robot beyond the simulator: connect it, enable it, confirm the first move; how it stands.

Stop and Esc stop it, too; both are always in sight.
"""

from collections.abc import Callable

import viser

from studio.engine import commands
from studio.engine.links.address import EXAMPLES
from studio.engine.links.status import FIRST_RATIO, LEAST_RATIO, LinkStatus, Phase
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.inputs import Post, show_value
from studio.panels.synced import Synced

SAFE = "I made sure"
_OF_WHAT = "Before its first move: nobody is near, the desk is clear, the e-stop is at hand."
_NOT_CONNECTED = "Connect a robot first."


class RobotPanel:
    """A part of the first step.

    Parameters
    ----------
    gui
        Of all browsers.
    post
        Where people's commands go.
    may_act
        Tells whether whoever is heard may act, and says so where not.
    """

    def __init__(self, gui: viser.GuiApi, post: Post, may_act: Callable[[], bool]) -> None:
        self._post, self._may_act = post, may_act
        self._address = gui.add_text("Address", "simulated://", hint=EXAMPLES)
        self._connect = gui.add_button("Connect", icon=viser.Icon.PLUG_CONNECTED, color="gray")
        self._connect.on_click(lambda _: post(commands.ConnectLink(self._address.value)))
        self._leave = gui.add_button("Let it alone", icon=viser.Icon.PLUG_X, color="gray")
        self._leave.on_click(lambda _: post(commands.DisconnectLink()))
        self._enable = gui.add_button("Enable its motors", icon=viser.Icon.POWER)
        self._enable.on_click(lambda _: post(commands.EnableLink()))
        gui.add_html(markup.note(_OF_WHAT))
        self._safe = gui.add_checkbox(SAFE, False)
        self._start = gui.add_button(
            "Go to the pose on the page, slowly",
            hint="From there it follows whenever the gate is armed or a motion plays",
            icon=viser.Icon.PLAYER_TRACK_NEXT,
        )
        self._start.on_click(lambda _: self._go())
        speed = gui.add_slider(
            "% of its top speed", 100 * LEAST_RATIO, 100.0, 5.0, 100 * FIRST_RATIO
        )
        self._speed = Synced(speed, lambda: post(commands.SetLinkSpeed(speed.value / 100)))
        self._disable = gui.add_button(
            "Disable: take its power", icon=viser.Icon.POWER, color="gray"
        )
        self._disable.on_click(lambda _: post(commands.DisableLink()))
        self._state = gui.add_html("")

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        link = now.link
        refusals = (
            (self._connect, why_not_connect(link)),
            (self._leave, why_not_leave(link)),
            (self._enable, why_not_enable(link)),
            (self._safe, why_not_start(link, is_safe=True)),
            (self._start, why_not_start(link, self._safe.value)),
            (self._disable, why_not_leave(link)),
        )
        for control, refusal in refusals:
            control.disabled = bool(refusal)
        if self._safe.disabled and self._safe.value:  # what was confirmed is over
            show_value(self._safe, False)
        self._speed.show(float(round(100 * link.ratio)))
        reasons = markup.reasons(refusal for _, refusal in refusals)
        self._state.content = described(link) + reasons

    def _go(self) -> None:
        """Let it go, and ask for the confirmation anew the next time."""
        if self._may_act():
            self._post(commands.StartLink(self._safe.value))
            show_value(self._safe, False)


class RobotLine:
    """How the robot stands, always in sight where one is linked."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._line = gui.add_html("", visible=False)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._line.visible = bool(now.link.url)
        self._line.content = described(now.link) if now.link.url else ""


def described(link: LinkStatus) -> str:
    """Return how the robot stands, as HTML."""
    if not link.url:
        return markup.note(
            "No robot is linked. One that is does what the robot on the page does, through limits, "
            "speed ratio and collision guard of its own. simulated:// is for trying this out."
        )
    if link.stop or not link.is_connected:
        return markup.problem(f"Robot {link.url}: {link.stop or link.words}")
    word = "moves" if link.is_moving else link.phase.value
    return markup.block(f"<b>Robot {word}</b>: {markup.text(link.words)}")


def why_not_connect(link: LinkStatus) -> str:
    """Return why no robot can be connected."""
    return "To connect another robot, let this one alone first." if link.url else ""


def why_not_leave(link: LinkStatus) -> str:
    """Return why there is none to be let alone or disabled."""
    return "" if link.url else _NOT_CONNECTED


def why_not_enable(link: LinkStatus) -> str:
    """Return why its motors cannot be enabled."""
    if not link.url:
        return _NOT_CONNECTED
    if not link.is_connected:
        return "The robot is not heard: see its power, its network and its address."
    if link.stop and not link.resets:
        return link.stop
    return "" if link.phase is Phase.OFF else "It is enabled; Stop ends that."


def why_not_start(link: LinkStatus, is_safe: bool) -> str:
    """Return why it cannot go to the pose on the page."""
    if not link.url:
        return _NOT_CONNECTED
    if link.phase in (Phase.OFF, Phase.ENABLING):
        return "Enable its motors first."
    if link.phase is Phase.STARTING:
        return "It is on its way."
    return "" if is_safe else "Tick the box above first, once it is true."
