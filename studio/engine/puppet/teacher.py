"""The puppet as a source: whoever drags it is followed like anybody before a sensor."""

from collections.abc import Iterator
from itertools import count

from studio.engine.pipeline import Outcome
from studio.engine.puppet.puppet import Puppet, PuppetMemory
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.skeleton import FloatArray, HandState, Joint, Side, Skeleton
from studio.engine.snapshot import SourceStatus


class PuppetTeacher:
    """A puppet without end, until Stop; a `studio.engine.teachers.Teacher`.

    The session's thread alone may use it. Each control tick is either one of `frames`, while
    somebody follows, or a call of `idle`, so that the puppet obeys at all times.
    """

    path, format, seconds, fresh = "puppet", "dragged by hand", 0.0, None

    def __init__(self, puppet: Puppet | None = None) -> None:
        self._puppet = Puppet() if puppet is None else puppet
        self._memory = self._puppet.start()
        self.skeleton = self._puppet.skeleton(self._memory, 0.0)

    def status(self) -> SourceStatus:
        """Return what people should know of it; the same at all times, for it is one person."""
        return SourceStatus(self.path, 0, self.seconds, has_hand_states=True)

    def frames(self) -> Iterator[Skeleton | None]:
        """Yield what each tick sees."""
        for tick in count():
            yield self._passed(tick * CONTROL_PERIOD)

    def command_given(self, outcome: Outcome) -> None:
        """Nothing to measure: it is made when its tick comes."""

    def latency(self) -> None:
        """Nothing was measured."""

    def idle(self) -> None:
        """Let a tick pass in which nobody follows."""
        self._passed(self.skeleton.time + CONTROL_PERIOD)

    def drag_hand(self, side: Side, point: FloatArray) -> None:
        """Drag a hand to a point (3,) [m] of camera space; as the others, see `Puppet`."""
        self._memory = self._puppet.drag_hand(self._memory, side, point)

    def drag_elbow(self, side: Side, point: FloatArray) -> None:
        """Drag an elbow to a point (3,) [m] of camera space."""
        self._memory = self._puppet.drag_elbow(self._memory, side, point)

    def release_elbow(self, side: Side) -> None:
        """Let an elbow hang easily again."""
        self._memory = self._puppet.release_elbow(self._memory, side)

    def go_home(self) -> None:
        """Let both arms go back to where they started."""
        self._memory = self._puppet.go_home(self._memory)

    def sign(self, side: Side, state: HandState) -> None:
        """Let a hand show Lasso, Open, Closed, or with Unknown nothing."""
        self._memory = self._puppet.sign(self._memory, side, state)

    @property
    def memory(self) -> PuppetMemory:
        """The puppet at this moment; immutable, so that a snapshot may hold it."""
        return self._memory

    @property
    def goals(self) -> dict[Joint, FloatArray]:
        """Where hands and elbows (3,) [m] are going, in camera space."""
        return self._puppet.goals(self._memory)

    def _passed(self, time: float) -> Skeleton:
        self._memory = self._puppet.tick(self._memory)
        self.skeleton = self._puppet.skeleton(self._memory, time)
        return self.skeleton
