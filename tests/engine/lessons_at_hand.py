"""Lessons to play: learned from two of the samples that ship, and what Baxter makes of them."""

from dataclasses import replace
from functools import cache

import numpy as np

from studio.engine.demonstration import DemonstrationSet
from studio.engine.hands import HandOptions, HandTrack
from studio.engine.performance import Performance
from studio.engine.teaching import LearnerName, LearnerSettings, Lesson, learn, reproduce
from tests.engine.cards_at_hand import takes


@cache
def lesson(neurons: int = 30, name: LearnerName = "rbf") -> Lesson:
    """Return a network taught by two demonstrations."""
    taught = DemonstrationSet.of([each.demonstration for each in takes(2)])
    return learn(taught, LearnerSettings(name, neurons))


@cache
def alone(neurons: int = 30) -> Performance:
    """Return what Baxter makes of it, simulated in one go."""
    return reproduce(lesson(neurons)).performance


def held_off(performance: Performance, ticks: int) -> Performance:
    """Return it as if the collision guard had changed its first ticks."""
    changed = tuple(
        replace(tick, command=replace(tick.command, guarded="hand near desk: 2 cm"))
        for tick in performance.ticks[:ticks]
    )
    return replace(performance, ticks=changed + performance.ticks[ticks:])


def with_wrists(taught: DemonstrationSet) -> DemonstrationSet:
    """Return demonstrations in which the hand turned as well, in each of them a little further."""
    turned = np.linspace((0.0, 0.5, 0.0), (0.3, -0.5, 0.2), 50)
    shown = tuple(
        replace(
            each,
            hands=HandTrack(
                HandOptions(wrist="level"),
                np.linspace(0.0, each.duration, len(turned)),
                (1.0 + 0.1 * number) * turned,
                np.zeros(len(turned), dtype=bool),
            ),
        )
        for number, each in enumerate(taught.demonstrations)
    )
    return replace(taught, demonstrations=shown)
