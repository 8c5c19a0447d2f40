"""Who teaches: the demonstrator, the person in a file, or a live stream; one of them is chosen."""

from dataclasses import replace

from studio.engine.errors import StudioError
from studio.engine.live.source import LiveSource
from studio.engine.live.status import LiveStatus, in_short
from studio.engine.snapshot import SourceStatus
from studio.engine.sources import SkeletonRecording
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.teachers import FileTeacher, LiveTeacher, Teacher


class WhoTeaches:
    """See the module. What chooses returns in words what was chosen.

    Parameters
    ----------
    seed
        The demonstrator's.
    live
        Where live streams come in, if any are taken.
    """

    def __init__(self, seed: int, live: LiveSource | None) -> None:
        self.chosen: Teacher | None = None
        self._seed, self._take = seed, 0
        self._live = None if live is None else LiveTeacher(live)

    def use_demonstrator(self) -> str:
        """Choose the demonstrator's next take."""
        self._take += 1
        return self.use_stream(demonstrate(self._seed, self._take))

    def use_stream(self, stream: SkeletonRecording, name: str = "") -> str:
        """Choose the person in a file, which people know as ``name``, if that is not its path."""
        stream = replace(stream, path=name) if name else stream
        self.chosen = FileTeacher(stream)
        hands = "" if stream.has_hand_states else ": it tells no hand states, so open the gate"
        return f"Source: {stream.path}, {stream.frames} frames{hands}"

    def use_live(self) -> str:
        """Choose whoever sends a live stream; raise StudioError where none is taken."""
        if self._live is None:
            raise StudioError("No live streams are taken here: start the studio with its listener")
        self.chosen = self._live
        return f"Source: the live stream. {in_short(self._live.live(is_followed=True))}"

    def required(self) -> Teacher:
        """Return who is chosen; raise StudioError where nobody is."""
        if self.chosen is None:
            raise StudioError(
                "Choose a source first: a sample, a file of your own, a live stream, the "
                "demonstrator"
            )
        return self.chosen

    def status(self) -> SourceStatus | None:
        """Return what people should know of who is chosen."""
        return None if self.chosen is None else self.chosen.status()

    def live(self, watched: Teacher | None) -> LiveStatus | None:
        """Return how the live streams stand, while an activity watches ``watched``."""
        if self._live is None:
            return None
        return self._live.live(is_followed=watched is self._live)
