"""From recordings to what a learner sees: aligned demonstrations (K, T, D), split by demonstration.

The paper resamples every demonstration to 142 samples; so do we, evenly or at random stamps.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from operator import itemgetter
from typing import Literal

import numpy as np

from studio.engine.arms import Arms, in_words, learned_columns, learned_joints
from studio.engine.engage import ARRIVED_WITHIN
from studio.engine.errors import NothingTaughtError, StudioError
from studio.engine.hands import PLAIN, HandOptions, HandTrack
from studio.engine.recording import Recording, Sample
from studio.engine.retarget import DRIVEN_JOINTS, Mapping
from studio.engine.scene import USUAL, Scene
from studio.engine.skeleton import FloatArray

SAMPLES = 142  # in each demonstration, the paper's Section IV-A
SHORTEST = 1.0  # [s]; a shorter armed stretch is a slip and no demonstration
Interpolation = Literal["even", "random"]


@dataclass(frozen=True, eq=False)
class Demonstration:
    """One armed stretch: the commands that were *sent*, as the robot's own record of the motion."""

    name: str
    arms: Arms
    mapping: Mapping
    times: FloatArray  # (T,) [s] from the moment when the robot had come to the person, rising
    sent: FloatArray  # (T, D) [rad], columns as in `joints`
    first_sample: int  # in its recording
    last_sample: int
    hands: HandTrack | None = None  # what wrists and grippers did meanwhile, if they did anything
    scene: Scene = USUAL  # in which it was taught

    @property
    def joints(self) -> tuple[str, ...]:
        """The columns' joints, by Baxter's own names: ``left_s0``."""
        return learned_joints(self.arms, self.mapping)

    @property
    def duration(self) -> float:
        """Length [s]."""
        return float(self.times[-1])

    def at(self, times: FloatArray) -> FloatArray:
        """Return what was sent (N, D) [rad] at ``times`` (N,) [s], interpolated linearly."""
        return np.column_stack([np.interp(times, self.times, column) for column in self.sent.T])

    def trajectory(self) -> Callable[[float], FloatArray]:
        """Return what was sent (D,) [rad] as a function of one time [s]."""
        return lambda time: self.at(np.array([time]))[0]


def armed_stretches(recording: Recording) -> list[tuple[int, int]]:
    """Return the first and last sample of every unbroken armed stretch."""
    stretches = []
    armed = (sample.gate.armed for sample in recording.samples)
    for is_armed, group in groupby(enumerate(armed), key=itemgetter(1)):
        indices = [i for i, _ in group]
        if is_armed:
            stretches.append((indices[0], indices[-1]))
    return stretches


def demonstrations_of(recording: Recording, name: str) -> list[Demonstration]:
    """Return a demonstration for every armed stretch of at least `SHORTEST` seconds.

    It begins when the robot has come to where the person is, of two arms with the first: the way
    there depends on where the robot happened to wait, is as long as that is far, and is nothing
    that the person showed. A robot that plays the demonstration comes to its beginning by itself,
    and as softly. A stretch in which no arm was seen is none: nothing moved in it.
    """
    info = recording.info
    columns = learned_columns(info.arms, info.mapping)
    found: list[Demonstration] = []
    for first, last in armed_stretches(recording):
        arrived = _arrival(recording, first, last)
        if arrived is None:
            continue
        stretch = recording.samples[arrived : last + 1]
        times = np.array([sample.time for sample in stretch])
        if times[-1] - times[0] >= SHORTEST:
            sent = np.array([sample.sent[columns] for sample in stretch])
            label = name if not found else f"{name} ({len(found) + 1})"
            times -= times[0]
            hands, how = _hands(info.hands, times, stretch), (info.arms, info.mapping)
            found.append(Demonstration(label, *how, times, sent, arrived, last, hands, info.scene))
    return found


def _hands(options: HandOptions, times: FloatArray, stretch: Sequence[Sample]) -> HandTrack | None:
    if options == PLAIN:
        return None
    return HandTrack.of(options, times, [sample.hands for sample in stretch])


def _arrival(recording: Recording, first: int, last: int) -> int | None:
    """Return the sample of an armed stretch in which an arm first is where the person is.

    If none ever gets there, the first in which there is somebody to follow; None without one.
    """
    seen = [i for i in range(first, last + 1) if recording.samples[i].wanted is not None]
    for index in seen:
        sample = recording.samples[index]
        behind = np.abs(np.array(sample.wanted) - sample.sent).reshape(-1, len(DRIVEN_JOINTS))
        if behind.max(axis=1).min() < ARRIVED_WITHIN:
            return index
    return seen[0] if seen else None


def resample(
    demonstration: Demonstration,
    interpolation: Interpolation = "even",
    rng: np.random.Generator | None = None,
) -> FloatArray:
    """Return a demonstration as `SAMPLES` rows (142, D) [rad].

    ``random`` is our reading of the paper's "we randomly interpolate the experimental data": the
    first and last sample stay, and each of the others is taken at a random moment of its own even
    share of the time. The rows then count as evenly spaced, which bends time a little.
    """
    steps = np.arange(SAMPLES, dtype=float)
    if interpolation == "random":
        if rng is None:
            raise StudioError("random interpolation needs a seeded generator")
        steps[1:-1] += rng.uniform(-0.5, 0.5, SAMPLES - 2)
    return demonstration.at(steps / (SAMPLES - 1) * demonstration.duration)


@dataclass(frozen=True, eq=False)
class DemonstrationSet:
    """Demonstrations of one motion by the same arms, aligned: what a learner is trained on."""

    demonstrations: tuple[Demonstration, ...]
    rows: FloatArray  # (K, 142, D) [rad]

    @classmethod
    def of(
        cls,
        demonstrations: Sequence[Demonstration],
        interpolation: Interpolation = "even",
        seed: int = 0,
    ) -> "DemonstrationSet":
        """Align demonstrations.

        Raises
        ------
        NothingTaughtError
            Where there is none.
        StudioError
            Where they differ in arm, mapping or scene: they cannot be one motion.
        """
        if not demonstrations:
            raise NothingTaughtError("there is no demonstration to learn from")
        first = demonstrations[0]
        for other in demonstrations[1:]:
            if (other.arms, other.mapping) != (first.arms, first.mapping):
                raise StudioError(
                    f"{other.name} was taught with {in_words(other.arms)} and the {other.mapping} "
                    f"mapping, {first.name} with {in_words(first.arms)} and the {first.mapping} "
                    "mapping: learn from one kind at a time"
                )
            if not other.scene.is_same_as(first.scene):
                where = first.scene.name_beside(other.scene)
                raise StudioError(
                    f"{other.name} was taught in the scene {other.scene.name}, {first.name} in "
                    f"{where}: learn from one scene at a time"
                )
        rng = np.random.default_rng(seed)
        rows = np.stack([resample(each, interpolation, rng) for each in demonstrations])
        return cls(tuple(demonstrations), rows)

    @property
    def arms(self) -> Arms:
        """The arms that were taught."""
        return self.demonstrations[0].arms

    @property
    def hands(self) -> HandTrack | None:
        """What hands do in the reproduction: the mean of those demonstrations that drove them."""
        tracks = [each.hands for each in self.demonstrations if each.hands is not None]
        tracks = [each for each in tracks if each.options == tracks[0].options]
        return HandTrack.mean(tracks, self.duration, SAMPLES) if tracks else None

    @property
    def scene(self) -> Scene:
        """The scene in which it was taught, for its arms."""
        return self.demonstrations[0].scene.taught_by(self.arms)

    @property
    def mapping(self) -> Mapping:
        """The mapping that it was taught with."""
        return self.demonstrations[0].mapping

    @property
    def joints(self) -> tuple[str, ...]:
        """The names of the D columns."""
        return self.demonstrations[0].joints

    @property
    def duration(self) -> float:
        """Mean length [s]: how long the reproduction takes."""
        return float(np.mean([each.duration for each in self.demonstrations]))

    @property
    def mean(self) -> FloatArray:
        """The mean sent demonstration (142, D) [rad]."""
        mean: FloatArray = self.rows.mean(axis=0)
        return mean
