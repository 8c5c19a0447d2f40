"""How many neurons does the *task* need? Success against numbers of neurons, learner by learner.

Every network meets the same trials as all others and as each demonstration's own replay. The
answer is the smallest number of neurons that ever do the task and whose 95 % interval reaches the
demonstrations' own rate: fewer are worse, beyond what chance explains.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from studio.engine.demonstration import DemonstrationSet
from studio.engine.errors import StudioError
from studio.engine.evaluate.evaluation import Tested, pooled, tested_of
from studio.engine.evaluate.journal import Journal
from studio.engine.evaluate.motion import Motion, motion_of, replay_of
from studio.engine.evaluate.runs import Conditions, Progress, Trial, checked_count, run_trials
from studio.engine.hands import HandTrack
from studio.engine.learned_hands import learned_hands
from studio.engine.learners import LEARNER_KINDS, kind_of, require
from studio.engine.parallel import run_all
from studio.engine.scene import Scene
from studio.engine.sweep import INPUTS, checked_neurons, stacked
from studio.engine.teaching import INDEX_TIME, model_as_trajectory
from studio.rbf import mean_squared_error, pooled_variance_floor

COUNTS = (1, 2, 3, 4, 5, 7, 10, 15, 20, 30, 50, 75, 100, 150)  # about even on a logarithmic scale
LEARNERS = ("rbf", "newrb", "gcv")
TRIALS = 100  # a cell


@dataclass(frozen=True, eq=False)
class Network:
    """A learner with a number of neurons, and the motion that it learned."""

    learner: str
    neurons: int
    floor_ratio: float | None  # its mean square error over the floor; None where there is none
    motion: Motion


@dataclass(frozen=True, eq=False)
class Cell:
    """A network, and what became of it."""

    network: Network
    tested: Tested


@dataclass(frozen=True, eq=False)
class Grid:
    """See the module."""

    conditions: Conditions
    cells: tuple[Cell, ...]  # by learner, then by neurons
    replays: tuple[Tested, ...]

    @property
    def learners(self) -> tuple[str, ...]:
        """The learners in their order."""
        return tuple(dict.fromkeys(cell.network.learner for cell in self.cells))

    def of(self, learner: str) -> tuple[Cell, ...]:
        """Return one learner's cells, by rising neurons."""
        return tuple(cell for cell in self.cells if cell.network.learner == learner)

    def needed(self, learner: str) -> Cell | None:
        """Return the cell with the fewest neurons that are enough; None where none is.

        None, too, where no replay does the task: any network would be enough.
        """
        rate, _, _ = pooled(self.replays)
        if rate == 0.0:
            return None
        return next((cell for cell in self.of(learner) if _reaches(cell, rate)), None)

    def answer(self, learner: str) -> str:
        """Return in words how many neurons the task needs."""
        found, cells = self.needed(learner), self.of(learner)
        rate, _, _ = pooled(self.replays)
        if rate == 0.0:
            return "no demonstration's own replay does the task, so there is nothing to reach"
        if found is None:
            most = cells[-1].network.neurons
            return (
                f"up to {most} neurons are not enough: none reaches the demonstrations' own "
                f"{100 * rate:.3g} %"
            )
        count = found.network.neurons
        reached = found.tested.rate
        if reached.value < rate:  # so that its interval alone reaches it
            shown = f"{'s are' if count > 1 else ' is'} not shown to do worse with "
            shown += f"{reached.trials} trials"
        else:
            shown = f"{'s do' if count > 1 else ' does'} the task"
        words = (
            f"{count} neuron{shown}: {reached.words}, beside the demonstrations' own "
            f"{100 * rate:.3g} %"
        )
        ratio = found.network.floor_ratio
        if ratio is not None:
            words += f"; the error is then {ratio:.3g} times its floor"
        worse = [
            str(cell.network.neurons)
            for cell in cells
            if cell.network.neurons > count and not _reaches(cell, rate)
        ]
        return f"{words}; {', '.join(worse)} do worse again" if worse else words


def _reaches(cell: Cell, rate: float) -> bool:
    """Tell whether a network did the task at all, and may do it as often as ``rate``."""
    return cell.tested.rate.successes > 0 and cell.tested.rate.high >= rate


def networks(
    taught: DemonstrationSet,
    scene: Scene,
    learners: Sequence[str] = LEARNERS,
    neurons: Sequence[int] = COUNTS,
    jobs: int | None = None,
) -> tuple[Network, ...]:
    """Teach every network.

    Raises
    ------
    StudioError
        Where a learner is unknown or has no neurons, or a number of neurons is impossible.
    """
    counts, names = checked_neurons(neurons), checked_networks(learners)
    tasks = [(name, count, taught, scene) for name in names for count in counts]
    return tuple(run_all(_network, tasks, jobs))


def checked_networks(learners: Sequence[str]) -> tuple[str, ...]:
    """Return learners, each once; raise StudioError where one is unknown or has no neurons."""
    names = tuple(dict.fromkeys(learners))
    for name in names:
        kind = kind_of(name)
        if not kind.network:
            able = ", ".join(key for key, each in LEARNER_KINDS.items() if each.network)
            raise StudioError(f"{name} has no neurons to count; choose of {able}")
        require(kind)
    return names


def replays_of(taught: DemonstrationSet, scene: Scene) -> tuple[Motion, ...]:
    """Return each demonstration's own replay."""
    return tuple(
        replay_of(f"demonstration {number}", demonstration, rows, scene)
        for number, (demonstration, rows) in enumerate(
            zip(taught.demonstrations, taught.rows, strict=True), start=1
        )
    )


def evaluate_grid(
    shown: Sequence[Network],
    replays: Sequence[Motion],
    conditions: Conditions,
    trials: int = TRIALS,
    jobs: int | None = None,
    journal: Journal | None = None,
    progress: Progress = lambda _over, _all: None,
) -> Grid:
    """Do the motion of every network, and every replay, ``trials`` times under varied conditions.

    Raises
    ------
    StudioError
        Where a number of trials is impossible, or there is no replay to compare with.
    FileError
        Where the journal cannot be written.
    """
    checked_count("trials", trials)
    if not replays:
        raise StudioError("numbers of neurons are judged beside demonstrations: give recordings")
    motions = [*(network.motion for network in shown), *replays]
    asked = [Trial(motion, trial, conditions) for trial in range(trials) for motion in motions]
    found = run_trials(asked, jobs, journal, progress)
    cells = tuple(Cell(each, tested_of(each.motion, trials, found)) for each in shown)
    return Grid(conditions, cells, tuple(tested_of(each, trials, found) for each in replays))


def _network(task: tuple[str, int, DemonstrationSet, Scene]) -> Network:
    name, neurons, taught, scene = task
    model = kind_of(name).model({"neurons": neurons}).fit(*stacked(taught.rows))
    motion = motion_of(
        f"{name} {neurons}",
        model_as_trajectory(model, taught.duration),
        taught.duration,
        taught.arms,
        taught.mapping,
        _hands(name, neurons, taught),
        scene,
    )
    floor = pooled_variance_floor(taught.rows).value
    curve = np.broadcast_to(model.predict(INPUTS), taught.rows.shape)
    width = taught.rows.shape[-1]
    mse = mean_squared_error(taught.rows.reshape(-1, width), curve.reshape(-1, width))
    ratio = None if floor is None or not floor.any() else float(mse.sum() / floor.sum())
    return Network(name, neurons, ratio, motion)


def _hands(name: str, neurons: int, taught: DemonstrationSet) -> HandTrack | None:
    """Return what the hands do, learned by a network of the same size; a field knows no time."""
    grip = kind_of("rbf" if name == "field" else name)
    return learned_hands(taught, grip.model({"neurons": neurons}), INDEX_TIME)
