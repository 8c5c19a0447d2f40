"""Table I for one's own demonstrations: what each learner makes of them, by numbers of neurons.

Errors are those of the paper's table, and what it leaves out: the floor that no network can
undercut, the error on a demonstration that was not seen, the largest error (its Eq. 12), what
happens between the samples, and time. Demonstrations are left out whole, never by frames.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from studio.engine.demonstration import DemonstrationSet
from studio.engine.errors import StudioError
from studio.engine.learners import LearnerKind, Settings, kind_of, require
from studio.engine.measures import Deviation, deviation
from studio.engine.parallel import run_all
from studio.engine.performance import Performance, perform
from studio.engine.skeleton import FloatArray
from studio.engine.task_words import BLOCK, TaskWords, task_words
from studio.engine.teaching import INDEX_TIME, MOST_NEURONS, model_as_trajectory, remark_of
from studio.rbf import (
    Suggestion,
    largest_error,
    leave_one_demonstration_out,
    mean_squared_error,
    pooled_variance_floor,
    smoothness,
    suggest_from,
)

PAPER_NEURONS = (50, 100, 150, 200, 250, 300)  # of Table I
DEFAULT_LEARNERS = ("newrb", "rbf", "gcv")
TIMINGS = 3  # the quickest of so many counts: what is slower, another program held up
INPUTS = INDEX_TIME[:, np.newaxis]
Timer = Callable[[], float]  # seconds, rising; `time.perf_counter`


@dataclass(frozen=True, eq=False)
class Quality:
    """How good one learner with one setting is on a set of demonstrations."""

    curve: FloatArray  # (142, D) [rad], its output at the demonstrations' stamps
    mse: FloatArray  # (D,) [rad²], over all demonstrations
    largest: FloatArray  # (D,) [rad], the ε* of Eq. 12
    floor_ratio: float | None  # mean MSE over mean floor; None where there is no floor
    held_out: float | None  # [rad²], mean over joints; None for a single demonstration
    held_out_ratio: float | None  # over that of the other demonstrations' mean curve
    acceleration_ratio: float  # RMS acceleration between the samples over a smoothing spline's
    ripple: float  # [rad], largest distance from that spline
    fit_seconds: float
    predict_seconds: float  # for all 142 stamps


@dataclass(frozen=True, eq=False)
class Row:
    """One row of the table."""

    learner: str
    neurons: int
    quality: Quality


@dataclass(frozen=True, eq=False)
class Played:
    """What Baxter does alone by one learner's motion."""

    performance: Performance
    deviation: Deviation  # from the mean demonstration as sent
    remark: str = ""  # what the learner says of itself
    task: TaskWords = BLOCK  # how one says whether it was done


@dataclass(frozen=True, eq=False)
class Sweep:
    """The table, and for each learner the number of neurons to take."""

    taught: DemonstrationSet
    floor: FloatArray | None  # (D,) [rad²]
    floor_note: str  # why there is none, or nothing
    rows: tuple[Row, ...]  # by learner, then by neurons
    suggestions: dict[str, Suggestion]  # by learner; empty for a single demonstration
    played: dict[str, Played]  # by learner, with the suggested neurons or else the most

    def of(self, learner: str) -> tuple[Row, ...]:
        """Return one learner's rows."""
        return tuple(row for row in self.rows if row.learner == learner)

    @property
    def learners(self) -> tuple[str, ...]:
        """The learners in their order."""
        return tuple(dict.fromkeys(row.learner for row in self.rows))

    def shown_row(self, learner: str) -> Row:
        """Return the row that Baxter played."""
        rows = self.of(learner)
        if learner not in self.suggestions:
            return rows[-1]
        return next(row for row in rows if row.neurons == self.suggestions[learner].neurons)


def sweep(
    taught: DemonstrationSet,
    timer: Timer,
    learners: Sequence[str] = DEFAULT_LEARNERS,
    neurons: Sequence[int] = PAPER_NEURONS,
    jobs: int | None = None,
) -> Sweep:
    """Fit every network with every number of neurons.

    Parameters
    ----------
    taught : DemonstrationSet
    timer : clock to time fits by; the engine reads none itself
    learners : names of networks, see `studio.engine.learners`
    neurons : numbers of neurons
    jobs : how many fits at once, see `studio.engine.parallel`

    Raises
    ------
    StudioError
        Where a learner is unknown or has no neurons, or a number of neurons is impossible.

    """
    chosen = [_network(name) for name in dict.fromkeys(learners)]
    counts = checked_neurons(neurons)
    tasks = [
        (kind.name, {"neurons": count}, taught.rows, timer) for kind in chosen for count in counts
    ]
    measured = run_all(_quality_of, tasks, jobs)
    rows = tuple(
        Row(name, settings["neurons"], quality)
        for (name, settings, _, _), quality in zip(tasks, measured, strict=True)
    )
    floor = pooled_variance_floor(taught.rows)
    suggestions = {kind.name: _suggestion(rows, kind.name) for kind in chosen}
    found = {name: each for name, each in suggestions.items() if each is not None}
    table = Sweep(taught, floor.value, floor.reason, rows, found, {})
    plays = [(name, {"neurons": table.shown_row(name).neurons}, taught) for name in table.learners]
    played = run_all(play, plays, jobs)
    return replace(table, played=dict(zip(table.learners, played, strict=True)))


def checked_neurons(neurons: Sequence[int]) -> tuple[int, ...]:
    """Return numbers of neurons rising, each once; raise StudioError where one is impossible."""
    for count in neurons:
        if not 1 <= count <= MOST_NEURONS:
            raise StudioError(f"neurons: 1 to {MOST_NEURONS}, not {count}")
    if not neurons:
        raise StudioError("neurons: give at least one number")
    return tuple(sorted(set(neurons)))


def measure(kind: LearnerKind, settings: Settings, rows: FloatArray, timer: Timer) -> Quality:
    """Return how good a learner is on demonstrations (K, 142, D) [rad]."""
    inputs, targets = stacked(rows)
    model, fit_seconds = _timed(lambda: kind.model(settings).fit(inputs, targets), timer)
    curve, predict_seconds = _timed(lambda: model.predict(INPUTS), timer)
    floor = pooled_variance_floor(rows).value
    repeated = np.broadcast_to(curve, rows.shape).reshape(targets.shape)
    mse = mean_squared_error(targets, repeated)
    between = smoothness(model.predict, rows)
    held_out = None
    if len(rows) > 1:
        held_out = leave_one_demonstration_out(kind.model(settings), rows)
    return Quality(
        curve=curve,
        mse=mse,
        largest=largest_error(targets, repeated),
        floor_ratio=None if floor is None or not floor.any() else float(mse.sum() / floor.sum()),
        held_out=None if held_out is None else float(held_out.mse.mean()),
        held_out_ratio=None if held_out is None else held_out.ratio,
        acceleration_ratio=between.ratio,
        ripple=float(between.deviation.max()),
        fit_seconds=fit_seconds,
        predict_seconds=predict_seconds,
    )


def play(task: tuple[str, Settings, DemonstrationSet]) -> Played:
    """Teach a learner by name with some settings, and let Baxter do its motion alone."""
    name, settings, taught = task
    model = kind_of(name).model(settings).fit(*stacked(taught.rows))
    trajectory = model_as_trajectory(model, taught.duration)
    performance = perform(
        trajectory, taught.duration, taught.arms, taught.mapping, taught.hands, taught.scene
    )
    error = deviation(performance, taught.mean, taught.joints, taught.hands)
    return Played(performance, error, remark_of(model), task_words(taught.scene))


def stacked(rows: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return demonstrations (K, T, D) as inputs (K T, 1), index time, and outputs (K T, D)."""
    count, _, joints = rows.shape
    return np.tile(INPUTS, (count, 1)), rows.reshape(-1, joints)


def _quality_of(task: tuple[str, Settings, FloatArray, Timer]) -> Quality:
    name, settings, rows, timer = task
    return measure(kind_of(name), settings, rows, timer)


def _timed(call: Callable[[], Any], timer: Timer) -> tuple[Any, float]:
    """Return what a call returns, and the seconds of the quickest of `TIMINGS` calls."""
    seconds = []
    for _ in range(TIMINGS):
        start = timer()
        result = call()
        seconds.append(timer() - start)
    return result, min(seconds)


def _network(name: str) -> LearnerKind:
    kind = kind_of(name)
    if not kind.network:
        raise StudioError(f"{name} has no neurons to sweep over; compare it by --learner all")
    require(kind)
    return kind


def _suggestion(rows: Sequence[Row], learner: str) -> Suggestion | None:
    own = [row for row in rows if row.learner == learner]
    held_out = [row.quality.held_out for row in own]
    errors = [error for error in held_out if error is not None]
    if not errors:
        return None
    ratios = [row.quality.floor_ratio for row in own]
    known = [ratio for ratio in ratios if ratio is not None]
    floor_ratios = known if len(known) == len(own) else None
    return suggest_from([row.neurons for row in own], floor_ratios, errors)
