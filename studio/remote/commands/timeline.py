"""Commands as messages. Written by docs/make_remote_schema.py: change it there."""

from studio.remote.message import Message


class PlayDemonstration(Message, frozen=True):
    """Show a demonstration again as it was recorded."""

    number: int | None = None  # its card's; None: the chosen one


class PlayReproduction(Message, frozen=True):
    """Let the robot do alone what it learned."""


class Scrub(Message, frozen=True):
    """Put the playhead somewhere."""

    position: float  # [s]


class SetLoop(Message, frozen=True):
    """Begin anew at the end, or stop there."""

    loops: bool


class SetSpeed(Message, frozen=True):
    """Play faster or slower from now on."""

    speed: float  # times real time


class StepBy(Message, frozen=True):
    """Pause, and go some control ticks on, or back where negative."""

    ticks: int


class TogglePlay(Message, frozen=True):
    """Play or pause; with nothing on the timeline, play what was learned, or the chosen one."""
