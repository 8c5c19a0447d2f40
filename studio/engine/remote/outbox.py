"""What is on its way to one program: answers in their order, of each stream the newest frame.

A program that reads slowly loses frames, which are counted, and holds up nobody. Answers are not
lost: who lets too many of them lie, or too much, is sent away.
"""

from collections import Counter, deque
from collections.abc import Callable

import msgspec

from studio.engine.remote.views import Frame
from studio.remote.asked import Stream
from studio.remote.told import Told

MOST_ANSWERS = 256
MOST_BYTES = 16 * 2**20  # of answers, but for the one that goes next: one may be of any size


class Outbox:
    """See the module; one thread uses it.

    Answers lie here as they are sent: so they are weighed exactly, and take no more room than that.

    Parameters
    ----------
    wake
        Is called whenever there is something to send.
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._answers: deque[bytes] = deque()
        self._size = 0  # [bytes] of all answers
        self._frames: dict[Stream, Frame] = {}
        self._missed: Counter[Stream] = Counter()

    @property
    def is_full(self) -> bool:
        """Whether more answers lie here than anybody lets lie, or larger ones."""
        behind = self._size - len(self._answers[0]) if self._answers else 0
        return len(self._answers) > MOST_ANSWERS or behind > MOST_BYTES

    def answer(self, told: Told) -> None:
        """Send this after all other answers; raise ValueError where it has no form in JSON."""
        text = msgspec.json.encode(told)
        self._answers.append(text)
        self._size += len(text)
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

    def clear(self) -> None:
        """Drop all: nobody reads any more."""
        self._answers.clear()
        self._frames.clear()
        self._size = 0

    def next(self) -> str | None:
        """Return the text that is to be sent next, if any."""
        if self._answers:
            text = self._answers.popleft()
            self._size -= len(text)
            return text.decode()
        if not self._frames:
            return None
        stream = next(iter(self._frames))
        frame = self._frames.pop(stream)
        told = msgspec.structs.replace(frame, missed=self._missed[stream])
        return msgspec.json.encode(told).decode()
