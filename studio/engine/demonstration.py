"""From recordings to what a learner sees: aligned demonstrations (K, T, D), split by demonstration.

The paper resamples every demonstration to 142 samples; so do we, evenly or at random stamps.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from operator import itemgetter
from typing import Literal

import numpy as np

from studio.engine.errors import NothingTaughtError, StudioError
from studio.engine.recording import Recording
from studio.engine.retarget import DRIVEN_JOINTS, LEARNED_JOINTS, Mapping
from studio.engine.skeleton import FloatArray, Side

SAMPLES = 142  # in each demonstration, the paper's Section IV-A
SHORTEST = 1.0  # [s]; a shorter armed stretch is a slip and no demonstration
Interpolation = Literal["even", "random"]


@dataclass(frozen=True, eq=False)
class Demonstration:
    """One armed stretch: the commands that were *sent*, as the robot's own record of the motion."""

    name: str
    side: Side
    mapping: Mapping
    times: FloatArray  # (T,) [s] from the moment of arming, rising
    sent: FloatArray  # (T, D) [rad], columns as in `joints`
    first_sample: int  # in its recording
    last_sample: int

    @property
    def joints(self) -> tuple[str, ...]:
        """The columns' joints: s0, s1, e0, e1, or the paper's s0, s1, e1."""
        return LEARNED_JOINTS[self.mapping]

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

    One in which the arm was never seen is none: nothing moved in it.
    """
    info = recording.info
    columns = [DRIVEN_JOINTS.index(joint) for joint in LEARNED_JOINTS[info.mapping]]
    found: list[Demonstration] = []
    for first, last in armed_stretches(recording):
        stretch = recording.samples[first : last + 1]
        times = np.array([sample.time for sample in stretch])
        followed = any(sample.wanted is not None for sample in stretch)
        if followed and times[-1] - times[0] >= SHORTEST:
            sent = np.array([sample.sent[columns] for sample in stretch])
            label = name if not found else f"{name} ({len(found) + 1})"
            found.append(
                Demonstration(label, info.side, info.mapping, times - times[0], sent, first, last)
            )
    return found


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
    """Demonstrations of one motion by one arm, aligned: what a learner is trained on."""

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
            Where they differ in arm or mapping: they cannot be one motion.
        """
        if not demonstrations:
            raise NothingTaughtError("there is no demonstration to learn from")
        first = demonstrations[0]
        for other in demonstrations[1:]:
            if (other.side, other.mapping) != (first.side, first.mapping):
                raise StudioError(
                    f"{other.name} was taught with the {other.side} arm and the {other.mapping} "
                    f"mapping, {first.name} with the {first.side} arm and the {first.mapping} "
                    "mapping: learn from one kind at a time"
                )
        rng = np.random.default_rng(seed)
        rows = np.stack([resample(each, interpolation, rng) for each in demonstrations])
        return cls(tuple(demonstrations), rows)

    @property
    def side(self) -> Side:
        """The arm that was taught."""
        return self.demonstrations[0].side

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
