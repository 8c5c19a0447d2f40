"""One motion's success rate, beside that of each demonstration's own replay in the same trials."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from studio.engine.evaluate.interval import Rate, mcnemar, rate_of, wilson
from studio.engine.evaluate.journal import Journal, Key
from studio.engine.evaluate.motion import Motion
from studio.engine.evaluate.runs import Conditions, Progress, Trial, checked_count, run_trials
from studio.engine.evaluate.trial import Outcome

PARTS = 3  # that the trials are divided into by what was drawn: low, middle, high


@dataclass(frozen=True, eq=False)
class Tested:
    """What became of a motion in the trials from 0 on."""

    motion: Motion
    outcomes: tuple[Outcome, ...]  # by trial

    @property
    def rate(self) -> Rate:
        """How often the task was done."""
        return rate_of(sum(outcome.done for outcome in self.outcomes), len(self.outcomes))

    @property
    def failures(self) -> tuple[tuple[str, int], ...]:
        """Why it was not, and how often; the most frequent reason first."""
        counts = Counter(outcome.why for outcome in self.outcomes if not outcome.done)
        return tuple(sorted(counts.items(), key=lambda each: (-each[1], each[0])))


@dataclass(frozen=True)
class Paired:
    """How two motions compare in the trials that both were in."""

    both: int
    only_first: int
    only_second: int
    neither: int

    @property
    def chance(self) -> float:
        """How likely so large a difference is by chance alone: McNemar's exact test."""
        return mcnemar(self.only_first, self.only_second)


@dataclass(frozen=True)
class Part:
    """The trials in which one variation was drawn from a part of its range."""

    low: float
    high: float
    rate: Rate


@dataclass(frozen=True, eq=False)
class Evaluation:
    """See the module."""

    conditions: Conditions
    tested: Tested
    replays: tuple[Tested, ...]  # of each demonstration, in the first of the same trials

    @property
    def parts(self) -> dict[str, tuple[Part, ...]]:
        """The rate by what was drawn: each variation in `PARTS` parts of as many trials."""
        outcomes = self.tested.outcomes
        drawn = [
            self.conditions.variation(self.tested.motion, trial).measures
            for trial in range(len(outcomes))
        ]
        done = np.array([outcome.done for outcome in outcomes])
        found = {}
        for name in drawn[0] if drawn else ():
            values = np.array([each[name] for each in drawn])
            if values.min() < values.max():
                found[name] = _parts(values, done)
        return found


def evaluate(
    motion: Motion,
    replays: Sequence[Motion],
    conditions: Conditions,
    trials: int,
    replayed: int,
    jobs: int | None = None,
    journal: Journal | None = None,
    progress: Progress = lambda _over, _all: None,
) -> Evaluation:
    """Do a motion ``trials`` times, and each replay ``replayed`` times, under varied conditions.

    Trial i is the same for all of them, and for everybody who asks with the same seed.

    Raises
    ------
    StudioError
        Where a number of trials is impossible.
    FileError
        Where the journal cannot be written.
    """
    checked_count("trials", trials)
    checked_count("replays", replayed, least=0)
    asked = _asked(motion, trials, conditions)
    asked += [trial for each in replays for trial in _asked(each, replayed, conditions)]
    found = run_trials(sorted(asked, key=lambda trial: trial.number), jobs, journal, progress)
    shown = tuple(tested_of(each, replayed, found) for each in replays)
    return Evaluation(conditions, tested_of(motion, trials, found), shown if replayed else ())


def tested_of(motion: Motion, trials: int, found: Mapping[Key, Outcome]) -> Tested:
    """Return what became of a motion, out of all outcomes."""
    return Tested(motion, tuple(found[motion.name, trial] for trial in range(trials)))


def paired(first: Tested, second: Tested) -> Paired:
    """Compare two motions in the trials that both were in."""
    pairs = Counter(
        (one.done, other.done) for one, other in zip(first.outcomes, second.outcomes, strict=False)
    )
    return Paired(pairs[True, True], pairs[True, False], pairs[False, True], pairs[False, False])


def pooled(replays: Sequence[Tested]) -> tuple[float, float, float]:
    """Return the demonstrations' own rate, and its interval from low to high.

    It counts trials and not replays: those of one trial share what was drawn, and so say less than
    as many trials would.
    """
    trials = max((len(each.outcomes) for each in replays), default=0)
    rate = float(np.mean([each.rate.value for each in replays])) if trials else 0.0
    return (rate, *wilson(rate * trials, trials))


def _asked(motion: Motion, trials: int, conditions: Conditions) -> list[Trial]:
    return [Trial(motion, trial, conditions) for trial in range(trials)]


def _parts(values: np.ndarray, done: np.ndarray) -> tuple[Part, ...]:
    """Divide trials by a variation's values (N,) into equal parts; equal values stay together."""
    order = np.argsort(values, kind="stable")
    cuts = [values[part[-1]] for part in np.array_split(order, PARTS) if len(part)]
    found, below = [], -np.inf
    for cut in dict.fromkeys(float(each) for each in cuts):
        inside = (values > below) & (values <= cut)
        rate = rate_of(int(done[inside].sum()), int(inside.sum()))
        found.append(Part(float(values[inside].min()), float(values[inside].max()), rate))
        below = cut
    return tuple(found)
