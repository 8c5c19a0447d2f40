"""Many learners on the same demonstrations: the paper's own further work.

Every learner gets the same number of settings to try, each judged by leaving out one demonstration
at a time; the best of them is then measured, and played by Baxter. The held-out error that is
reported is the one that chose the setting, so it flatters all of them alike.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from studio.engine.demonstration import DemonstrationSet
from studio.engine.errors import StudioError
from studio.engine.learners import BUDGET, LEARNER_KINDS, LearnerKind, Settings, kind_of, require
from studio.engine.parallel import run_all
from studio.engine.skeleton import FloatArray
from studio.engine.sweep import Played, Quality, Timer, measure, play
from studio.rbf import leave_one_demonstration_out


@dataclass(frozen=True, eq=False)
class Contestant:
    """One learner at its best setting."""

    kind: LearnerKind
    settings: Settings  # the best of those tried
    failed: int  # settings that gave no answer at all
    quality: Quality
    played: Played


def compare(
    taught: DemonstrationSet,
    timer: Timer,
    learners: Sequence[str] = (),
    jobs: int | None = None,
) -> tuple[Contestant, ...]:
    """Tune every learner by leave-one-demonstration-out with the same budget, then measure it.

    Parameters
    ----------
    taught : two demonstrations or more
    timer : clock to time fits by
    learners : names, see `studio.engine.learners`; none means all of them
    jobs : how many fits at once, see `studio.engine.parallel`

    Raises
    ------
    StudioError
        Where a learner is unknown or its package is not installed, nothing can be left out, or a
        learner answers with none of its settings.

    """
    if len(taught.rows) < 2:
        raise StudioError("comparing learners leaves out one demonstration: give two or more")
    chosen = [kind_of(name) for name in dict.fromkeys(learners or LEARNER_KINDS)]
    for kind in chosen:
        require(kind)
    trials = [(kind.name, place, taught.rows) for kind in chosen for place in range(BUDGET)]
    errors = np.reshape(run_all(_held_out, trials, jobs), (len(chosen), BUDGET))
    for kind, own in zip(chosen, errors, strict=True):
        if not np.isfinite(own).any():
            raise StudioError(f"the learner {kind.name} can make nothing of these demonstrations")
    best = [kind.settings[int(np.argmin(own))] for kind, own in zip(chosen, errors, strict=True)]
    tasks = [(kind.name, settings, taught) for kind, settings in zip(chosen, best, strict=True)]
    # One after the other, so that no fit is timed while another one runs beside it.
    measured = [
        measure(kind, settings, taught.rows, timer)
        for kind, settings in zip(chosen, best, strict=True)
    ]
    played = run_all(play, tasks, jobs)
    failed = np.count_nonzero(~np.isfinite(errors), axis=1).tolist()
    return tuple(
        Contestant(*each) for each in zip(chosen, best, failed, measured, played, strict=True)
    )


def _held_out(trial: tuple[str, int, FloatArray]) -> float:
    """Return the mean held-out error of one setting; infinite where it gives no answer."""
    name, place, rows = trial
    kind = kind_of(name)
    try:
        error = float(
            leave_one_demonstration_out(kind.model(kind.settings[place]), rows).mse.mean()
        )
    except (ValueError, ArithmeticError):  # numpy's LinAlgError is a ValueError
        return float("inf")
    return error if np.isfinite(error) else float("inf")
