"""What a session shows of learning."""

from collections.abc import Mapping
from dataclasses import dataclass

from studio.engine.curves import counts_of
from studio.engine.export.equation import Equation
from studio.engine.findings import FEWEST_GUESSES, Curve, Tried
from studio.engine.teaching import LearnerSettings


@dataclass(frozen=True)
class Underway:
    """Work that somebody waits for."""

    words: str
    share: float | None  # that is done, 0 to 1; None where nobody can tell


@dataclass(frozen=True, eq=False)
class LearningStatus:
    """See the module."""

    chosen: LearnerSettings
    underway: Underway | None  # None while nobody waits for anything
    curve: Curve  # the chosen learner's
    is_drawing: bool  # whether more of the curve is being computed
    tried: tuple[Tried, ...]  # all learners', in the order in which they were tried
    equations: Mapping[str, Equation]  # by `equations_of`'s keys; empty until they are there

    @property
    def outcome(self) -> Tried | None:
        """What is known of the chosen network."""
        wanted = (self.chosen.name, self.chosen.neurons)
        return next((t for t in self.tried if (t.learner, t.point.neurons) == wanted), None)

    @property
    def untried(self) -> tuple[int, ...]:
        """The numbers of neurons of which nobody knows yet, with the chosen learner."""
        name = self.chosen.name
        known = {each.point.neurons for each in self.tried if each.learner == name}
        return tuple(count for count in counts_of(name) if count not in known)

    @property
    def guesses(self) -> int:
        """How often somebody guessed."""
        return sum(each.guess is not None for each in self.tried)

    @property
    def right(self) -> int:
        """How often the guess was right."""
        return sum(each.right for each in self.tried)

    @property
    def guesses_missing(self) -> int:
        """How many guesses are needed before all may be revealed."""
        return max(0, FEWEST_GUESSES - self.guesses)
