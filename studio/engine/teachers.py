"""Who is followed: the person in a file, or whoever a live stream shows; alike to the session."""

import threading
from collections.abc import Iterator
from typing import Protocol

from studio.engine.follow import live_frames, newest_frames
from studio.engine.live.latency import LatencyChain
from studio.engine.live.source import LiveSource
from studio.engine.live.status import LiveStatus
from studio.engine.pipeline import Outcome
from studio.engine.skeleton import Skeleton
from studio.engine.snapshot import SourceStatus
from studio.engine.sources import SkeletonRecording


class Teacher(Protocol):
    """What the session and its activities need of a source of skeletons."""

    @property
    def path(self) -> str:
        """As people know it."""
        ...

    @property
    def format(self) -> str:
        """Short, such as "table 101"."""
        ...

    @property
    def seconds(self) -> float:
        """How long it goes on [s], 0 for no end."""
        ...

    @property
    def fresh(self) -> threading.Event | None:
        """What is set while the newest frame waits for its tick; None in a file."""
        ...

    def status(self) -> SourceStatus:
        """Return what people should know of it."""
        ...

    @property
    def skeleton(self) -> Skeleton | None:
        """Whom to show while nobody is followed."""
        ...

    def frames(self) -> Iterator[Skeleton | None]:
        """Yield what each tick sees: the newest skeleton, or None where none is new."""
        ...

    def command_given(self, outcome: Outcome) -> None:
        """Hear what a tick decided, as soon as the robot has its command."""
        ...

    def latency(self) -> LatencyChain | None:
        """Return how long frames were on their way of late; None where they do not come live."""
        ...


class FileTeacher:
    """The person in a file, from its beginning to its end."""

    fresh = None

    def __init__(self, stream: SkeletonRecording) -> None:
        self._stream = stream
        self.path, self.format, self.seconds = stream.path, stream.format, stream.seconds
        self.skeleton = stream[0] if stream else None

    def status(self) -> SourceStatus:
        """Return what people should know of it."""
        return SourceStatus.of(self._stream)

    def frames(self) -> Iterator[Skeleton | None]:
        """Yield what each tick sees."""
        return newest_frames(self._stream)

    def command_given(self, outcome: Outcome) -> None:
        """Nothing to measure: a file does not wait for anybody."""

    def latency(self) -> None:
        """Nothing was measured."""


class LiveTeacher:
    """Whoever drives a live stream, until Stop."""

    path, seconds = "live stream", 0.0

    def __init__(self, live: LiveSource) -> None:
        self._live, self.fresh = live, live.fresh
        self.skeleton: Skeleton | None = None  # whom `live` has seen

    @property
    def format(self) -> str:
        """The protocol of who drives at present."""
        return self._live.status().protocol or "nobody sends yet"

    def status(self) -> SourceStatus:
        """Return what people should know of it."""
        now = self._live.status()
        return SourceStatus(
            self.path, now.counts.received, self.seconds, now.tells_hands, is_live=True
        )

    def live(self, is_followed: bool) -> LiveStatus:
        """Return how the streams stand.

        Unless the newest frames are an activity's to take, take them, to see who is there.
        """
        taken = None if is_followed else self._live.take()
        now = self._live.status()
        if taken is not None:
            self.skeleton = taken.skeleton
        elif not now.is_flowing:
            self.skeleton = None
        return now

    def bodies(self) -> tuple[tuple[tuple[str, None], ...], str | None]:
        """Return who is in sight, as in `WhoStatus.bodies`, and who of them is followed."""
        now = self._live.status()
        return tuple((body, None) for body in now.bodies), now.followed

    def follow(self, body: str | None) -> None:
        """Follow one of those in sight; raise StudioError where it is not there."""
        self._live.follow(body)

    def frames(self) -> Iterator[Skeleton | None]:
        """Yield what each tick sees."""
        return live_frames(self._live)

    def command_given(self, outcome: Outcome) -> None:
        """Let the stream measure its latency."""
        self._live.command_given(None if outcome.wanted is None else outcome.lag.seconds)

    def latency(self) -> LatencyChain:
        """Return how long frames were on their way, over the last ten seconds."""
        return self._live.status().latency
