"""What Baxter has learned and what it made of it alone; what is found out meanwhile, and how.

All that takes long is done at a `Workplace`, one thing at a time. What somebody asks for comes
first; where there is time besides, the equations of what was learned, then the error curve.
"""

from collections.abc import Mapping
from dataclasses import replace

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.commands import LearnCommand
from studio.engine.curves import (
    BlockCurve,
    BlockPoint,
    ErrorCurve,
    ErrorPoint,
    Explaining,
    Training,
    Trial,
    TrialRun,
    block_point_of,
)
from studio.engine.errors import StudioError
from studio.engine.evaluate.tryout import TryoutRun, TryoutStatus
from studio.engine.export.equation import Equation
from studio.engine.export.equations import reproduced_numbers
from studio.engine.findings import Findings
from studio.engine.learning_status import LearningStatus, Underway
from studio.engine.listed import Listed
from studio.engine.measures import deviation
from studio.engine.performance import Performance
from studio.engine.skeleton import FloatArray
from studio.engine.snapshot import Mode
from studio.engine.teaching import LearnerSettings, Lesson, Reproduction
from studio.engine.work import Done, Failed, Report
from studio.engine.worker import Task
from studio.engine.workplace import InTicks, Workplace

_AT_REST = (Mode.IDLE, Mode.PLAYING)
PATIENCE = 15  # ticks without a change before a curve is begun: half a second


class Learning:
    """See the module.

    Parameters
    ----------
    listed
        The demonstrations; they change while it learns.
    work
        Where long work is done; by default in the ticks themselves, and only what is asked for.
    """

    def __init__(self, listed: Listed, work: Workplace | None = None) -> None:
        self.lesson: Lesson | None = None
        self.reproduction: Reproduction | None = None
        self._listed = listed
        self._chosen = LearnerSettings()
        self._work: Workplace = InTicks() if work is None else work
        self._work.warm()
        self._underway: Underway | None = None
        self._guess = False  # that the block falls in the trial that goes on
        self._material: tuple[FloatArray, ...] = ()
        self._unchanged = 0  # ticks since demonstrations or learner changed
        self._findings = Findings()
        self.tryout = TryoutStatus()  # of the newest test
        self._explained: Lesson | None = None  # the lesson whose equations are there, or failed
        self._equations: Mapping[str, Equation] = {}  # of what was learned
        self._explained_done: Reproduction | None = None  # whose equations are in there, too

    def take(self, command: LearnCommand, choices: Choices) -> str:
        """Do what is asked, and return in words what came of it.

        Raises
        ------
        StudioError
            Where it is impossible, nothing was taught, or something else goes on.
        """
        kind = choices.arms, choices.mapping, choices.scene
        match command:
            case commands.ChooseLearner(settings):
                self._choose(settings)
            case commands.Train(settings):
                taught = self._listed.taught(*kind)
                self._ask(Training(taught, settings), f"training {_named(settings)}")
                self._choose(settings)
            case commands.Guess(settings, falls):
                self._try(TrialRun(self._listed.taught(*kind), settings), falls)
            case commands.RevealBlocks(learner):
                taught = self._listed.taught(*kind)
                if missing := self._findings.untried(learner):
                    self._ask(BlockCurve(taught, learner, missing), "letting Baxter try them all")
            case commands.TryOut(trials):
                self._test(trials)
            case commands.ResumeCurve():
                self._findings.give_up(self._chosen.name, "")
            case commands.CancelWork():
                return self.cancel() or "Nothing is being computed."
        return ""

    def tick(self, choices: Choices, mode: Mode) -> str:
        """Let a tick pass, and return in words what has come of long work, if anything.

        What nobody waits for is begun only where ``mode`` says that nobody teaches.

        Raises
        ------
        StudioError
            Where what somebody waited for came to nothing.
        """
        canceled = self._notice(self._shown(choices))
        report = self._work.poll()
        words = "" if report is None else self._hear(report)
        if mode in _AT_REST and self._work.has_time and self._work.task is None:
            self._use_the_time(choices)
        self._explain_what_was_done()
        return words or canceled

    def cancel(self) -> str:
        """Give up what somebody waits for, or else the curve, and return in words which."""
        if self._underway is not None:
            words = self._underway.words
            self._work.cancel()
            self._underway, self.tryout = None, replace(self.tryout, goes_on=False)
            return f"Canceled: {words}."
        if isinstance(self._work.task, ErrorCurve):
            self._work.cancel()
            self._findings.give_up(self._chosen.name, "stopped")
        return ""

    def forget(self) -> None:
        """Forget all: the joints that are learned have changed."""
        self.cancel()
        self.lesson = self.reproduction = self._explained = self._explained_done = None
        self._equations = {}

    def judge(self, lesson: Lesson, performance: Performance) -> None:
        """Keep what Baxter has made of a lesson, if nothing newer was learned meanwhile."""
        if lesson is self.lesson:
            taught = lesson.taught
            error = deviation(performance, taught.mean, taught.joints, lesson.hands)
            self.reproduction = Reproduction(performance, error)

    def close(self) -> None:
        """End what is being computed."""
        self._work.close()

    def mode(self, mode: Mode) -> Mode:
        """Return what the session is doing, for the state pill: training, if nothing else."""
        waits = self._underway is not None and not self.tryout.goes_on
        return Mode.TRAINING if mode is Mode.IDLE and waits else mode

    @property
    def status(self) -> LearningStatus:
        """What a page shows."""
        return LearningStatus(
            chosen=self._chosen,
            underway=self._underway,
            curve=self._findings.curve(self._chosen.name),
            is_drawing=isinstance(self._work.task, ErrorCurve),
            tried=self._findings.tried,
            equations=self._equations,
        )

    def _explain_what_was_done(self) -> None:
        """Add the equations of what Baxter did alone to those of what was learned."""
        lesson, done = self.lesson, self.reproduction
        if lesson is None or done is self._explained_done or not self._equations:
            return
        self._explained_done = done
        if done is not None:
            self._equations = {**self._equations, **reproduced_numbers(lesson, done)}

    def _choose(self, settings: LearnerSettings) -> None:
        if settings.name != self._chosen.name:
            self._unchanged = 0
            if isinstance(self._work.task, ErrorCurve):
                self._work.cancel()
        self._chosen = settings

    def _ask(self, task: Task, words: str) -> None:
        """Begin what somebody waits for; what nobody waits for makes room."""
        if self._underway is not None:
            raise StudioError(f"Press Cancel first: {self._underway.words} goes on")
        self._work.cancel()
        self._work.start(task)
        self._underway = Underway(words, 0.0 if task.size > 1 else None)

    def _try(self, trial: TrialRun, falls: bool) -> None:
        settings = trial.settings
        if self._findings.outcome(settings) is not None:
            raise StudioError(f"{_named(settings)}: you know that already; choose another number")
        self._ask(trial, f"trying {_named(settings)}")
        self._choose(settings)
        self._guess = falls

    def _test(self, trials: int) -> None:
        if self.lesson is None:
            raise StudioError("Train first: there is nothing learned to test")
        run = TryoutRun(self.lesson, self.lesson.taught.scene, trials)
        self._ask(run, f"testing {trials} times")
        self.tryout = TryoutStatus.of(run, (), goes_on=True)

    def _notice(self, material: tuple[FloatArray, ...]) -> str:
        """Forget what was found out if the demonstrations have changed."""
        before = self._material
        if len(material) == len(before) and all(map(_is, material, before)):
            self._unchanged += 1
            return ""
        self._material, self._unchanged, self._findings = material, 0, Findings()
        if isinstance(self._work.task, ErrorCurve):
            self._work.cancel()
        elif isinstance(self._work.task, BlockCurve | TrialRun):
            return f"{self.cancel()} The demonstrations have changed."
        return ""

    def _shown(self, choices: Choices) -> tuple[FloatArray, ...]:
        """Return what the demonstrations show that are learned from, each (T, D) [rad]."""
        kind = choices.arms, choices.mapping, choices.scene
        fitting = (entry for entry in self._listed.entries if entry.is_of(*kind))
        return tuple(entry.demonstration.sent for entry in fitting if entry.included)

    def _use_the_time(self, choices: Choices) -> None:
        """Begin what nobody waits for, if anything is missing."""
        curve = self._findings.curve(self._chosen.name)
        if self.lesson is not None and self._explained is not self.lesson:
            self._work.start(Explaining(self.lesson))
        elif self._material and self._unchanged > PATIENCE and curve.missing and not curve.note:
            taught = self._listed.taught(choices.arms, choices.mapping, choices.scene)
            self._work.start(ErrorCurve(taught, curve.learner, curve.missing))

    def _hear(self, report: Report) -> str:
        """Take in what has come of a task."""
        task, is_over = report.task, isinstance(report, Done | Failed)
        if isinstance(task, ErrorCurve):
            found = (point for point in report.points if isinstance(point, ErrorPoint))
            self._findings.add_errors(task.learner, found)
            if isinstance(report, Failed):
                self._findings.give_up(task.learner, report.words)
            return ""
        if isinstance(task, Explaining):
            if is_over:  # its one point may be told of before, and what Baxter did was added then
                self._explained = task.lesson
                self._equations = next((p for p in report.points if isinstance(p, dict)), {})
            return ""
        if isinstance(task, BlockCurve):
            found_blocks = [point for point in report.points if isinstance(point, BlockPoint)]
            self._findings.add_outcomes(task.learner, found_blocks)
        if isinstance(task, TryoutRun):
            self.tryout = TryoutStatus.of(task, report.points, goes_on=not is_over)
        if is_over:
            self._underway = None
        elif self._underway is not None:
            self._underway = replace(self._underway, share=len(report.points) / task.size)
        if isinstance(report, Failed):
            raise StudioError(report.words)
        return self._keep(task, report.points) if is_over else ""

    def _keep(self, task: Task, points: tuple[object, ...]) -> str:
        """Keep what somebody waited for, and say what it is."""
        if isinstance(task, TryoutRun):
            return self.tryout.words
        for point in points:
            if isinstance(task, Training) and isinstance(point, Lesson):
                self._learn(replace(point, taught=task.taught), None)
                return f"Learned with {_named(task.settings)}. Now let Baxter play it."
            if isinstance(task, TrialRun) and isinstance(point, Trial):
                self._learn(replace(point.lesson, taught=task.taught), point.reproduction)
                return self._tell(task.settings, block_point_of(point.lesson, point.reproduction))
        return "Now you see them all."

    def _learn(self, lesson: Lesson, reproduction: Reproduction | None) -> None:
        """Take a lesson as the newest; it is of the session's own demonstrations, not of copies."""
        self.lesson, self.reproduction = lesson, reproduction
        self._equations, self._explained_done = {}, None

    def _tell(self, settings: LearnerSettings, point: BlockPoint) -> str:
        self._findings.add_outcomes(settings.name, [point], self._guess)
        right = "as you said" if self._guess == point.done else "not as you said"
        return f"With {_named(settings)} {point.task.event[not point.done]}, {right}."


def _named(settings: LearnerSettings) -> str:
    return f"{settings.neurons} neuron{'s' if settings.neurons > 1 else ''}"


def _is(one: FloatArray, other: FloatArray) -> bool:
    return one is other
