"""What people put on the timeline, and how they move its playhead; see `engine.timeline`."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PlayReproduction:
    """Let the robot do alone what it learned."""


@dataclass(frozen=True)
class PlayDemonstration:
    """Show a demonstration again as it was recorded."""

    number: int | None = None  # its card's; None: the chosen one


@dataclass(frozen=True)
class TogglePlay:
    """Play or pause; with nothing on the timeline, play what was learned, or the chosen one."""


@dataclass(frozen=True)
class Scrub:
    """Put the playhead somewhere."""

    position: float  # [s]


@dataclass(frozen=True)
class StepBy:
    """Pause, and go some control ticks on, or back where negative."""

    ticks: int


@dataclass(frozen=True)
class SetSpeed:
    """Play faster or slower from now on."""

    speed: float  # times real time


@dataclass(frozen=True)
class SetLoop:
    """Begin anew at the end, or stop there."""

    loops: bool


TimelineCommand = (
    PlayReproduction | PlayDemonstration | TogglePlay | Scrub | StepBy | SetSpeed | SetLoop
)
