"""A performance while it is being simulated, in a world of its own."""

from collections.abc import Iterator

from studio.engine.arms import Arms
from studio.engine.hands import PLAIN, HandTrack
from studio.engine.performance import Performance, Tick, Trajectory, perform_steps, start_world
from studio.engine.retarget import Mapping
from studio.engine.teaching import Lesson
from studio.engine.world import Scene


class Perform:
    """Let the robot perform a trajectory alone, tick by tick: what comes of it is a `Performance`.

    Raises
    ------
    StudioError
        By `step`, where the robot cannot come to where the motion begins.
    """

    def __init__(
        self,
        trajectory: Trajectory,
        duration: float,
        arms: Arms,
        mapping: Mapping,
        hands: HandTrack | None = None,
        scene: Scene | None = None,
    ) -> None:
        options = PLAIN if hands is None else hands.options
        self.world = start_world(arms, mapping, options, scene)
        self.is_over = False
        self._arms, self._mapping, self._motion = arms, mapping, duration
        self._ready = self.world.state.joint_positions
        self._ticks: list[Tick] = []
        self._steps: Iterator[Tick] = perform_steps(
            self.world, trajectory, duration, arms, mapping, hands
        )

    @classmethod
    def of(cls, lesson: Lesson, scene: Scene) -> "Perform":
        """Return the performance of what was learned."""
        taught = lesson.taught
        return cls(
            lesson.trajectory(), taught.duration, taught.arms, taught.mapping, lesson.hands, scene
        )

    def step(self) -> bool:
        """Do one tick; return whether there was one left."""
        tick = next(self._steps, None)
        if tick is None:
            self.is_over = True
            return False
        self._ticks.append(tick)
        return True

    @property
    def guarded(self) -> str:
        """What the guard keeps apart at the newest tick."""
        return self._ticks[-1].command.guarded if self._ticks else ""

    @property
    def performance(self) -> Performance | None:
        """What there is of it; None while the robot is on its way to where the motion begins."""
        if not self._ticks or self._ticks[-1].time < 0.0:
            return None
        return Performance.of(self._arms, self._mapping, self._motion, self._ready, self._ticks)
