"""How people let Baxter learn, and find out how few neurons are too few."""

from dataclasses import dataclass

from studio.engine.teaching import LearnerName, LearnerSettings


@dataclass(frozen=True)
class ChooseLearner:
    """Show how this network would do; `Train` teaches it."""

    learner: LearnerSettings


@dataclass(frozen=True)
class Train:
    """Learn from the listed demonstrations of the chosen arm and mapping."""

    learner: LearnerSettings


@dataclass(frozen=True)
class Guess:
    """Say whether the block will fall, and find out: train, and let Baxter do it behind the scenes.

    Nobody is told without a guess.
    """

    learner: LearnerSettings
    falls: bool


@dataclass(frozen=True)
class RevealBlocks:
    """Find out for every number of neurons whether the block falls."""

    learner: LearnerName


@dataclass(frozen=True)
class TryOut:
    """Let Baxter do alone what it learned, many times under varied conditions, behind the scenes.

    `CancelWork` ends it; what is known by then stays.
    """

    trials: int = 100


@dataclass(frozen=True)
class ResumeCurve:
    """Go on with the error curve after it was stopped, or has failed."""


@dataclass(frozen=True)
class CancelWork:
    """Give up what is being computed."""


LearnCommand = ChooseLearner | Train | Guess | RevealBlocks | TryOut | ResumeCurve | CancelWork
