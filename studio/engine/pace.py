"""How well a live loop keeps up with the clock, for pages to tell."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Pace:
    """See the module."""

    share: float = 1.0  # of the ticks that were due in the last seconds, those that were made
    skipped: int = 0  # ticks given up since it began, as the machine was badly late
