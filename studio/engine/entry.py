"""A demonstration on the list: what was shown, what of it counts, and what is wrong with it."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from studio.engine.arms import Arms
from studio.engine.demonstration import SHORTEST, Demonstration, demonstrations_of
from studio.engine.errors import StudioError
from studio.engine.export.material import Take, cut
from studio.engine.quality import Flag
from studio.engine.recording import Recording
from studio.engine.retarget import Mapping
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.scene import USUAL, Scene
from studio.engine.task_words import TaskWords, task_words

LONGEST_NAME = 60  # characters


@dataclass(frozen=True, eq=False)
class Entry:
    """One card; every change returns another one of the same number.

    The number stays for as long as the studio runs, whatever else is deleted: two browsers that
    speak of number 3 mean the same.
    """

    number: int
    demonstration: Demonstration  # as it is trimmed
    whole: Demonstration  # as it was recorded; trimming takes from this one
    recording: Recording
    included: bool = True  # whether it is learned from
    flags: tuple[Flag, ...] | None = None  # what is wrong; None until it was looked at
    file: Path | None = None  # the recording's, where it is one of the studio's own

    @classmethod
    def of(cls, number: int, take: Take, file: Path | None = None) -> "Entry":
        """Return the card of a take, which may have been trimmed before."""
        shown = take.demonstration
        whole = next(
            (
                replace(each, name=shown.name)
                for each in demonstrations_of(take.recording, shown.name)
                if each.first_sample <= shown.first_sample and shown.last_sample <= each.last_sample
            ),
            shown,
        )
        return cls(number, shown, whole, take.recording, take.included, None, file)

    @property
    def name(self) -> str:
        """As people know it; no file is named by it."""
        return self.demonstration.name

    @property
    def take(self) -> Take:
        """What exports need of it."""
        return Take(self.demonstration, self.recording, self.included)

    @property
    def block_down(self) -> bool:
        """Whether the scene's first block was down at the recording's end."""
        return self.recording.samples[-1].world.block_down

    @property
    def done(self) -> bool:
        """Whether the scene's task was done at the recording's end."""
        return self.recording.samples[-1].world.done

    @property
    def task(self) -> TaskWords:
        """How one says that."""
        return task_words(self.demonstration.scene)

    @property
    def span(self) -> tuple[float, float]:
        """From when to when [s] of the whole it is kept."""
        skipped = self.demonstration.first_sample - self.whole.first_sample
        begin = float(self.whole.times[skipped])
        return begin, begin + self.demonstration.duration

    @property
    def is_trimmed(self) -> bool:
        """Whether anything of the whole was taken off."""
        return len(self.demonstration.times) < len(self.whole.times)

    def is_of(self, arms: Arms, mapping: Mapping, scene: Scene = USUAL) -> bool:
        """Tell whether it was taught with these arms and this mapping, in that scene."""
        shown = self.demonstration
        return (shown.arms, shown.mapping) == (arms, mapping) and shown.scene.is_same_as(scene)

    def is_alike(self, other: "Entry") -> bool:
        """Tell whether arms, mapping and scene of both are the same: they may be one motion."""
        shown = other.demonstration
        return self.is_of(shown.arms, shown.mapping, shown.scene)

    def renamed(self, name: str) -> "Entry":
        """Return it under another name; raise StudioError where that cannot be shown in a line."""
        name = name.strip()
        if not name or len(name) > LONGEST_NAME or not name.isprintable():
            raise StudioError(f"A name has 1 to {LONGEST_NAME} characters, all in one line")
        return replace(
            self,
            demonstration=replace(self.demonstration, name=name),
            whole=replace(self.whole, name=name),
        )

    def trimmed(self, begin: float, end: float) -> "Entry":
        """Return it kept from ``begin`` to ``end`` [s] of the whole, to the nearest samples.

        Raises
        ------
        StudioError
            Where that is shorter than a demonstration may be.
        """
        times = self.whole.times
        first, last = (int(np.abs(times - moment).argmin()) for moment in (begin, end))
        # Half a tick of grace: what two handles of a slider mean is rounded.
        if not times[last] - times[first] > SHORTEST - CONTROL_PERIOD / 2.0:
            raise StudioError(f"A demonstration is {SHORTEST:g} s or longer: trim less")
        start = self.whole.first_sample
        kept = cut(self.recording, self.name, start + first, start + last)
        return replace(self, demonstration=kept)
