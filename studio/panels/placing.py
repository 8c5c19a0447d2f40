"""Where the person stands in the scene: put there once, and kept for as long as it is the same."""

from studio.engine.placement import Placement
from studio.engine.snapshot import Snapshot


class Placing:
    """Remembers whom it has placed. Whoever draws at the person has one, and asks at every draw."""

    def __init__(self) -> None:
        self._person: object = None
        self._placement: Placement | None = None

    def of(self, now: Snapshot) -> Placement | None:
        """Return where camera space lies; None where nobody is there."""
        if now.skeleton is None:
            return None
        # A stream's count of frames rises; its bodies' ids tell one person from the next.
        source = now.source and (now.source.name, 0 if now.source.is_live else now.source.frames)
        person = (source, now.skeleton.body_id)
        if self._placement is None or person != self._person:
            self._person, self._placement = person, Placement.of(now.skeleton)
        return self._placement
