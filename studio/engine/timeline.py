"""One playhead for everything that can be played: skeleton, robot, ghost, trails and plots.

The playhead is worked out anew at every look, from where it was and when it was last touched:
looking adds nothing up, so nothing drifts, and who looks more often sees the same. No clock is read
here: ``now`` [s] is any clock that does not run back, always the same one.
"""

import math
from dataclasses import dataclass, replace

from studio.engine.errors import StudioError
from studio.engine.robot import CONTROL_PERIOD

SLOWEST, FASTEST = 0.25, 2.0  # times real time
_ROUNDING = 1e-6  # of a tick: a playhead this near to one stands on it


@dataclass(frozen=True)
class Timeline:
    """A playhead and how it moves; every change returns another one. Begin with `Timeline(d)`.

    Raises
    ------
    StudioError
        By all methods: where a time is not finite, the duration below 0, or the speed outside
        `SLOWEST` to `FASTEST`.
    """

    duration: float = 0.0  # [s]
    speed: float = 1.0
    loops: bool = False
    touched: float = 0.0  # [s] where the playhead was when it was last touched
    running_since: float | None = None  # [s] when that was, by the clock; None: paused

    def __post_init__(self) -> None:
        if not (math.isfinite(self.duration) and self.duration >= 0.0):
            raise StudioError(f"a timeline lasts 0 s or more, not {self.duration}")
        if not SLOWEST <= self.speed <= FASTEST:
            raise StudioError(f"speed: {SLOWEST:g} to {FASTEST:g}, not {self.speed}")
        if not 0.0 <= self.touched <= self.duration:
            raise StudioError(f"the playhead is in 0 to {self.duration} s, not at {self.touched}")
        _finite(0.0 if self.running_since is None else self.running_since)

    def playhead(self, now: float) -> float:
        """Return where it is [s], from 0 to the duration, ends included."""
        run = self._run(now)
        if run <= self.duration:
            return run
        return math.fmod(run, self.duration) if self._loops else self.duration

    def is_playing(self, now: float) -> bool:
        """Tell whether it moves: without a loop it pauses by itself at the end."""
        return self.running_since is not None and (self._loops or self._run(now) < self.duration)

    def play(self, now: float) -> "Timeline":
        """Let it run; from the end, where it does not loop, from the beginning."""
        at = self.playhead(now)
        from_start = at >= self.duration and not self._loops
        return self._at(0.0 if from_start else at, now, is_running=self.duration > 0.0)

    def pause(self, now: float) -> "Timeline":
        """Let it stand where it is."""
        return self._at(self.playhead(now), now, is_running=False)

    def toggle(self, now: float) -> "Timeline":
        """Play or pause: what one button and the space bar do."""
        return self.pause(now) if self.is_playing(now) else self.play(now)

    def scrub(self, position: float, now: float) -> "Timeline":
        """Put it somewhere, or to the nearer end; it plays on from there if it was playing."""
        at = min(max(_finite(position), 0.0), self.duration)
        return self._at(at, now, is_running=self.is_playing(now))

    def step(self, ticks: int, now: float) -> "Timeline":
        """Pause, and go some ticks on, or back where negative: to a whole tick, or to an end."""
        at = self.playhead(now) / CONTROL_PERIOD
        whole = math.floor(at + _ROUNDING) if ticks > 0 else math.ceil(at - _ROUNDING)
        return self.pause(now).scrub((whole + ticks) * CONTROL_PERIOD, now)

    def at_speed(self, speed: float, now: float) -> "Timeline":
        """Go on from where it is at another speed."""
        return replace(self._kept(now), speed=speed)

    def looping(self, loops: bool, now: float) -> "Timeline":
        """Go on from where it is, with a loop or without."""
        return replace(self._kept(now), loops=loops)

    def lasting(self, duration: float) -> "Timeline":
        """Return a paused timeline at the beginning of something else; speed and loop stay."""
        return Timeline(duration, self.speed, self.loops)

    @property
    def _loops(self) -> bool:
        return self.loops and self.duration > 0.0

    def _run(self, now: float) -> float:
        """Return where it would be [s] if there were no end."""
        if self.running_since is None:
            return self.touched
        elapsed = max(_finite(now) - self.running_since, 0.0)
        return self.touched + self.speed * elapsed

    def _kept(self, now: float) -> "Timeline":
        return self._at(self.playhead(now), now, self.is_playing(now))

    def _at(self, position: float, now: float, is_running: bool) -> "Timeline":
        since = _finite(now) if is_running else None
        return replace(self, touched=position, running_since=since)


def _finite(time: float) -> float:
    if not math.isfinite(time):
        raise StudioError(f"a time is finite, not {time}")
    return time
