"""A robot that is a world of its own, on its link's thread: to try everything without a robot.

It obeys as Baxter does: whoever enables it powers its motors, a stop holds it, and where no
command has come for 0.2 s it holds still where it is. It is the world that implements `RobotLink`:
a second one, for the one on the page is the session's, which sends it nothing through a link.
"""

from collections.abc import Callable, Mapping

from studio.engine.links.driver import STALE
from studio.engine.links.link import LinkError, Range, RobotState
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES, load_robot
from studio.engine.scene import Scene
from studio.engine.world import World

_CATCH_UP = 15  # ticks; after a longer pause of its thread time is skipped


class SimulatedRobot:
    """The link; its world is made by `open`, for it belongs to the thread that makes it.

    Parameters
    ----------
    url
        As people typed it.
    now
        Any clock [s]: the world passes as fast as it.
    """

    def __init__(self, url: str, now: Callable[[], float]) -> None:
        self.url, self._now = url, now
        self._world: World | None = None
        self._enabled, self._holds = False, True
        self._due = self._commanded = 0.0  # [s]

    @property
    def limits(self) -> Mapping[str, Range]:
        """Those of our own description."""
        robot = load_robot()
        ranges = zip(robot.limits.lower.tolist(), robot.limits.upper.tolist(), strict=True)
        return dict(zip(robot.joint_names, ranges, strict=True))

    def open(self) -> None:
        """Set up a robot whose arms are stretched out."""
        self.close()
        self._world = World(Scene())
        self._enabled, self._due = False, self._now()

    def read(self) -> RobotState | None:
        """Let the world's time pass as far as the clock has; return what came of it."""
        world, now = self._required(), self._now()
        if now < self._due:
            return None
        if now - self._due > _CATCH_UP * CONTROL_PERIOD:
            self._due = now
        while self._due <= now:
            self._due += CONTROL_PERIOD
            self._hold_if_left(now)
            world.step()
        return RobotState(world.state.joint_positions, self._enabled, stamp=now)

    def send(self, targets: Mapping[str, float]) -> None:
        """Let it go there, if it is enabled."""
        if self._enabled:
            self._required().apply(targets)
            self._commanded, self._holds = self._now(), False

    def enable(self) -> None:
        """Power its motors."""
        self._enabled = True

    def disable(self) -> None:
        """Let it hold still: a simulated arm without power would fall."""
        self._hold()
        self._enabled = False

    def stop(self) -> None:
        """Hold still where it is."""
        self._hold()

    def set_speed(self, ratio: float) -> None:
        """Nothing to tell: the gatekeeper's own cap is the speed."""

    def close(self) -> None:
        """Free its world."""
        world, self._world = self._world, None
        if world is not None:
            world.close()

    def _required(self) -> World:
        if self._world is None:
            raise LinkError(f"{self.url}: it is not open")
        return self._world

    def _hold_if_left(self, now: float) -> None:
        if not self._holds and now - self._commanded > STALE:
            self._hold()

    def _hold(self) -> None:
        """Stay where it is, inside the limits."""
        self._holds = True
        world, limits = self._required(), load_robot().limits
        here = world.state.joint_positions.clip(limits.lower, limits.upper)
        world.apply(dict(zip(JOINT_NAMES, here.tolist(), strict=True)))
