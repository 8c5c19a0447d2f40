"""What a session shows of comparing: the timeline, both robots, the block, the table, the field."""

from dataclasses import dataclass

from studio.engine.export.material import Take
from studio.engine.field_picture import FieldPicture
from studio.engine.measured import Measured
from studio.engine.performance import Performance
from studio.engine.teaching import Lesson
from studio.engine.world import WorldState


@dataclass(frozen=True)
class TimelineStatus:
    """What is on the timeline, and how it moves; where it is stands in the snapshot."""

    title: str = ""  # what is on it; empty for nothing
    motion: float = 0.0  # [s] of it, before everything settles
    is_playing: bool = False
    speed: float = 1.0
    loops: bool = False


@dataclass(frozen=True, eq=False)
class Alone:
    """A robot that does alone what it learned."""

    lesson: Lesson
    performance: Performance | None  # as far as it is simulated; None on its way to the beginning


@dataclass(frozen=True, eq=False)
class CompareStatus:
    """See the module."""

    timeline: TimelineStatus = TimelineStatus()
    playing: tuple[Alone, ...] = ()  # what is on the timeline, of one robot or two
    replayed: Take | None = None  # the demonstration on the timeline, as it was put there
    beside: WorldState | None = None  # the second robot's
    kept: Lesson | None = None  # what is kept as B
    moved: bool = False  # the task's block is not where it was taught
    table: tuple[Measured, ...] = ()  # the chosen demonstration, A, and B where they are known
    field: FieldPicture | None = None


def named(lesson: Lesson) -> str:
    """Return what a lesson is called: ``rbf, 50 neurons``."""
    count = lesson.settings.neurons
    return f"{lesson.settings.name}, {count} neuron{'s' if count != 1 else ''}"
