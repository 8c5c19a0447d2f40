"""A session of the studio: one thread owns it, an inbox takes commands, ticks give snapshots.

It reads no clock: `tick` is one control period, whoever calls it and however fast. Only `post` and
`snapshot` may be used from other threads.
"""

import threading
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from studio.engine import commands
from studio.engine.activity import Activity, Follow, Hold
from studio.engine.calibrating import INVITATION, Calibrating
from studio.engine.calibration import in_words
from studio.engine.choices import Choices
from studio.engine.collection import Collection
from studio.engine.commands import Command
from studio.engine.comparing import Comparing
from studio.engine.drawn import Parts
from studio.engine.driving import SILENT, Driven, Driving
from studio.engine.errors import StudioError
from studio.engine.exporting import Exporting
from studio.engine.films import Film
from studio.engine.inbox import Answer, Inbox, nobody
from studio.engine.learning import Learning
from studio.engine.links.linked import Linked
from studio.engine.live.source import LiveSource
from studio.engine.showing import Show
from studio.engine.snapshot import Snapshot
from studio.engine.taking import Taking
from studio.engine.tape import NO_PLAN, Plan
from studio.engine.telling import Telling
from studio.engine.who_teaches import WhoTeaches
from studio.engine.workplace import Workplace


class Session:
    """See the module.

    Parameters
    ----------
    recordings
        Folder for new recordings.
    seed
        The demonstrator's.
    live, linked
        Where live streams come in, if any are taken; a robot that goes along, if any can.
    work
        Where it learns; without one, in its ticks.
    """

    def __init__(
        self,
        recordings: Path,
        seed: int = 0,
        live: LiveSource | None = None,
        work: Workplace | None = None,
        linked: Linked | None = None,
    ) -> None:
        self._inbox, self._who = Inbox(), WhoTeaches(seed, live)
        self._choices, self._calibrated_with = Choices(), ""
        self._collection = Collection(recordings, self.post)
        self._listed = self._collection.listed
        self._taking = Taking(recordings, self._collection)
        self._learning = Learning(self._listed, work)
        self._comparing, self._driving = Comparing(), Driving()
        self._exporting = Exporting(self._listed, self._learning, seed, self.post)
        self._linked = Linked() if linked is None else linked
        self._parts = Parts(
            self._who,
            self._listed,
            self._collection,
            self._learning,
            self._comparing,
            self._exporting,
            self._taking,
            self._linked,
            self._driving,
        )
        self._telling = Telling(
            "Ready: choose a source and record, or train on the samples.", self._hold
        )
        self._say, self._attempt = self._telling.say, self._telling.attempt
        self._activity: Activity = Hold(self._choices.start_world())
        self._draw()

    def post(self, command: Command, answer: Answer = nobody) -> None:
        """Put a command into the inbox; it takes effect at the next tick. Any thread may call.

        ``answer`` is told after that tick what came of it.
        """
        self._inbox.put(command, answer)

    def tick(self) -> Snapshot:
        """Take all commands, then do one control period; return and publish what came out."""
        answers = self._take_all()
        if not self._attempt(self._step):
            self._attempt(self._hold)
        self._attempt(lambda: self._say(self._linked.tick(self._activity, self._choices)))
        self._attempt(self._look)
        self._attempt(self._collection.step)
        self._attempt(lambda: self._say(self._learning.tick(self._choices, self._activity.mode)))
        self._attempt(lambda: self._say(self._exporting.tick(self._choices)))
        if not self._attempt(self._draw):
            self._attempt(self._draw)  # a robot that holds still by now
        for answer in answers:
            answer()
        return self.snapshot

    def hear(self) -> None:
        """Take all commands without letting time pass."""
        answers = self._take_all()
        self._attempt(self._draw)
        for answer in answers:
            answer()

    @property
    def awaited(self) -> threading.Event | None:
        """What is set when a frame has come that should not wait for its tick."""
        return self._activity.teacher.fresh if isinstance(self._activity, Follow) else None

    def close(self) -> None:
        """End the session; what is being recorded is kept."""
        self._linked.close()
        self._who.close()
        self._attempt(self._collection.close)
        self._learning.close()
        self._exporting.close()
        try:
            self._activity.close()
        finally:
            self._activity.world.close()

    def _step(self) -> None:
        if not self._activity.step():
            self._finish()
        elif isinstance(self._activity, Follow) and self._activity.take_is_over:
            self._follow(self._taking.next_path(), Plan(repeats=True, goes_on=True))
        elif isinstance(self._activity, Show) and self._activity.is_through:
            self._say(self._comparing.judge(self._activity.film, self._learning))

    def _take_all(self) -> list[Callable[[], None]]:
        def take(command: Command) -> None:
            self._attempt(partial(self._take_command, command))

        return self._inbox.serve(take, lambda: self._telling.message)

    def _take_command(self, command: Command) -> None:
        """Give a command to the part that it is for."""
        if isinstance(command, commands.SourceCommand):
            self._say(self._who.take(command))
        elif isinstance(command, commands.TeachCommand):
            self._say(self._collection.take(command))
        elif isinstance(command, commands.TakeCommand):
            self._say(self._taking.mark(self._activity, command))
        elif isinstance(command, commands.LearnCommand):
            self._say(self._learning.take(command, self._choices))
        elif isinstance(command, commands.TimelineCommand):
            asked = self._comparing.asked(command, self._activity, self._learning, self._listed)
            self._show(asked)
        elif isinstance(command, commands.ExportCommand):
            self._say(self._exporting.take(command, self._choices))
        elif isinstance(command, commands.CompareCommand):
            self._compare(command)
        elif isinstance(command, commands.DriveCommand):
            self._drive(command)
        elif isinstance(command, commands.LinkCommand):
            self._say(self._linked.take(command))
        else:
            self._act(command)

    def _act(self, command: commands.ActCommand) -> None:
        self._linked.hear(command)
        self._driving.hear(command)
        match command:
            case commands.Stop():
                if isinstance(self._activity, Show):
                    self._say(self._activity.pause())
                else:
                    self._finish(stopped=True)
                self._say(self._learning.cancel())
            case commands.LetGo(why) if isinstance(self._activity, Follow | Driven):
                self._finish(stopped=True)
                self._say(f"{why} {self._telling.message.text}")
            case commands.Configure() | commands.ChooseScene():
                self._configure(command.among(self._choices))
            case commands.Calibrate():
                self._calibrate()
            case commands.ForgetCalibration():
                self._choices = replace(self._choices, calibration=None)
                self._say("Calibration forgotten.")
            case commands.Watch():
                self._follow(None)
            case commands.Record(repeats):
                self._follow(self._taking.next_path(), Plan(repeats=repeats))
            case commands.RecordAgain():
                self._who.show_again()
                plan = self._taking.again(self._activity, command, partial(self._finish, True))
                self._follow(self._taking.next_path(), plan)

    def _look(self) -> None:
        """Let who teaches know of the tick, and take what was read meanwhile."""
        found = self._who.tick(self._activity)
        if isinstance(found, str):
            self._say(found)
        else:
            self._say(self._collection.add(found.recording, found.name, found.path))

    def _configure(self, chosen: Choices) -> None:
        if isinstance(self._activity, Follow | Driven):
            raise StudioError("Stop first: what was chosen stays as it is while teaching")
        before, self._choices = self._choices, chosen
        if not chosen.learns_as(before):
            self._learning.forget()
            self._comparing.forget()
        if not chosen.starts_as(before):
            self._begin(lambda: Hold(self._comparing.start_world(chosen)))
        self._say(self._who.in_scene(chosen.scene))

    def _calibrate(self) -> None:
        teacher = self._who.required()
        self._finish(stopped=True)
        self._activity = Calibrating(teacher, self._activity.world)
        self._say(INVITATION)

    def _follow(self, path: Path | None, plan: Plan = NO_PLAN) -> None:
        teacher, pipeline = self._who.required(), self._choices.pipeline()
        usual, scene = self._choices.scene, self._comparing.scene(self._choices)
        self._begin(lambda: Follow(teacher, pipeline, path, scene, plan, usual))
        self._say("Recording." if path else "Watching, not recording.")

    def _compare(self, command: commands.CompareCommand) -> None:
        moves = isinstance(command, commands.PlaceBlock | commands.PutBlockBack)
        if moves and not isinstance(self._activity, Hold | Show | Driven):
            raise StudioError("Somebody teaches: press Stop first, then move the block")
        words = self._comparing.take(command, self._learning.lesson, self._choices)
        if moves:
            self._begin(lambda: Hold(self._comparing.start_world(self._choices)))
        self._say(words)

    def _drive(self, command: commands.DriveCommand) -> None:
        goes_on = self._driving.take(self._activity, self._choices, command)
        if goes_on is not None and goes_on is not self._activity:
            self._finish(stopped=True)
            self._activity = goes_on
            self._say("A program drives Baxter.")

    def _show(self, film: Film | None) -> None:
        """Put something on the timeline; it keeps the present world unless it brings its own."""
        if film is None:
            return
        self._finish(stopped=True)
        held = self._activity.world
        self._activity = Show(film, self._comparing.timeline, film.world or held)
        if film.world is not None:
            held.close()
        self._say(film.words)

    def _begin(self, build: Callable[[], Activity]) -> None:
        """End what goes on, and go on with something in another world."""
        self._finish(stopped=True)
        activity = build()
        self._activity.world.close()
        self._activity = activity

    def _hold(self) -> None:
        """Hold still in the present world, whatever was going on."""
        ended = self._activity
        self._activity = Hold(ended.world)  # first: a full disk keeps a recording from closing
        ended.close()

    def _finish(self, stopped: bool = False) -> None:
        """Keep what the present activity has come to, then hold still."""
        ended = self._activity
        self._hold()
        if isinstance(ended, Follow):
            self._attempt(lambda: self._say(self._taking.keep(ended.tape)))
        elif isinstance(ended, Show):
            self._comparing.timeline = ended.timeline  # speed and loop stay
        elif stopped and not isinstance(ended, Hold):
            self._say("Stopped.")
        elif isinstance(ended, Driven):
            self._say(SILENT)
        elif isinstance(ended, Calibrating):
            self._take_calibration(ended)

    def _take_calibration(self, ended: Calibrating) -> None:
        if ended.found is None:
            raise StudioError(f"{ended.refusal}. Press Calibrate to try again")
        self._choices = replace(self._choices, calibration=ended.found)
        self._calibrated_with = ended.teacher.path
        self._say(f"Calibrated for what is taught next: {in_words(ended.found)}.")

    def _draw(self) -> None:
        """Publish what all this looks like by now."""
        calibrated_with = self._calibrated_with if self._choices.calibration else ""
        message = self._telling.message
        self.snapshot = self._parts.drawn(self._activity, message, self._choices, calibrated_with)
