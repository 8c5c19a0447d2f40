"""What is wrong with a demonstration, before anybody learns from it: flags, each with its numbers.

The thresholds were set on 48 takes of the built-in demonstrator (two mappings), which raise none;
beside each stands the worst of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from operator import itemgetter

import numpy as np

from studio.engine.demonstration import Demonstration, resample
from studio.engine.recording import Recording, Sample
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.skeleton import FloatArray
from studio.engine.task_words import BLOCK, task_words

LONGEST_DROPOUT = 0.3  # [s] without a usable arm; worst 0.0
MOST_LIMITED = 0.15  # share of ticks at a position or velocity limit; worst 0.042
LEAST_MOTION = 10.0  # [deg] range of the joint that moves most; least 58
MOST_SHAKE = 45.0  # [rad/s²] RMS acceleration that was wanted; worst 31
FARTHEST = 20.0  # [deg] RMS distance from the peers' median; worst 14
FARTHER = 2.5  # times as far as the peers are from theirs, in the median
PAUSE = 0.2  # [s] between two places that are shown as one
FEWEST_PEERS = 2  # with fewer nobody can say which one is the odd one out


@dataclass(frozen=True)
class Flag:
    """One thing that is wrong."""

    name: str  # in one or two words
    value: float
    threshold: float
    unit: str
    words: str  # for people: what it is, and what to do
    places: tuple[tuple[float, float], ...]  # [s] from the demonstration's beginning, from and to


def flags_of(
    demonstration: Demonstration, recording: Recording, peers: Sequence[Demonstration] = ()
) -> tuple[Flag, ...]:
    """Return what is wrong with a demonstration of a recording; nothing where all is well.

    ``peers`` are other demonstrations of the same motion, by the same joints.
    """
    samples = recording.samples[demonstration.first_sample : demonstration.last_sample + 1]
    found = (
        _dropouts(samples),
        _limits(samples),
        _too_little_motion(demonstration),
        _shake(samples),
        _outlier(demonstration, peers),
        _not_done(demonstration, recording),
    )
    return tuple(flag for flag in found if flag is not None)


def _dropouts(samples: Sequence[Sample]) -> Flag | None:
    """Flag stretches in which the robot was held because the arm could not be used."""
    runs = _runs([bool(sample.held) for sample in samples])
    longest = max((end - start for start, end in runs), default=0.0)
    if longest <= LONGEST_DROPOUT:
        return None
    why = next(sample.held for sample in samples if sample.held)
    words = f"the arm was lost ({why}): stand where the sensor sees it all, and record again"
    gaps = tuple(run for run in runs if run[1] - run[0] > LONGEST_DROPOUT)
    return Flag("dropout", longest, LONGEST_DROPOUT, "s", words, gaps)


def _limits(samples: Sequence[Sample]) -> Flag | None:
    limited = [sample.limited for sample in samples]
    share = float(np.mean(limited))
    if share <= MOST_LIMITED:
        return None
    words = "Baxter's limits bit: move slower, and within what its arm can reach"
    return Flag("limits hit", share, MOST_LIMITED, "of the time", words, _runs(limited))


def _too_little_motion(demonstration: Demonstration) -> Flag | None:
    moved = float(np.degrees(np.ptp(demonstration.sent, axis=0).max()))
    if moved >= LEAST_MOTION:
        return None
    words = "hardly anything moved: show the whole motion before disarming"
    whole = ((0.0, demonstration.duration),)
    return Flag("too little motion", moved, LEAST_MOTION, "deg", words, whole)


def _shake(samples: Sequence[Sample]) -> Flag | None:
    """Flag shaking by what was wanted: the limiter makes what is sent look smooth."""
    wanted = [sample.wanted for sample in samples]
    known = np.array([angles for angles in wanted if angles is not None])
    if len(known) < 3:
        return None
    acceleration = np.linalg.norm(np.diff(known, 2, axis=0), axis=1) * CONTROL_RATE**2
    shake = float(np.sqrt(np.mean(acceleration**2)))
    if shake <= MOST_SHAKE:
        return None
    words = "the arm shook or was seen badly: more light, no loose sleeves, and record again"
    places = _runs((acceleration > MOST_SHAKE).tolist())
    return Flag("jerk", shake, MOST_SHAKE, "rad/s²", words, places)


def _outlier(demonstration: Demonstration, peers: Sequence[Demonstration]) -> Flag | None:
    if len(peers) < FEWEST_PEERS:
        return None
    everyone = np.stack([resample(each) for each in (demonstration, *peers)])
    distances = [_distance(everyone, index) for index in range(len(everyone))]
    usual = max(float(np.median(distances[1:])), np.finfo(float).tiny)
    threshold = max(FARTHEST, FARTHER * usual)
    if distances[0] <= threshold:
        return None
    apart = np.linalg.norm(everyone[0] - np.median(everyone[1:], axis=0), axis=1)
    far = (np.degrees(apart) > threshold).tolist()
    step = demonstration.duration / (len(apart) - 1)
    words = "unlike the others: leave it out, or record the others again"
    return Flag("outlier", distances[0], threshold, "deg", words, _runs(far, step))


def _distance(everyone: FloatArray, index: int) -> float:
    """Return how far [deg] one of (K, T, D) is from the median of the others, RMS over time."""
    others = np.median(np.delete(everyone, index, axis=0), axis=0)
    squares = np.square(everyone[index] - others).sum(axis=1)
    return float(np.degrees(np.sqrt(squares.mean())))


def _not_done(demonstration: Demonstration, recording: Recording) -> Flag | None:
    """Flag a demonstration whose recording ends with the task not done."""
    last, end = recording.samples[-1].world, demonstration.duration
    if last.done:
        return None
    if task_words(demonstration.scene) is BLOCK:
        words = "the block was not pushed down: push further, or check where Baxter's hand went"
        return Flag("block stands", 0.0, 1.0, "blocks down", words, ((end, end),))
    words = f"the task was not done: {last.missing}; check where Baxter's hand went"
    return Flag("task not done", 0.0, 1.0, "tasks done", words, ((end, end),))


def _runs(marks: Sequence[bool], step: float = CONTROL_PERIOD) -> tuple[tuple[float, float], ...]:
    """Return from when to when [s] marks, ``step`` apart, are set; short pauses join them."""
    runs: list[tuple[float, float]] = []
    for is_set, group in groupby(enumerate(marks), key=itemgetter(1)):
        indices = [index for index, _ in group]
        start, end = indices[0] * step, (indices[-1] + 1) * step
        if is_set and runs and start - runs[-1][1] < PAUSE:
            runs[-1] = (runs[-1][0], end)
        elif is_set:
            runs.append((start, end))
    return tuple(runs)
