"""What people let the robot do, and how it is taught."""

from dataclasses import dataclass

from studio.engine.choices import Choices
from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene


@dataclass(frozen=True)
class Configure:
    """Choose how Baxter is taught from now on; calibration and scene stay as they are."""

    choices: Choices

    def among(self, choices: Choices) -> Choices:
        """Return what is chosen then; raise StudioError where the scene does not allow it."""
        return choices.configured(self.choices)


@dataclass(frozen=True)
class ChooseScene:
    """Choose what stands around Baxter, and what is to be done with it."""

    scene: str | Scene  # one that ships, all that a program may name; or a file's path, or itself

    def among(self, choices: Choices) -> Choices:
        """Return what was chosen before, in this scene; raise FileError where there is none."""
        scene = self.scene if isinstance(self.scene, Scene) else read_scene(self.scene)
        return choices.in_scene(scene)


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

    repeats: bool = False  # whether, without an end, each demonstration has its own recording


@dataclass(frozen=True)
class RecordAgain:
    """Record once more what is being recorded, or else a listed demonstration.

    The new one takes the old one's place on the list once something has armed in it; the old one
    is deleted then, and can be brought back.
    """

    number: int | None = None  # None: the chosen one


@dataclass(frozen=True)
class Stop:
    """Stop whatever goes on, disarm, and keep what was recorded."""


@dataclass(frozen=True)
class LetGo:
    """Stop if somebody teaches, whether armed or not yet; whatever Baxter does alone goes on."""

    why: str  # in words, for whoever comes next


ActCommand = (
    Configure
    | ChooseScene
    | Calibrate
    | ForgetCalibration
    | Watch
    | Record
    | RecordAgain
    | Stop
    | LetGo
)
