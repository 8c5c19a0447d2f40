"""The command ``studio evaluate``."""

import contextlib
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, get_args

import tyro

from studio.console import as_json_text, log, only_ours_on_stdout
from studio.engine.demonstration import DemonstrationSet
from studio.engine.errors import FileError, NothingTaughtError, StudioError
from studio.engine.evaluate.evaluation import evaluate
from studio.engine.evaluate.found import Found, shown_evaluation, shown_grid
from studio.engine.evaluate.grid import (
    COUNTS,
    LEARNERS,
    TRIALS,
    checked_networks,
    evaluate_grid,
    networks,
    replays_of,
)
from studio.engine.evaluate.journal import Journal, header_of
from studio.engine.evaluate.motion import Motion
from studio.engine.evaluate.runs import Conditions, checked_count
from studio.engine.evaluate.subject import (
    Subject,
    is_model,
    subject_of_lesson,
    subject_of_model,
)
from studio.engine.evaluate.variation import Variations
from studio.engine.experiment import Setup, teach, why_nothing
from studio.engine.export.material import Material
from studio.engine.export.session_reader import is_session, open_session
from studio.engine.parallel import has_joblib, most_jobs
from studio.engine.resources import samples_folder
from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene
from studio.engine.sweep import checked_neurons
from studio.engine.teaching import LEARNERS as LEARNERS_ALONE
from studio.engine.teaching import LearnerSettings, learn
from studio.progress_bar import ProgressBar
from studio.scene_option import taught_scene

Models = Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="MODEL")]
VariationName = Literal["block", "friction", "mass", "start", "noise", "latency"]
MANY = 1000  # trials of one motion
FEWER = 200  # of each demonstration beside it
_USUAL = Variations()
EVERY_VARIATION: tuple[VariationName, ...] = get_args(VariationName)


@dataclass(frozen=True)
class Evaluate:
    """Let Baxter do the task many times under varied conditions, and say how often it does it."""

    model: Models = ()
    """An exported model (JSON), a session (zip), or recordings to learn from; the shipped samples
    by default."""
    scene: str | None = None
    """The scene: the name of one that ships, or a TOML file; by default that of the session, or of
    the first recording. A model's file knows none: push-down, unless this says another."""
    trials: int | None = None
    """Trials of the model, 1000 by default; of each of several networks 100."""
    replays: int = FEWER
    """Of these, the first so many are also done by each demonstration's own replay."""
    seed: int = 0
    """Trial i of a seed is always the same, whoever does it."""
    demonstrations: tuple[Path, ...] = ()
    """Recordings whose own replays stand beside a model's file."""
    neurons: tuple[int, ...] = ()
    """Of recordings: 50 by default. With several, or several learners: the picture of how many the
    task needs, by default from 1 to 150."""
    learner: tuple[str, ...] = ()
    """Of recordings: rbf by default, newrb, field. For the picture also gcv and ols."""
    only: tuple[VariationName, ...] = EVERY_VARIATION
    """Vary these alone."""
    block: float = 100 * _USUAL.block
    """Blocks stand up to so many cm off, in x and in y. Of this and all that follows, 0 is off."""
    friction: float = 100 * _USUAL.friction
    """Their friction is up to so many percent off."""
    mass: float = 100 * _USUAL.mass
    """Their mass is up to so many percent off."""
    start: float = _USUAL.start
    """Each joint waits up to so many degrees off."""
    noise: float = _USUAL.noise
    """Each joint misses what it is told by so many degrees (standard deviation)."""
    latency: int = _USUAL.latency
    """Commands are up to so many ticks of 1/30 s late."""
    arm: Literal["left", "right", "both"] = "left"
    """The arm that was taught, or both; a scene that takes both says so itself."""
    mapping: Literal["exact", "paper"] = "exact"
    """The mapping that it was taught with."""
    gate: Literal["sequence", "open"] = "sequence"
    """Of skeleton files: sequence, or open to follow whoever is in sight."""
    mirror: bool = False
    """It was taught as in a mirror."""
    jobs: int | None = None
    """Trials at once; as many as there are processors, where joblib is installed."""
    out: Path | None = None
    """Folder for results, tables, page and picture. What is broken off goes on there."""
    json: bool = False
    """Print one JSON object."""

    def run(self) -> int:
        """Do the trials, print, and write."""
        with only_ours_on_stdout():
            found = self._found()
            text = as_json_text(found.json)
            if self.out is not None:
                _write(self.out, found, text)
        print(text if self.json else found.text)
        return 0

    def _found(self) -> Found:
        self._check()
        variations = Variations(
            block=self.block / 100,
            friction=self.friction / 100,
            mass=self.mass / 100,
            start=self.start,
            noise=self.noise,
            latency=self.latency,
        )
        variations = variations.only(self.only)
        session = self._session()
        conditions = Conditions(self._scene(session), variations, self.seed)
        jobs = most_jobs() if self.jobs is None else self.jobs
        if not has_joblib():
            log("one trial at a time; several at once need pip install 'teaching-studio[compare]'")
        if self._is_grid():
            return self._many(conditions, jobs)
        subject = self._subject(conditions.scene, session)
        trials = MANY if self.trials is None else self.trials
        replayed = min(self.replays, trials) if subject.replays else 0
        motions = (subject.motion, *subject.replays)
        with self._journal(motions, conditions) as journal, ProgressBar() as bar:
            found = evaluate(
                subject.motion, subject.replays, conditions, trials, replayed, jobs, journal, bar
            )
        return shown_evaluation(found)

    def _check(self) -> None:
        """Raise StudioError for what is wrong whatever the files hold."""
        if self.trials is not None:
            checked_count("trials", self.trials)
        checked_count("replays", self.replays, least=0)
        if not self.only:
            raise StudioError(f"--only: one variation or more of {', '.join(EVERY_VARIATION)}")
        if self.neurons:
            checked_neurons(self.neurons)
        if self._is_grid():
            checked_networks(self.learner)
        else:
            self._settings()

    def _is_grid(self) -> bool:
        """Tell whether several networks are asked for."""
        return len(self.neurons) > 1 or len(self.learner) > 1

    def _session(self) -> Material | None:
        """Return what the given session holds; None where something else is given."""
        if not any(is_session(path) for path in self.model):
            return None
        if len(self.model) > 1 or self.demonstrations:
            raise StudioError("one session at a time, and no recordings beside it")
        log(f"opening {self.model[0]}")
        return open_session(self.model[0])

    def _scene(self, session: Material | None) -> Scene:
        """Return the scene for the arms that were taught."""
        if session is not None:
            taught = session.taught
            scene = taught.scene if self.scene is None else read_scene(self.scene)
            return scene.taught_by(taught.arms)
        scene = taught_scene(self.scene, (*self.model, *self.demonstrations))
        told = self.scene is not None or self.demonstrations
        if not told and any(is_model(path) for path in self.model):
            log(
                f"a model's file does not know its scene: judged in {scene.name}; --scene says "
                "another"
            )
        return scene.taught_by(self._setup(scene).arms)

    def _many(self, conditions: Conditions, jobs: int) -> Found:
        """Evaluate every network that recordings teach."""
        if self.demonstrations or any(is_model(path) or is_session(path) for path in self.model):
            raise StudioError("several networks are taught from recordings: give recordings alone")
        taught = self._taught(self.model, conditions.scene)
        log("learning")
        learners = self.learner or LEARNERS
        shown = networks(taught, conditions.scene, learners, self.neurons or COUNTS, jobs)
        replays = replays_of(taught, conditions.scene)
        motions = (*(network.motion for network in shown), *replays)
        trials = TRIALS if self.trials is None else self.trials
        with self._journal(motions, conditions) as journal, ProgressBar() as bar:
            grid = evaluate_grid(shown, replays, conditions, trials, jobs, journal, bar)
        return shown_grid(grid)

    def _subject(self, scene: Scene, session: Material | None) -> Subject:
        """Return the one motion that is evaluated."""
        if session is not None:
            lesson = session.lesson
            if lesson is None or self.neurons or self.learner:
                lesson = learn(session.taught, self._settings())
            return subject_of_lesson(lesson, scene)
        first = next((path for path in self.model if is_model(path)), None)
        if first is None:
            if self.demonstrations:
                raise StudioError("--demonstrations stand beside a model's file, not recordings")
            lesson = learn(self._taught(self.model, scene), self._settings())
            return subject_of_lesson(lesson, scene)
        if len(self.model) > 1:
            raise StudioError("one model at a time; recordings beside it by --demonstrations")
        if self.neurons or self.learner:
            raise StudioError(
                f"{first} was learned already: --neurons and --learner are for others"
            )
        taught = self._taught(self.demonstrations, scene) if self.demonstrations else None
        if taught is None:
            log("--demonstrations FILE... would show their own replays beside it")
        return subject_of_model(first, scene.arms, self.mapping, scene, taught)

    def _settings(self) -> LearnerSettings:
        usual = LearnerSettings()
        name = self.learner[0] if self.learner else usual.name
        if name not in LEARNERS_ALONE:
            raise StudioError(f"--learner: one of {', '.join(LEARNERS_ALONE)}, or several")
        known = next(each for each in LEARNERS_ALONE if each == name)
        return LearnerSettings(known, self.neurons[0] if self.neurons else usual.neurons)

    def _setup(self, scene: Scene) -> Setup:
        """Return how it was taught, with the arms and the hands that the scene takes."""
        return Setup(self.arm, self.mapping, self.gate, mirrored=self.mirror).in_scene(scene)

    def _taught(self, given: Sequence[Path], scene: Scene) -> DemonstrationSet:
        """Return what files teach; raise NothingTaughtError in words where they teach nothing."""
        paths = given or tuple(sorted(samples_folder().glob("*.mcap")))
        setup = self._setup(scene)
        teachers = teach(paths, setup, progress=log)
        for file in teachers.files:
            if file.warning:
                log(file.warning)
        if not teachers.demonstrations:
            raise NothingTaughtError(why_nothing(teachers.files))
        return DemonstrationSet.of(teachers.demonstrations, setup.interpolation, setup.seed)

    @contextlib.contextmanager
    def _journal(
        self, motions: Sequence[Motion], conditions: Conditions
    ) -> Iterator[Journal | None]:
        """Yield where trials are kept; None where no folder is given."""
        if self.out is None:
            log("not resumable: --out FOLDER would keep each trial, and go on after a break")
            yield None
            return
        header = header_of(motions, conditions.scene, conditions.widths, conditions.seed)
        with Journal(self.out, header, time.monotonic) as journal:
            if journal.known:
                log(f"{self.out}: going on after {len(journal.known)} trials")
            yield journal


def _write(folder: Path, found: Found, text: str) -> None:
    """Write what was found beside the trials; raise FileError where that is impossible."""
    contents = {
        "evaluation.json": text + "\n",
        "evaluation.md": found.tables,
        "evaluation.html": found.page,
    }
    if found.picture:
        contents["evaluation.svg"] = found.picture
    for name, content in contents.items():
        path = folder / name
        try:
            path.write_text(content, "utf-8")
        except OSError as error:
            raise FileError(f"{path}: cannot be written: {error.strerror}") from error
        log(f"wrote {path}")
