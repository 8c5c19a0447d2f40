"""What is too large for a snapshot: told when it is asked for."""

import json
import tempfile
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from studio.engine.errors import StudioError
from studio.engine.export.model import write_model
from studio.engine.performance import in_guards_words
from studio.engine.remote.views import ADAPTERS
from studio.engine.remote.wire import as_message, readable
from studio.engine.snapshot import Snapshot
from studio.engine.teaching import Lesson
from studio.rbf import NewrbRegressor, RBFRegressor
from studio.remote import told
from studio.remote.asked import Fetch, FetchDemonstration
from studio.remote.learned import Deviation, LessonSummary

Large = told.Lesson | told.Reproduction | told.Equations | told.Field


class LargeAnswers:
    """What is large, made once for all who ask: a lesson takes 8 ms, in which nobody is served."""

    def __init__(self) -> None:
        self._made: dict[str, tuple[object, Large]] = {}  # of what, and the answer

    def to(self, asked: Fetch, now: Snapshot) -> Large:
        """Return what is asked for; raise StudioError where there is no such thing yet."""
        source = {"lesson": now.lesson, "reproduction": now.reproduction}.get(asked.what)
        kept = self._made.get(asked.what)
        if kept is None or source is None or kept[0] is not source:
            kept = self._made[asked.what] = source, large(asked, now)
        return msgspec.structs.replace(kept[1], id=asked.id)


def large(asked: Fetch, now: Snapshot) -> Large:
    """Return what is asked for.

    Raises
    ------
    StudioError
        Where there is no such thing yet.
    """
    match asked.what:
        case "lesson":
            return lesson(asked.id, now)
        case "reproduction":
            return reproduction(asked.id, now)
        case "equations":
            equations = now.learning.equations
            return as_message(told.Equations, None, {}, id=asked.id, equations=equations)
        case _:
            if now.compare.field is None:
                raise StudioError("no field is shown: train a field first")
            return as_message(told.Field, now.compare.field, {}, id=asked.id)


def lesson(number: int, now: Snapshot) -> told.Lesson:
    """Return what was learned; raise StudioError where nothing was."""
    learned = now.lesson
    if learned is None:
        raise StudioError("nothing is learned yet: send train first")
    return told.Lesson(
        id=number,
        summary=as_message(LessonSummary, learned, ADAPTERS),
        model=_model(learned),
        curve=np.asarray(learned.curve).tolist(),
        mean=learned.taught.mean.tolist(),
        taught=np.stack(list(learned.taught.rows)).tolist(),
    )


def _model(learned: Lesson) -> dict[str, Any] | None:
    if not isinstance(learned.model, RBFRegressor | NewrbRegressor):
        return None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.json"
        write_model(path, learned)
        model: dict[str, Any] = json.loads(path.read_text("utf-8"))
        return model


def reproduction(number: int, now: Snapshot) -> told.Reproduction:
    """Return what Baxter did alone; raise StudioError where it did nothing yet."""
    if now.reproduction is None:
        raise StudioError("Baxter has done nothing alone yet: send play_reproduction first")
    done = now.reproduction.performance
    return told.Reproduction(
        id=number,
        deviation=as_message(Deviation, now.reproduction.deviation, {}),
        block_down=done.block_down,
        done=done.done,
        duration=done.duration,
        times=[tick.time for tick in done.ticks],
        measured=[tick.world.joint_positions.tolist() for tick in done.ticks],
        block_poses=[tick.world.block_poses.tolist() for tick in done.ticks],
        guarded=in_guards_words(done),
    )


def demonstration(asked: FetchDemonstration, now: Snapshot) -> told.Demonstration:
    """Return a listed demonstration; raise StudioError where there is none of that number."""
    for entry in now.entries:
        if entry.number == asked.number:
            shown = entry.demonstration
            return told.Demonstration(
                id=asked.id,
                number=entry.number,
                name=readable(entry.name),
                joints=list(shown.joints),
                times=shown.times.tolist(),
                sent=shown.sent.tolist(),
            )
    raise StudioError(f"there is no demonstration {asked.number} on the list")
