"""A session's part that is linked to a robot: commands in, one tick at a time, status out.

What is seen and steered stays the simulation. Where a robot is linked, whatever the session sends
to its own goes through the gatekeeper to that robot, too.
"""

from collections.abc import Callable

import numpy as np

from studio.engine import commands
from studio.engine.activity import Activity
from studio.engine.choices import Choices
from studio.engine.errors import StudioError
from studio.engine.links import consent
from studio.engine.links.address import link_at
from studio.engine.links.driver import STALE, LinkThread
from studio.engine.links.gatekeeper import step
from studio.engine.links.link import RobotLink
from studio.engine.links.memory import Memory, Outcome, Seen
from studio.engine.links.status import NO_LINK, LinkStatus, Phase
from studio.engine.links.wanted import Wanted, wanted_of
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.showing import Show

STOPPED = "Stopped."
_LEAST = 1e-6  # [s] between two ticks, for the sake of the limits' arithmetic


class Linked:
    """See the module.

    Parameters
    ----------
    now
        Any clock [s]; None where no robot can be linked.
    """

    def __init__(self, now: Callable[[], float] | None = None) -> None:
        self.status = NO_LINK
        self._now = now
        self._thread: LinkThread | None = None
        self._memory, self._seen = Memory(), Seen()
        self._wanted: Wanted | None = None
        self._ticked = 0.0  # [s] when the last tick was

    def hear(self, command: commands.Command) -> None:
        """Stop the robot with everything else, and where whoever controls is gone."""
        if isinstance(command, commands.Stop | commands.LetGo):
            self._stop(STOPPED if isinstance(command, commands.Stop) else command.why)

    def take(self, command: commands.LinkCommand) -> str:
        """Do what people ask; return it in words, or raise StudioError with why not."""
        match command:
            case commands.ConnectLink(url):
                return self.connect(url)
            case commands.DisconnectLink():
                self._let_go()
                return "The robot is let alone."
            case commands.SetLinkSpeed(ratio):
                self._memory = consent.at_ratio(self._memory, ratio)
                if self._memory.phase not in (Phase.OFF, Phase.ENABLING):
                    self._tell_speed()  # it is told as soon as it is enabled, otherwise
                return f"The robot goes at {100 * ratio:.0f} % of its top speed."
            case commands.EnableLink() | commands.StartLink():
                return self._begin(command)
            case commands.DisableLink():
                return self._disable()
            case _:
                return self._stop(STOPPED)

    def connect(self, url: str) -> str:
        """Link a robot in place of any other; it is connected to meanwhile."""
        if self._now is None:
            raise StudioError("a robot is linked in the live studio only: studio serve")
        link = link_at(url, self._now)
        self._let_go()
        self._thread = LinkThread(link, self._now)
        self.status = LinkStatus(url=link.url)  # at once: nobody may take the clock from now on
        return f"Connecting to {link.url}."

    def tick(self, activity: Activity, choices: Choices) -> str:
        """Do one control period after the activity's; return what people should know of it."""
        thread, now = self._thread, self._now
        if thread is None or now is None:
            return ""
        at = now()
        elapsed = min(max(at - self._ticked, _LEAST), CONTROL_PERIOD)
        before, self._wanted, self._ticked = self._memory, wanted_of(activity, choices), at
        self._seen = Seen.of(thread.heard, at, thread.trouble)
        self._memory, outcome = step(before, self._seen, self._wanted, elapsed)
        thread.put(outcome.targets)
        self.status = self._status(thread.url, outcome)
        if before.phase is not self._memory.phase and self._memory.phase is Phase.WAITING:
            self._tell_speed()
        return self._hold_playing(activity) or _news(before, self._memory)

    def close(self) -> None:
        """Let the robot alone, and wait until its thread has ended; it holds still where it is."""
        if self._thread is not None:
            self._thread.close()
        self._let_go()

    def _begin(self, command: commands.EnableLink | commands.StartLink) -> str:
        thread = self._required()
        if isinstance(command, commands.EnableLink):
            self._memory = consent.enable(self._memory, self._seen)
            thread.enable()
        elif self._wanted is not None:
            self._memory = consent.confirm(
                self._memory, self._seen, self._wanted, thread.limits, command.confirmed
            )
        return self._memory.why

    def _disable(self) -> str:
        thread = self._required()
        self._stop("Disabled.")
        if not thread.is_open:
            raise StudioError("The robot is not connected, so nobody can tell it: use its e-stop")
        thread.order(lambda link: link.disable())
        return "The robot is asked to take the power off its motors."

    def _let_go(self) -> None:
        thread, self._thread = self._thread, None
        self._memory, self._seen, self.status = Memory(), Seen(), NO_LINK
        if thread is not None:
            thread.end()

    def _stop(self, why: str) -> str:
        """Send nothing more, not even what waits."""
        if self._thread is None:
            return ""
        self._thread.halt()
        if self._memory.phase is Phase.OFF:
            return ""
        self._memory = consent.stop(self._memory, f"{why} Enable and confirm anew.")
        return "The robot is stopped, too: enable and confirm it anew to go on."

    def _tell_speed(self) -> None:
        ratio = self._memory.ratio

        def tell(link: RobotLink) -> None:
            link.set_speed(ratio)

        if self._thread is not None:
            self._thread.order(tell)

    def _hold_playing(self, activity: Activity) -> str:
        """Pause what plays where an enabled robot would have to be somewhere else by now."""
        wanted, phase = self._wanted, self._memory.phase
        waits = phase in (Phase.WAITING, Phase.STARTING)
        if wanted is None or not (waits and wanted.permitted and isinstance(activity, Show)):
            return ""
        activity.pause()
        return f"Paused for the robot. {self._memory.why}"

    def _required(self) -> LinkThread:
        if self._thread is None:
            raise StudioError("no robot is linked: connect one first")
        return self._thread

    def _status(self, url: str, outcome: Outcome) -> LinkStatus:
        seen, memory = self._seen, self._memory
        state, heard = seen.state, seen.state is not None and seen.age <= STALE
        words = memory.why if heard else seen.trouble or "Nothing is heard of the robot yet."
        if outcome.targets is not None:
            words = memory.why or _going(outcome)
        fault = state.fault if state else ""
        return LinkStatus(
            url=url,
            is_connected=heard,
            words=f"{words} {fault}".strip(),
            phase=memory.phase,
            ratio=memory.ratio,
            is_enabled=state is not None and state.enabled,
            stop=state.stop if state else "",
            resets=state.resets if state else False,
            is_moving=outcome.targets is not None,
            lag=outcome.lag,
            guarded=outcome.guarded,
            measured=state.positions if state else None,
        )


def _going(outcome: Outcome) -> str:
    behind = f"The robot follows, {np.degrees(outcome.lag):.0f}° behind what is shown."
    return f"{behind} {outcome.guarded}".strip()


def _news(before: Memory, now: Memory) -> str:
    """Return what people have to be told: that it went on, or that it was ended."""
    return "" if now.phase is before.phase else f"Robot: {now.why or 'at the start pose.'}"
