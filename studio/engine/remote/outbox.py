"""What is on its way to one program: answers in their order, of each stream the newest frame.

A program that reads slowly loses frames, which are counted, and holds up nobody. Answers are not
lost: who lets too many of them lie is sent away.
"""

from collections import Counter, deque
from collections.abc import Callable

import msgspec

from studio.engine.remote.views import Frame
from studio.remote.asked import Stream
from studio.remote.told import Told

MOST_ANSWERS = 256


class Outbox:
    """See the module; one thread uses it.

    Parameters
    ----------
    wake
        Is called whenever there is something to send.
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._answers: deque[Told] = deque()
        self._frames: dict[Stream, Frame] = {}
        self._missed: Counter[Stream] = Counter()

    @property
    def is_full(self) -> bool:
        """Whether more answers lie here than anybody lets lie."""
        return len(self._answers) > MOST_ANSWERS

    def answer(self, told: Told) -> None:
        """Send this after all other answers."""
        self._answers.append(told)
        self._wake()

    def offer(self, stream: Stream, frame: Frame) -> None:
        """Send this unless a newer frame of the stream comes before its turn."""
        if stream in self._frames:
            self._missed[stream] += 1
        self._frames[stream] = frame
        self._wake()

    def forget(self, stream: Stream) -> None:
        """Send no more of a stream; what comes of it later is counted anew."""
        self._frames.pop(stream, None)
        self._missed.pop(stream, None)

    def next(self) -> Told | None:
        """Return what is to be sent next, if anything."""
        if self._answers:
            return self._answers.popleft()
        if not self._frames:
            return None
        stream = next(iter(self._frames))
        frame = self._frames.pop(stream)
        return msgspec.structs.replace(frame, missed=self._missed[stream])
