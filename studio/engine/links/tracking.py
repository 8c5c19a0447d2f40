"""Whether a robot comes along; to one that does not, nothing more is sent.

A robot that follows with any delay stays within what it has been sent so far. So a joint that
leaves that range by more than a compliant arm sags goes wrong: its sign, its name, or a person
who pulls. And it may be behind by what it goes in half a second at the speed it is allowed, and
a little more.
"""

from dataclasses import dataclass

import numpy as np

from studio.engine.skeleton import FloatArray

ASIDE = 0.15  # [rad] beyond all that was sent
BEHIND, BEHIND_FOR = 0.2, 0.5  # [rad], and [s] at the speed it is allowed


@dataclass(frozen=True, eq=False)
class Tracking:
    """The range (D,) [rad] of what was sent since commands began."""

    low: FloatArray
    high: FloatArray

    @classmethod
    def begin(cls, sent: FloatArray) -> "Tracking":
        """Return the range of a robot that is to move from ``sent`` (D,) [rad]."""
        return cls(sent, sent)

    def step(
        self, joints: tuple[str, ...], sent: FloatArray, measured: FloatArray, top: FloatArray
    ) -> tuple["Tracking", str]:
        """Return the range with ``sent`` in it, and which joint goes astray, in words, if any.

        ``top`` (D,) [rad/s] is how fast each joint is allowed to be.
        """
        known = Tracking(np.minimum(self.low, sent), np.maximum(self.high, sent))
        aside = np.maximum(known.low - measured, measured - known.high)
        behind = np.abs(sent - measured)
        if aside.max() > ASIDE:
            worst = int(np.argmax(aside))
            degrees = np.degrees(measured[worst] - sent[worst])
            words = f"{joints[worst]} went elsewhere than it was sent, by {degrees:+.0f}°."
            return known, f"{words} Check its sign, and that nobody pulls."
        if (behind > BEHIND + BEHIND_FOR * top).any():
            worst = int(np.argmax(behind))
            degrees = np.degrees(behind[worst])
            return known, f"{joints[worst]} does not come along: it is {degrees:.0f}° behind."
        return known, ""
