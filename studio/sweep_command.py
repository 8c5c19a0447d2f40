"""The command ``studio sweep``."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro

from studio.console import as_json_text, log, only_ours_on_stdout
from studio.engine.comparison import Contestant, compare
from studio.engine.demonstration import DemonstrationSet
from studio.engine.errors import FileError, NothingTaughtError, StudioError
from studio.engine.experiment import Setup, teach, why_nothing
from studio.engine.learners import LEARNER_KINDS, kind_of, require
from studio.engine.resources import samples_folder
from studio.engine.sweep import DEFAULT_LEARNERS, PAPER_NEURONS, checked_neurons, sweep
from studio.engine.sweep import Sweep as SweepTable
from studio.engine.sweep_page import sweep_page
from studio.engine.sweep_report import sweep_as_json, sweep_as_text
from studio.scene_option import TaughtSceneFlag, taught_scene

Recordings = Annotated[
    tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="RECORDING...")
]


@dataclass(frozen=True)
class Sweep:
    """Make the paper's Table I for your own demonstrations, and compare learners."""

    recordings: Recordings = ()
    """Recordings (MCAP) or skeleton files to learn from; the shipped samples by default."""
    neurons: tuple[int, ...] = PAPER_NEURONS
    """Numbers of neurons; the paper's by default."""
    learner: tuple[str, ...] = DEFAULT_LEARNERS
    """newrb, rbf, gcv, ols and field are networks, a table row for each number of neurons (field:
    of Gaussians in each of two maps; it keeps no time, and takes long). spline, gp, kernel-ridge,
    mlp, gmr, dmp, promp have none: with one of them, or with all, every learner named is tuned by
    leaving out one demonstration at a time, and compared."""
    arm: Literal["left", "right", "both"] = "left"
    """The arm that was taught, or both."""
    mirror: bool = False
    """It was taught as in a mirror."""
    mapping: Literal["exact", "paper"] = "exact"
    """The mapping that it was taught with."""
    gate: Literal["sequence", "open"] = "sequence"
    """Of skeleton files: sequence, or open to follow whoever is in sight."""
    interpolation: Literal["even", "random"] = "even"
    """How demonstrations are resampled to 142: at even stamps, or at random ones (the paper)."""
    scene: TaughtSceneFlag = None
    jobs: int = 1
    """Fits at once. Times are then less comparable."""
    html: Path | None = None
    """File to write a report to: one page that needs no network."""
    json: bool = False
    """Print one JSON object."""

    def run(self) -> int:
        """Measure, print, and write the page."""
        networks, compared = self._learners()
        checked_neurons(self.neurons)
        given = self.recordings or tuple(sorted(samples_folder().glob("*.mcap")))
        setup = Setup(
            self.arm,
            self.mapping,
            self.gate,
            interpolation=self.interpolation,
            mirrored=self.mirror,
        ).in_scene(taught_scene(self.scene, given))
        with only_ours_on_stdout():
            taught = _taught(given, setup)
            log(f"fitting {', '.join(networks)}")
            table = sweep(taught, time.perf_counter, networks, self.neurons, self.jobs)
            contestants: tuple[Contestant, ...] = ()
            if compared:
                log(f"tuning and comparing {', '.join(compared)}")
                contestants = compare(taught, time.perf_counter, compared, self.jobs)
            if self.html is not None:
                self._write_page(table, contestants)
        found = sweep_as_json(table, contestants) if self.json else None
        print(sweep_as_text(table, contestants) if found is None else as_json_text(found))
        return 0

    def _learners(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the networks for the table, and the learners to compare, if any."""
        if not self.learner:
            raise StudioError(f"--learner: one or more of {', '.join(LEARNER_KINDS)}, or all")
        if "all" in self.learner:
            compared = tuple(LEARNER_KINDS)
            networks = tuple(name for name in self.learner if name != "all")
        else:
            networks = self.learner
            compared = () if all(kind_of(name).network for name in networks) else self.learner
        for name in compared:
            require(kind_of(name))
        return tuple(n for n in networks if kind_of(n).network) or DEFAULT_LEARNERS, compared

    def _write_page(self, table: SweepTable, contestants: Sequence[Contestant]) -> None:
        if self.html is None:
            return
        try:
            self.html.write_text(sweep_page(table, contestants), "utf-8")
        except OSError as error:
            raise FileError(f"{self.html}: cannot be written: {error.strerror}") from error
        log(f"wrote {self.html}")


def _taught(inputs: Sequence[Path], setup: Setup) -> DemonstrationSet:
    """Return what these files teach; raise NothingTaughtError in words where they teach nothing."""
    teachers = teach(inputs, setup, progress=log)
    for file in teachers.files:
        if file.warning:
            log(file.warning)
    if not teachers.demonstrations:
        raise NothingTaughtError(why_nothing(teachers.files))
    return DemonstrationSet.of(teachers.demonstrations, setup.interpolation, setup.seed)
