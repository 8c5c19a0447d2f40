"""What has been found out about the demonstrations that are there: how networks do on them.

Errors are drawn by themselves. Whether the block falls is told to nobody who has not guessed.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

from studio.engine.curves import BlockPoint, ErrorPoint, counts_of
from studio.engine.teaching import LearnerName, LearnerSettings
from studio.rbf import Suggestion, suggest_from

FEWEST_GUESSES = 3  # before all may be revealed


@dataclass(frozen=True, eq=False)
class Curve:
    """Errors against numbers of neurons, as far as they are known."""

    learner: LearnerName
    points: tuple[ErrorPoint, ...] = ()  # by rising numbers
    note: str = ""  # why it does not go on, if it does not

    @property
    def missing(self) -> tuple[int, ...]:
        """The numbers of neurons whose errors are not known yet."""
        known = {point.neurons for point in self.points}
        return tuple(count for count in counts_of(self.learner) if count not in known)

    @property
    def floor(self) -> float | None:
        """What no network undercuts [rad²], mean over joints; None where there is no floor."""
        for point in self.points:
            if point.floor_ratio is not None:
                return point.mse / point.floor_ratio
        return None

    @cached_property
    def suggestion(self) -> Suggestion | None:
        """How many neurons are enough; None while that is not known, or cannot be."""
        if self.missing or not self.points:
            return None
        held_out = [point.held_out for point in self.points if point.held_out is not None]
        ratios = [point.floor_ratio for point in self.points if point.floor_ratio is not None]
        whole = len(self.points)
        if len(held_out) < whole or not all(map(math.isfinite, held_out + ratios)):
            return None
        counts = [point.neurons for point in self.points]
        return suggest_from(counts, ratios if len(ratios) == whole else None, held_out)

    def at(self, neurons: int) -> ErrorPoint | None:
        """Return the errors of one number of neurons, if they are known."""
        return next((point for point in self.points if point.neurons == neurons), None)


@dataclass(frozen=True)
class Tried:
    """Whether the task gets done with one network, and what somebody had said."""

    learner: LearnerName
    point: BlockPoint
    guess: bool | None  # that it does; None where it was revealed

    @property
    def right(self) -> bool:
        """Whether somebody guessed, and guessed right."""
        return self.guess == self.point.done


@dataclass(eq=False)
class Findings:
    """See the module."""

    tried: tuple[Tried, ...] = ()
    _curves: dict[LearnerName, Curve] = field(default_factory=dict)

    def curve(self, learner: LearnerName) -> Curve:
        """Return a learner's curve, the same one until it changes."""
        return self._curves.setdefault(learner, Curve(learner))

    def add_errors(self, learner: LearnerName, points: Iterable[ErrorPoint]) -> None:
        """Take in points of a curve, some of which may be known."""
        before = self.curve(learner)
        known = {point.neurons: point for point in (*before.points, *points)}
        if len(known) > len(before.points):
            in_order = tuple(known[count] for count in sorted(known))
            self._curves[learner] = replace(before, points=in_order)

    def give_up(self, learner: LearnerName, note: str) -> None:
        """Let a curve be as it is, for a reason in words; without one it goes on."""
        self._curves[learner] = replace(self.curve(learner), note=note)

    def outcome(self, settings: LearnerSettings) -> Tried | None:
        """Return what is known of a network."""
        wanted = (settings.name, settings.neurons)
        return next((t for t in self.tried if (t.learner, t.point.neurons) == wanted), None)

    def add_outcomes(
        self, learner: LearnerName, points: Iterable[BlockPoint], guess: bool | None = None
    ) -> None:
        """Take in whether the block fell; what is known stays, with its guess."""
        known = {t.point.neurons for t in self.tried if t.learner == learner}
        self.tried += tuple(
            Tried(learner, point, guess) for point in points if point.neurons not in known
        )

    def untried(self, learner: LearnerName) -> tuple[int, ...]:
        """Return the numbers of neurons of which nobody knows whether the block falls."""
        known = {t.point.neurons for t in self.tried if t.learner == learner}
        return tuple(count for count in counts_of(learner) if count not in known)
