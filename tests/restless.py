"""Somebody who never rests: asks a session for anything, in an order that only a seed knows.

Most of what is asked for fits what is shown; some of it does not, as with people. Beside it, what
nobody may lose: `Kept` notes every recording that was ever made.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.commands import Command
from studio.engine.errors import StudioError
from studio.engine.mcap_file import read_recording
from studio.engine.session import Session
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings
from tests.engine.puppet.dragging import SEQUENCE, from_shoulder

MOST_LISTED = 6  # demonstrations; who never deletes any would be right to see memory grow
MOST_NEURONS = 60
STEP = 0.1  # [s] between two places of a dragged hand
LIGHT = ("csv", "npz", "mcap", "model", "zip")  # kinds of export that need no film

Orders = tuple[tuple[Command, ...], float]  # what is asked for at once, and the wait after it [s]


class Restless:
    """See the module.

    Parameters
    ----------
    seed
        Whoever has the same one, and is shown the same, asks for the same.
    look
        Shows the session as it is.
    files
        That may be uploaded.
    kinds
        Of exports.
    patient
        Whether to ask for what takes the session many seconds where it has no other process.
    """

    def __init__(
        self,
        seed: int,
        look: Callable[[], Snapshot],
        files: Sequence[Path],
        kinds: tuple[str, ...] = LIGHT,
        patient: bool = True,
    ) -> None:
        self._random, self._look = np.random.default_rng(seed), look
        self._files, self._kinds, self._patient = tuple(files), kinds, patient

    def everything_once(self) -> Iterator[Orders]:
        """Return one round in which nothing is left out; it ends.

        Whatever a session loads when it is first needed is there afterwards.
        """
        yield from self._teach()
        yield from self._drag()
        for path in self._files:
            yield (commands.Stop(), commands.UseFile(path, path.name)), 1.5
            yield (commands.Watch(),), 2.0
        for arms in ("both", "left"):
            yield (commands.Stop(), commands.Configure(Choices(arms))), 0.5
            yield (commands.UseDemonstrator(), commands.Record()), 1.0
            yield from self._until_idle()
        for name in ("newrb", "field", "rbf"):
            yield (commands.Stop(), commands.Train(LearnerSettings(name, MOST_NEURONS))), 0.5
            yield from self._until_idle()
            yield (commands.KeepToCompare(), commands.PlayReproduction()), 3.0
        for kind in self._kinds:
            yield (commands.Stop(), commands.Export((kind,), anonymous=False)), 0.5
            yield from self._until(lambda: not self._look().export.running, 20.0)
        yield from self._reopen()

    def asks(self) -> Iterator[Orders]:
        """Return all that is asked for; it never ends."""
        deeds = (self._teach, self._drag, self._learn, self._compare, self._tidy, self._leave)
        deeds += (self._fumble, self._fumble, self._watch)
        while True:
            order = self._random.permutation(len(deeds))
            for index in order:
                yield from deeds[index]()
                yield from self._make_room()

    def _teach(self) -> Iterator[Orders]:
        """Be taught by the demonstrator: the only deed that is always seen to its end."""
        yield (commands.Stop(), commands.Configure(Choices()), commands.UseDemonstrator()), 0.1
        yield (self._one(commands.Record(), commands.RecordAgain()),), 1.0
        yield from self._until_idle()

    def _drag(self) -> Iterator[Orders]:
        """Take the puppet, sign, and drag its hand about."""
        yield (
            (
                commands.Stop(),
                commands.UsePuppet(),
                self._one(
                    commands.Record(),
                ),
            ),
            0.5,
        )
        for state in SEQUENCE:
            yield (commands.Sign("left", state),), 0.5
        for forward, outward in self._random.uniform((0.3, -0.3), (0.5, 0.4), (20, 2)):
            x, y, z = from_shoulder("left", forward, outward, -0.2).tolist()
            yield (commands.DragHand("left", (x, y, z)),), STEP
        yield (commands.Sign("left", HandState.LASSO),), 0.5
        yield (commands.Stop(),), 0.1

    def _watch(self) -> Iterator[Orders]:
        """Watch a live stream or a file, and take a part of it by hand."""
        yield (commands.Stop(), self._one(commands.UseLive(), self._upload())), 1.5
        yield (commands.Watch(),), self._seconds(1.0)
        yield (commands.BeginTake(),), self._seconds(3.0)
        yield (self._one(commands.EndTake(), commands.Stop(), commands.LetGo("Gone.")),), 0.3
        yield (commands.Stop(),), 0.1

    def _learn(self) -> Iterator[Orders]:
        name = self._one("rbf", "rbf", "newrb", "field")
        settings = LearnerSettings(name, int(self._random.integers(1, MOST_NEURONS)))
        falls = bool(self._random.integers(2))
        yield (commands.Stop(), commands.ChooseLearner(settings)), self._seconds(1.0)
        asked = (commands.Train(settings), commands.Guess(settings, falls))
        yield (self._one(*asked),), self._seconds(3.0)
        yield (self._one(commands.ResumeCurve(), commands.CancelWork(), asked[0]),), 2.0

    def _compare(self) -> Iterator[Orders]:
        """Let it be done alone or show it again, in a loop, and pull at the playhead."""
        x, y = self._random.uniform((0.55, 0.1), (0.75, 0.4)).tolist()
        yield (commands.PlaceBlock(x, y), commands.PutBlockBack()), 0.2
        yield (self._one(commands.KeepToCompare(), commands.ForgetKept()),), 0.1
        film = self._one(commands.PlayReproduction(), commands.PlayDemonstration())
        yield (commands.SetLoop(True), film), self._seconds(3.0)
        for position in self._random.uniform(0.0, 8.0, 5).tolist():
            yield (commands.Scrub(position), commands.StepBy(self._one(-1, 1))), STEP
        u, v = self._random.uniform(-0.5, 0.5, 2).tolist()
        yield (commands.PlaceStart(0, u, v), commands.ShowLeg(self._one(0, 1))), 0.2
        speed = self._one(0.25, 1.0, 2.0)
        yield (commands.SetSpeed(speed), commands.TogglePlay()), self._seconds(3.0)

    def _tidy(self) -> Iterator[Orders]:
        """Change, delete, bring back and open what is listed or lies in the folder."""
        now = self._look()
        for entry in now.entries[-2:]:
            begin, end = np.sort(self._random.uniform(0.0, 6.0, 2)).tolist()
            number, name = entry.number, f"take {self._random.integers(100)}"
            yield (commands.Trim(number, begin, end), commands.Rename(number, name)), 0.3
            yield (commands.Include(number, self._one(True, False)), commands.Choose(number)), 0.3
        for file in now.collection.files[:1]:
            yield (commands.OpenRecording(file.path.name), self._upload()), self._seconds(2.0)
        if now.entries:
            number = self._one(*(entry.number for entry in now.entries))
            end = self._one(commands.Restore(), commands.Restore(), commands.DeleteForGood())
            yield (commands.Remove(number),), 0.3
            yield (end,), 0.2

    def _leave(self) -> Iterator[Orders]:
        """Export, and open what came of the last export."""
        kinds = self._random.permutation(self._kinds)[: self._random.integers(1, 3)]
        yield (commands.Export(tuple(kinds.tolist()), self._one(True, False)),), 2.0
        yield from self._reopen()

    def _fumble(self) -> Iterator[Orders]:
        """Ask for what is not possible now, many times at once."""
        wrong: tuple[Command, ...] = (
            commands.Calibrate(),
            commands.ForgetCalibration(),
            commands.EndTake(),
            commands.Remove(9999),
            commands.FollowBody("nobody"),
            commands.RevealBlocks("rbf") if self._patient else commands.CancelWork(),
            commands.CancelReading(),
            commands.CancelExport(),
            commands.DragHand("right", (0.0, 0.0, 9.0)),
            commands.PuppetHome(),
            commands.TogglePlay(),
            commands.Scrub(1e9),
            commands.Configure(Choices(self._one("left", "both"), self._one("exact", "paper"))),
            commands.PlayReproduction(),
            commands.Restore(),
            commands.Stop(),
        )
        some = self._random.permutation(len(wrong))[:6]
        yield tuple(wrong[index] for index in some), self._seconds(1.0)

    def _make_room(self) -> Iterator[Orders]:
        """Delete the oldest, one after the other."""
        spare = len(self._look().entries) - MOST_LISTED
        for entry in self._look().entries[: max(0, spare)]:
            yield (commands.Remove(entry.number),), 0.1

    def _reopen(self) -> Iterator[Orders]:
        """Open the session that was exported last."""
        archives = [path for path in self._look().export.files if path.suffix == ".zip"]
        if archives:
            yield (commands.OpenSession(archives[0]),), 2.0

    def _until_idle(self) -> Iterator[Orders]:
        return self._until(lambda: self._look().mode is Mode.IDLE, 30.0)

    def _until(self, reached: Callable[[], bool], seconds: float) -> Iterator[Orders]:
        for _ in range(round(seconds / STEP)):
            if reached():
                return
            yield (), STEP

    def _upload(self) -> Command:
        path = self._one(*self._files)
        return commands.UseFile(path, f"my {path.name}")

    def _seconds(self, most: float) -> float:
        return float(self._random.uniform(STEP, most))

    def _one(self, *of):
        return of[int(self._random.integers(len(of)))]


class Watched(Session):
    """A session whose every command is looked after: several of one tick can delete."""

    def __init__(self, kept: "Kept", **settings: Any) -> None:
        self._kept = kept
        super().__init__(kept.folder, **settings)

    def _take_command(self, command: Command) -> None:
        try:
            super()._take_command(command)
        finally:
            self._kept.may_go(self._collection.status().goes_too)

    def tick(self) -> Snapshot:
        now = super().tick()  # a take that was recorded again replaces another one in its tick
        self._kept.may_go(now.collection.goes_too)
        return now


@dataclass
class Kept:
    """Every recording that was made in a folder: a second name for each, which nobody deletes.

    ``look`` belongs after whatever may have made one or deleted one.
    """

    folder: Path
    safe: Path  # on the same disk
    _seen: set[int] = field(default_factory=set)  # inodes
    _waiting: tuple[dict[int, Path], Snapshot | None] = ({}, None)  # to be sure they are made
    _may_go: set[str] = field(default_factory=set)  # names of files that somebody deleted

    def may_go(self, name: str) -> None:
        """Note the name of a file of which people were told that it goes with what they delete."""
        self._may_go.add(name)

    def look(self, now: Snapshot) -> None:
        """Note what is there by now."""
        waiting, then = self._waiting
        if now is then:
            return
        # What was there before this snapshot was drawn, and is not being written, is made.
        for inode, path in waiting.items() if now.mode is not Mode.RECORDING else ():
            kept = self.safe / f"{len(self._seen) + 1:04d} {path.name}"
            with suppress(FileNotFoundError):  # nothing had come in, and it was taken away
                os.link(path, kept)
                self._seen.add(inode)
        there = {path.stat().st_ino: path for path in self.folder.glob("*.mcap")}
        new = {inode: path for inode, path in there.items() if inode not in self._seen}
        self._waiting = new, now

    @property
    def made(self) -> int:
        """How many there were."""
        return len(self._seen)

    def lost(self) -> list[str]:
        """Return what cannot be read, or is gone though nobody deleted it."""
        there = {path.stat().st_ino for path in self.folder.glob("*.mcap")}
        lost = []
        for path in sorted(self.safe.iterdir()):
            try:
                warning = read_recording(path).warning
            except StudioError as error:
                warning = str(error)
            if warning:
                lost.append(f"{path.name}: {warning}")
            name = path.name.partition(" ")[2]
            if path.stat().st_ino not in there and name not in self._may_go:
                lost.append(f"{name}: gone")
        return lost
