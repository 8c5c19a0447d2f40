"""What can be asked of a session: small frozen messages, put into its inbox from any thread."""

from dataclasses import dataclass
from pathlib import Path

from studio.engine.choices import Choices
from studio.engine.teaching import LearnerSettings


@dataclass(frozen=True)
class UseDemonstrator:
    """Take the built-in demonstrator's next take as the source."""


@dataclass(frozen=True)
class UseFile:
    """Take a skeleton file as the source, or add an MCAP recording's demonstrations."""

    path: Path
    name: str = ""  # as the user knows the file, if the path is a copy

    @property
    def shown(self) -> str:
        """The file's name for people."""
        return self.name or self.path.name


@dataclass(frozen=True)
class UseLive:
    """Take whoever sends a live stream as the source."""


@dataclass(frozen=True)
class Configure:
    """Choose how Baxter is taught from now on; the calibration stays as it is."""

    choices: Choices


@dataclass(frozen=True)
class Calibrate:
    """Watch the source for two seconds of the neutral pose; the robot holds still."""


@dataclass(frozen=True)
class ForgetCalibration:
    """Trust the sensor's spine line again."""


@dataclass(frozen=True)
class Watch:
    """Let the robot follow the source from its beginning, without recording."""


@dataclass(frozen=True)
class Record:
    """Let the robot follow the source from its beginning, and record it."""


@dataclass(frozen=True)
class Remove:
    """Take a demonstration off the list; its file stays."""

    index: int


@dataclass(frozen=True)
class Train:
    """Learn from the listed demonstrations of the chosen arm and mapping."""

    learner: LearnerSettings


@dataclass(frozen=True)
class Choose:
    """Choose the demonstration that is shown as a ghost and beside the reproduction."""

    index: int


@dataclass(frozen=True)
class PlayReproduction:
    """Let the robot do alone what it learned."""


@dataclass(frozen=True)
class PlayDemonstration:
    """Let the robot replay the chosen demonstration."""


@dataclass(frozen=True)
class Stop:
    """Stop whatever goes on, disarm, and keep what was recorded."""


Command = (
    UseDemonstrator
    | UseFile
    | UseLive
    | Configure
    | Calibrate
    | ForgetCalibration
    | Watch
    | Record
    | Remove
    | Train
    | Choose
    | PlayReproduction
    | PlayDemonstration
    | Stop
)
