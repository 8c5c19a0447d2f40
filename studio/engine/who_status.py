"""What a snapshot tells of who teaches, beside the source itself."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from studio.engine.hand_strip import HandRun
from studio.engine.reading import ReadingStatus
from studio.engine.skeleton import FloatArray, HandState, Joint, Side


@dataclass(frozen=True, eq=False)
class PuppetStatus:
    """The puppet, while it is the source."""

    goals: Mapping[Joint, FloatArray]  # where hands and elbows (3,) [m] are going, in camera space
    left_sign: HandState
    right_sign: HandState

    def sign(self, side: Side) -> HandState:
        """Return what the hand of that side shows."""
        return self.left_sign if side == "left" else self.right_sign


@dataclass(frozen=True, eq=False)
class WhoStatus:
    """See the module."""

    reading: ReadingStatus | None = None  # the file that is being read
    puppet: PuppetStatus | None = None  # None unless it is the source
    strip: tuple[HandRun, ...] = ()  # what the hand has shown; nothing while nobody is watched
    # Who is there, and in how many frames of the chosen file; None: a live stream has no end.
    bodies: tuple[tuple[str, int | None], ...] = ()
    body: str | None = None  # the one that was chosen, live the one followed; None: the nearest
    files: frozenset[Path] = frozenset()  # that are the source, are being read, or wait for it
