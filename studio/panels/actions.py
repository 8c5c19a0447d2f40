"""What the palette offers of a session, each with its key, if it has one, and why it is off.

Left out is what needs more than a press: a file, a number, a name, a place, a confirmation.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from studio.engine import commands
from studio.engine.commands import Command
from studio.engine.snapshot import Snapshot
from studio.panels import readiness as ready
from studio.panels.inputs import Post
from studio.panels.learn import why_not_suggest
from studio.panels.tryout import TRIALS, why_not_test

JUMP = 15  # ticks: half a second


@dataclass(frozen=True)
class Key:
    """A key as viser names it, and as people do."""

    name: Literal[
        "escape",
        "space",
        "arrowright",
        "arrowleft",
        "B",
        "N",
        "R",
        "T",
        "Z",
        "1",
        "2",
        "3",
        "4",
        "5",
    ]
    shown: str
    modifier: Literal["shift", "cmd/ctrl"] | None = None


@dataclass(frozen=True)
class Action:
    """One entry of the palette."""

    label: str
    act: Callable[[], None]
    key: Key | None = None
    why_not: Callable[[Snapshot], str] = lambda _: ""


@dataclass(frozen=True)
class Order:
    """An entry that asks the session for something: always the same, or by what it shows."""

    label: str
    asks: Command | Callable[[Snapshot], Command]
    why_not: Callable[[Snapshot], str] = lambda _: ""
    key: Key | None = None

    def action(self, post: Post, newest: Callable[[], Snapshot | None]) -> Action:
        """Return it as an entry that posts the command, by the ``newest`` snapshot if need be."""

        def act() -> None:
            if not callable(self.asks):
                post(self.asks)
            elif (now := newest()) is not None and not self.why_not(now):
                post(self.asks(now))

        return Action(self.label, act, self.key, self.why_not)


def _step(label: str, ticks: int, key: Key) -> Order:
    return Order(label, commands.StepBy(ticks), ready.why_not_step, key)


def _included(now: Snapshot) -> commands.Include:
    entry = now.entries[now.chosen]
    return commands.Include(entry.number, not entry.included)


def _suggested(now: Snapshot) -> commands.ChooseLearner:
    learning = now.learning
    found = learning.curve.suggestion
    count = learning.chosen.neurons if found is None else found.neurons
    return commands.ChooseLearner(replace(learning.chosen, neurons=count))


_TIMELINE = (
    Order("Play or pause", commands.TogglePlay(), ready.why_not_toggle, Key("space", "Space")),
    _step("One tick on", 1, Key("arrowright", "→")),
    _step("One tick back", -1, Key("arrowleft", "←")),
    _step("Half a second on", JUMP, Key("arrowright", "Shift →", "shift")),
    _step("Half a second back", -JUMP, Key("arrowleft", "Shift ←", "shift")),
    Order("Loop on or off", lambda now: commands.SetLoop(not now.compare.timeline.loops)),
)
_SOURCE = (
    Order("Be the puppet", commands.UsePuppet()),
    Order("Take the demonstrator", commands.UseDemonstrator()),
    Order("Take the live stream", commands.UseLive(), ready.why_not_take_stream),
    Order("Give up reading", commands.CancelReading(), ready.why_not_give_up_reading),
    Order("Calibrate (stand with arms hanging)", commands.Calibrate(), ready.why_not_calibrate),
)
_TEACH = (
    Order("Record", commands.Record(), ready.why_not_teach),
    Order("Watch, without recording", commands.Watch(), ready.why_not_teach),
    Order("Begin the take", commands.BeginTake(), ready.why_not_begin_take),
    Order("End the take", commands.EndTake(), ready.why_not_end_take),
    Order(
        "Record again, in place of the chosen one",
        commands.RecordAgain(),
        ready.why_not_record_again,
        Key("R", "R"),
    ),
    Order("Learn from the chosen one, or leave it out", _included, ready.why_not_choose),
    Order(
        "Delete the chosen demonstration",
        lambda now: commands.Remove(now.entries[now.chosen].number),
        ready.why_not_choose,
    ),
    Order(
        "Undo the last deletion",
        commands.Restore(),
        ready.why_not_restore,
        Key("Z", "Ctrl Z", "cmd/ctrl"),
    ),
)
_LEARN = (
    Order(
        "Train the chosen network",
        lambda now: commands.Train(now.learning.chosen),
        ready.why_not_train,
    ),
    Order("Suggest a number of neurons, and choose it", _suggested, why_not_suggest),
    Order("Cancel what is being computed", commands.CancelWork(), ready.why_not_cancel),
)
_COMPARE = (
    Order("Let Baxter do it alone", commands.PlayReproduction(), ready.why_not_play, Key("B", "B")),
    Order("Replay the chosen demonstration", commands.PlayDemonstration(), ready.why_not_replay),
    Order(f"Test {TRIALS} times", commands.TryOut(TRIALS), why_not_test),
    Order("Put the block back", commands.PutBlockBack(), ready.why_not_put_back),
    Order("Keep this one to compare, as B", commands.KeepToCompare(), ready.why_not_keep),
    Order("Send B away", commands.ForgetKept(), ready.why_not_send_away),
)
_EXPORT = (Order("Cancel the export", commands.CancelExport(), ready.why_not_cancel_export),)

ORDERS = (
    Order("Stop and disarm", commands.Stop(), key=Key("escape", "Esc")),
    *_TIMELINE,
    *_SOURCE,
    *_TEACH,
    *_LEARN,
    *_COMPARE,
    *_EXPORT,
)
