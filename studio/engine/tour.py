"""The tour: the paper's experiment in under two minutes, each stage with a caption.

The built-in demonstrator teaches four times, a network learns, Baxter does it alone; then a network
that is too small fails. It is steered as a person steers, by commands, and watches the snapshots
for what came of them; so it can be left at any time, and whatever is there by then stays.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.commands import Command
from studio.engine.scene import DEFAULT_SCENE
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings

Step = Literal["source", "teach", "learn", "compare"]
TAKES = 4  # as in the paper
ENOUGH, TOO_FEW = LearnerSettings("rbf", 50), LearnerSettings("rbf", 1)
LONGEST_STAGE = 60.0  # [s]; a take is 13 s
_TEACHING = (Mode.WATCHING, Mode.ARMED, Mode.RECORDING)


@dataclass(frozen=True)
class Caption:
    """What there is to see at this moment of the tour."""

    step: Step
    number: int  # of the stage, from 1
    of: int  # stages
    words: str


@dataclass(frozen=True)
class _Stage:
    """One stage: what is asked for, how long it is shown at least, and when it is through."""

    step: Step
    words: Callable[[Snapshot], str]
    asks: Callable[[Snapshot], tuple[Command, ...]]
    is_through: Callable[[Snapshot, Snapshot], bool]  # as it was in the beginning, as it is now
    least: float  # [s]


class Tour:
    """See the module. One thread uses it; `advance` belongs into every look at a snapshot."""

    def __init__(self) -> None:
        self._at: int | None = None  # the stage; None: nobody is on the tour
        self._begun = 0.0  # [s] when the stage began
        self._before: Snapshot | None = None  # as it was then
        self.farewell = ""  # how the last tour ended, in words; nothing while one is on

    @property
    def is_on(self) -> bool:
        """Whether somebody is on the tour."""
        return self._at is not None

    def begin(self) -> None:
        """Set out, or begin anew."""
        self._at, self._before, self.farewell = 0, None, ""

    def leave(self, why: str) -> None:
        """End it where it is; what it has made stays."""
        if self.is_on:
            self._at, self.farewell = None, why

    def advance(self, now: Snapshot, time: float) -> tuple[Command, ...]:
        """Look at a snapshot, taken at a time [s] that only rises; return what to ask for."""
        if self._at is None:
            return ()
        stage = STAGES[self._at]
        if self._before is None:
            self._before, self._begun = now, time
            return stage.asks(now)
        before = self._before
        if now.message.is_error and now.message.number > before.message.number:
            self.leave(f"The tour ended: {now.message.text}")
        elif stage.is_through(before, now) and time - self._begun >= stage.least:
            return self._go_on(now, time)
        elif time - self._begun > LONGEST_STAGE:
            self.leave("The tour ended: something took too long. Take it again.")
        return ()

    def caption(self, now: Snapshot) -> Caption | None:
        """Return what there is to see; None where nobody is on the tour."""
        if self._at is None:
            return None
        stage = STAGES[self._at]
        return Caption(stage.step, self._at + 1, len(STAGES), stage.words(now))

    def _go_on(self, now: Snapshot, time: float) -> tuple[Command, ...]:
        if self._at is None or self._at + 1 == len(STAGES):
            self.leave(FAREWELL)
            return ()
        self._at += 1
        self._before, self._begun = now, time
        return STAGES[self._at].asks(now)


FAREWELL = (
    f"That was the paper's experiment. Its {TAKES} demonstrations are yours: leave one out, trim "
    "it, try other numbers of neurons, drag the block. All others are listed, and left out."
)


def _prepare(now: Snapshot) -> tuple[Command, ...]:
    """Return how to begin: as the paper does, and with nobody else's demonstrations."""
    left_out = tuple(commands.Include(e.number, False) for e in now.entries if e.included)
    usual = (commands.ChooseScene(DEFAULT_SCENE), commands.Configure(Choices()))
    chosen = () if now.choices == Choices() else usual
    return commands.Stop(), *chosen, *left_out, commands.UseDemonstrator()


def _record(take: int) -> Callable[[Snapshot], tuple[Command, ...]]:
    another = () if take == 1 else (commands.UseDemonstrator(),)
    return lambda _: (*another, commands.Record())


def _was_recorded(before: Snapshot, now: Snapshot) -> bool:
    return len(now.entries) > len(before.entries) and now.mode not in _TEACHING


def _was_learned(before: Snapshot, now: Snapshot) -> bool:
    return now.lesson is not None and now.lesson is not before.lesson


def _was_done(before: Snapshot, now: Snapshot) -> bool:
    done = now.reproduction
    return done is not None and done is not before.reproduction


def _is_ready(_: Snapshot, now: Snapshot) -> bool:
    return now.source is not None and now.mode not in _TEACHING


def _always(_: Snapshot, __: Snapshot) -> bool:
    return True


def _nothing(_: Snapshot) -> tuple[Command, ...]:
    return ()


def _said(words: str) -> Callable[[Snapshot], str]:
    return lambda _: words


def _taught(take: int) -> Callable[[Snapshot], str]:
    """Return the words beside a take: what the gate waits for, then what goes on."""
    begin = f"Demonstration {take} of {TAKES}. "
    later = {
        1: "Baxter follows the arm: its joints are recorded 30 times a second.",
        2: "Again, and never quite the same: people are not machines.",
        3: "How much takes differ will be the floor that no network can beat.",
        4: "The last one. Each is a card in 2 Teach, to keep, trim or delete.",
    }[take]

    def words(now: Snapshot) -> str:
        if now.gate is None or not now.gate.armed:
            return begin + "The left hand signs Lasso, Open, Closed. Only then does Baxter follow."
        return begin + later

    return words


def _learned(now: Snapshot) -> str:
    begin = f"A network of {ENOUGH.neurons} radial basis functions learns the joints over time. "
    lesson = now.lesson
    if lesson is None or lesson.settings != ENOUGH or now.mode is Mode.TRAINING:
        return begin
    if lesson.floor is None or not (lesson.floor > 0.0).all():
        return begin
    ratio = float((lesson.mse / lesson.floor).max())
    return begin + f"Its error is {ratio:.2f} times the floor at most: as good as four takes allow."


def _failed(now: Snapshot) -> str:
    done = now.reproduction
    if done is None:
        return "Baxter does what a single neuron learned. Will the block fall?"
    if done.performance.done:
        return "It fell all the same: these takes are alike enough. Others will not be."
    return "The block stays up: one neuron is too few, as its error said before."


def _play(_: Snapshot) -> tuple[Command, ...]:
    return (commands.PlayReproduction(),)


def _train(learner: LearnerSettings) -> Callable[[Snapshot], tuple[Command, ...]]:
    return lambda _: (commands.Train(learner),)


STAGES: tuple[_Stage, ...] = (
    _Stage(
        "source",
        _said("Somebody moves, Baxter watches. A built-in person stands in for you and a sensor."),
        _prepare,
        _is_ready,
        5.0,
    ),
    *(
        _Stage("teach", _taught(take), _record(take), _was_recorded, 0.0)
        for take in range(1, TAKES + 1)
    ),
    _Stage("learn", _learned, _train(ENOUGH), _was_learned, 7.0),
    _Stage(
        "compare",
        _said("Baxter does it alone, beside the ghost of a demonstration. Watch the block."),
        _play,
        _was_done,
        0.0,
    ),
    _Stage(
        "compare",
        _said("Below: how far hand and joints were from the demonstrations' mean."),
        _nothing,
        _always,
        4.0,
    ),
    _Stage(
        "learn",
        _said("Now fail on purpose: the same demonstrations, and a single neuron."),
        _train(TOO_FEW),
        _was_learned,
        5.0,
    ),
    _Stage("compare", _failed, _play, _was_done, 0.0),
    _Stage("compare", _failed, _nothing, _always, 4.0),
    _Stage("learn", _learned, _train(ENOUGH), _was_learned, 3.0),
)
