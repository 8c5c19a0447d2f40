"""Commands as messages. Written by docs/make_remote_schema.py: change it there."""

from typing import Literal

from studio.remote.commands.parts import LearnerSettings
from studio.remote.message import Message


class CancelWork(Message, frozen=True):
    """Give up what is being computed."""


class ChooseLearner(Message, frozen=True):
    """Show how this network would do; `Train` teaches it."""

    learner: LearnerSettings


class Guess(Message, frozen=True):
    """Say whether the block will fall, and find out: train, and let Baxter do it behind the scenes.

    Nobody is told without a guess.
    """

    learner: LearnerSettings
    falls: bool


class ResumeCurve(Message, frozen=True):
    """Go on with the error curve after it was stopped, or has failed."""


class RevealBlocks(Message, frozen=True):
    """Find out for every number of neurons whether the block falls."""

    learner: Literal["rbf", "newrb", "field", "plain-field"]


class Train(Message, frozen=True):
    """Learn from the listed demonstrations of the chosen arm and mapping."""

    learner: LearnerSettings


class TryOut(Message, frozen=True):
    """Let Baxter do alone what it learned, many times under varied conditions, behind the scenes.

    `CancelWork` ends it; what is known by then stays.
    """

    trials: int = 100
