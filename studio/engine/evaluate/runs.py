"""Many trials of several motions: side by side, kept as they end, and the same in any order."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from studio.engine.arms import driven_joints
from studio.engine.errors import StudioError
from studio.engine.evaluate.journal import Journal, Key
from studio.engine.evaluate.motion import Motion
from studio.engine.evaluate.trial import Outcome, run_trial
from studio.engine.evaluate.variation import Variation, Variations, draw
from studio.engine.parallel import run_each
from studio.engine.scene import Scene

MOST_TRIALS = 1_000_000
Progress = Callable[[int, int], None]  # how many trials are over, of how many


@dataclass(frozen=True)
class Conditions:
    """Under what the trials are done.

    Raises
    ------
    StudioError
        Where the seed is negative.
    """

    scene: Scene
    widths: Variations
    seed: int

    def __post_init__(self) -> None:
        if self.seed < 0:
            raise StudioError(f"seed: a whole number from 0, not {self.seed}")

    def variation(self, motion: Motion, trial: int) -> Variation:
        """Return what differs in a trial; the same for all motions of the same arms."""
        joints = len(driven_joints(motion.arms))
        return draw(self.widths, self.seed, trial, joints, self.scene)


@dataclass(frozen=True, eq=False)
class Trial:
    """A trial to be done."""

    motion: Motion
    number: int
    conditions: Conditions

    @property
    def key(self) -> Key:
        """What it is called in a journal."""
        return self.motion.name, self.number

    def run(self) -> Outcome:
        """Do it."""
        conditions = self.conditions
        variation = conditions.variation(self.motion, self.number)
        return run_trial(self.motion, conditions.scene, variation)


def run_trials(
    asked: Sequence[Trial],
    jobs: int | None = None,
    journal: Journal | None = None,
    progress: Progress = lambda _over, _all: None,
) -> dict[Key, Outcome]:
    """Do trials, but for those that a journal knows, and return the outcome of each.

    Parameters
    ----------
    asked : the trials, each once
    jobs : how many at once, see `studio.engine.parallel`
    journal : where they are kept as they end
    progress : hears how far it has come

    """
    known: Mapping[Key, Outcome] = {} if journal is None else journal.known
    found = {trial.key: known[trial.key] for trial in asked if trial.key in known}
    missing = [trial for trial in asked if trial.key not in found]
    progress(len(found), len(asked))
    for trial, outcome in zip(missing, run_each(_run, missing, jobs), strict=True):
        found[trial.key] = outcome
        if journal is not None:
            journal.add(trial.key, outcome)
        progress(len(found), len(asked))
    return found


def checked_count(name: str, count: int, least: int = 1) -> int:
    """Return a number of trials; raise StudioError where it is impossible."""
    if not least <= count <= MOST_TRIALS:
        raise StudioError(f"{name}: {least} to {MOST_TRIALS:,}, not {count}")
    return count


def _run(trial: Trial) -> Outcome:
    return trial.run()
