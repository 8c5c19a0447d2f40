"""What the signing hand has shown over the last seconds, as the gate takes it."""

from collections import deque
from dataclasses import dataclass, replace

from studio.engine.gate import GateStatus
from studio.engine.skeleton import HandState

SPAN = 10.0  # [s] that are kept


@dataclass(frozen=True)
class HandRun:
    """A stretch of time in which the hand showed one thing, and the gate was armed or not."""

    state: HandState
    armed: bool
    start: float  # [s] of the activity's time
    end: float  # [s]


class HandStrip:
    """Takes note of every tick; see the module."""

    def __init__(self) -> None:
        self._runs: deque[HandRun] = deque()

    def note(self, gate: GateStatus, time: float, span: float) -> None:
        """Take note of the tick that begins at ``time`` [s] and takes ``span`` [s].

        A time that is not after the last one is that of another activity: all else is forgotten.
        """
        end = time + span
        if self._runs and time < self._runs[-1].end - span / 2:
            self._runs.clear()
        last = self._runs[-1] if self._runs else None
        if last is not None and (last.state, last.armed) == (gate.state, gate.armed):
            self._runs[-1] = replace(last, end=end)
        else:
            self._runs.append(HandRun(gate.state, gate.armed, time, end))
        while self._runs[0].end <= end - SPAN:
            self._runs.popleft()

    @property
    def runs(self) -> tuple[HandRun, ...]:
        """All stretches of the last seconds, the oldest one cut to them."""
        if not self._runs:
            return ()
        first, *others = self._runs
        begin = max(first.start, self._runs[-1].end - SPAN)
        return (replace(first, start=begin), *others)
