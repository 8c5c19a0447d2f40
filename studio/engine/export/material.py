"""What there is to export: demonstrations with their recordings, what was learned, what was done.

A demonstration is a stretch of a recording's samples, so that a recording and two numbers are all
that has to be kept of it; `cut` makes it again, the same to the bit.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from studio.engine.arms import learned_columns
from studio.engine.demonstration import Demonstration, DemonstrationSet, demonstrations_of
from studio.engine.errors import FileError, NothingTaughtError
from studio.engine.experiment import Setup, teach, why_nothing
from studio.engine.hands import PLAIN, HandTrack
from studio.engine.recording import Recording
from studio.engine.teaching import Lesson, Reproduction


@dataclass(frozen=True, eq=False)
class Take:
    """A demonstration, and the recording that it is a stretch of."""

    demonstration: Demonstration
    recording: Recording
    included: bool = True  # whether it is learned from


@dataclass(frozen=True, eq=False)
class Material:
    """See the module; all of it as it is at one moment."""

    setup: Setup
    takes: tuple[Take, ...]
    lesson: Lesson | None = None
    reproduction: Reproduction | None = None

    @cached_property
    def recordings(self) -> tuple[Recording, ...]:
        """The recordings, each once, in the order of their first demonstrations."""
        return tuple({id(take.recording): take.recording for take in self.takes}.values())

    @property
    def taught(self) -> DemonstrationSet:
        """The demonstrations that were learned from, or else those that would be.

        Raises
        ------
        NothingTaughtError
            Where none is included.
        StudioError
            Where those included differ in arm or mapping.
        """
        if self.lesson is not None:
            return self.lesson.taught
        chosen = [take.demonstration for take in self.takes if take.included]
        return DemonstrationSet.of(chosen, self.setup.interpolation, self.setup.seed)

    @cached_property
    def learned_from(self) -> tuple[int, ...] | None:
        """Which takes the lesson was learned from; None where one of them is no longer there."""
        if self.lesson is None:
            return None
        found = [self._index_of(each) for each in self.lesson.taught.demonstrations]
        known = [index for index in found if index is not None]
        return tuple(known) if len(known) == len(found) else None

    def _index_of(self, demonstration: Demonstration) -> int | None:
        """Return which take is the same motion to the bit, whatever it is called by now."""
        for index, take in enumerate(self.takes):
            listed = take.demonstration
            if (
                listed.joints == demonstration.joints
                and np.array_equal(listed.times, demonstration.times)
                and np.array_equal(listed.sent, demonstration.sent)
            ):
                return index
        return None


def cut(recording: Recording, name: str, first: int, last: int) -> Demonstration:
    """Return the demonstration that these samples of a recording are, both ends included.

    Raises
    ------
    FileError
        Where the recording has no such samples, or fewer than two of them.
    """
    if not 0 <= first < last < len(recording.samples):
        raise FileError(
            f"{name}: samples {first} to {last} of a recording of {len(recording.samples)}; "
            "expected two or more that it has"
        )
    info = recording.info
    stretch = recording.samples[first : last + 1]
    times = np.array([sample.time for sample in stretch])
    times -= times[0]
    sent = np.array([sample.sent[learned_columns(info.arms, info.mapping)] for sample in stretch])
    hands = None
    if info.hands != PLAIN:
        hands = HandTrack.of(info.hands, times, [sample.hands for sample in stretch])
    return Demonstration(name, info.arms, info.mapping, times, sent, first, last, hands, info.scene)


def material_of(paths: Sequence[Path], setup: Setup) -> Material:
    """Return what files teach: recordings as they are, skeletons followed now.

    Raises
    ------
    FileError
        Where a file cannot be used.
    NothingTaughtError
        Where nothing armed in any of them.
    """
    takes: list[Take] = []
    outcomes = []
    for path in paths:
        recordings: list[Recording] = []
        outcomes += teach([path], setup, recordings.append).files
        for recording in recordings:
            takes += [Take(each, recording) for each in demonstrations_of(recording, path.stem)]
    if not takes:
        raise NothingTaughtError(why_nothing(outcomes))
    return Material(setup, tuple(takes))
