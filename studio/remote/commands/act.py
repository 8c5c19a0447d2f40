"""Commands as messages. Written by docs/make_remote_schema.py: change it there."""

from studio.remote.commands.parts import Choices
from studio.remote.message import Message, Text


class Calibrate(Message, frozen=True):
    """Watch the source for two seconds of the neutral pose; the robot holds still."""


class ChooseScene(Message, frozen=True):
    """Choose what stands around Baxter, and what is to be done with it."""

    scene: Text  # one that ships, all that a program may name; or a file's path, or itself


class Configure(Message, frozen=True):
    """Choose how Baxter is taught from now on; calibration and scene stay as they are."""

    choices: Choices


class ForgetCalibration(Message, frozen=True):
    """Trust the sensor's spine line again."""


class LetGo(Message, frozen=True):
    """Stop if somebody teaches, whether armed or not yet; whatever Baxter does alone goes on."""

    why: Text  # in words, for whoever comes next


class Record(Message, frozen=True):
    """Let the robot follow the source from its beginning, and record it."""

    repeats: bool = False  # whether, without an end, each demonstration has its own recording


class RecordAgain(Message, frozen=True):
    """Record once more what is being recorded, or else a listed demonstration.

    The new one takes the old one's place on the list once something has armed in it; the old one
    is deleted then, and can be brought back.
    """

    number: int | None = None  # None: the chosen one


class Stop(Message, frozen=True):
    """Stop whatever goes on, disarm, and keep what was recorded."""


class Watch(Message, frozen=True):
    """Let the robot follow the source from its beginning, without recording."""
