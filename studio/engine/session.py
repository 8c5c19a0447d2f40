"""A session of the studio: one thread owns it, an inbox takes commands, ticks give snapshots.

It reads no clock: `tick` is one control period, whoever calls it and however fast. Only `post` and
`snapshot` may be used from other threads.
"""

import queue
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
from studio.engine.errors import StudioError
from studio.engine.exporting import Exporting
from studio.engine.films import Film
from studio.engine.learning import Learning
from studio.engine.live.source import LiveSource
from studio.engine.pipeline import NO_LAG
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
    live
        Where live streams come in, if any are taken.
    work
        Where it learns; without one, in its ticks.
    """

    def __init__(
        self,
        recordings: Path,
        seed: int = 0,
        live: LiveSource | None = None,
        work: Workplace | None = None,
    ) -> None:
        self._inbox: queue.SimpleQueue[Command] = queue.SimpleQueue()
        self._choices, self._calibrated_with = Choices(), ""
        self._who = WhoTeaches(seed, live)
        self._collection = Collection(recordings, self.post)
        self._listed = self._collection.listed
        self._taking = Taking(recordings, self._collection)
        self._learning = Learning(self._listed, work)
        self._comparing = Comparing()
        self._exporting = Exporting(self._listed, self._learning, seed, self.post)
        self._telling = Telling(
            "Ready: choose a source and record, or train on the samples.", self._hold
        )
        self._say, self._attempt = self._telling.say, self._telling.attempt
        self._activity: Activity = Hold(self._choices.start_world())
        self._draw()

    def post(self, command: Command) -> None:
        """Put a command into the inbox; it takes effect at the next tick. Any thread may call."""
        self._inbox.put(command)

    def tick(self) -> Snapshot:
        """Take all commands, then do one control period; return and publish what came out."""
        while True:
            try:
                command = self._inbox.get_nowait()
            except queue.Empty:
                break
            self._attempt(partial(self._take_command, command))
        if not self._attempt(self._step):
            self._attempt(self._hold)
        self._attempt(self._look)
        self._attempt(self._collection.step)
        self._attempt(lambda: self._say(self._learning.tick(self._choices, self._activity.mode)))
        self._attempt(lambda: self._say(self._exporting.tick(self._choices)))
        if not self._attempt(self._draw):
            self._attempt(self._draw)  # a robot that holds still by now
        return self.snapshot

    @property
    def awaited(self) -> threading.Event | None:
        """What is set when a frame has come that should not wait for its tick."""
        return self._activity.teacher.fresh if isinstance(self._activity, Follow) else None

    def close(self) -> None:
        """End the session; what is being recorded is kept."""
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
            self._follow(self._taking.next_path(), Plan(repeats=True))
        elif isinstance(self._activity, Show) and self._activity.is_through:
            self._say(self._comparing.judge(self._activity.film, self._learning))

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
        else:
            self._act(command)

    def _act(self, command: commands.ActCommand) -> None:
        match command:
            case commands.Stop():
                if isinstance(self._activity, Show):
                    self._say(self._activity.pause())
                else:
                    self._finish(stopped=True)
                self._say(self._learning.cancel())
            case commands.LetGo(why) if isinstance(self._activity, Follow):
                self._finish(stopped=True)
                self._say(f"{why} {self._telling.message.text}")
            case commands.Configure():
                self._configure(command.choices)
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
        if isinstance(self._activity, Follow):
            raise StudioError("Stop first: what was chosen stays as it is while teaching")
        before = self._choices
        self._choices = replace(chosen, calibration=before.calibration)
        if chosen.joints != before.joints:
            self._learning.forget()
            self._comparing.forget()
        if not chosen.starts_as(before):
            self._begin(lambda: Hold(self._comparing.start_world(chosen)))

    def _calibrate(self) -> None:
        teacher = self._who.required()
        self._finish(stopped=True)
        self._activity = Calibrating(teacher, self._activity.world)
        self._say(INVITATION)

    def _follow(self, path: Path | None, plan: Plan = NO_PLAN) -> None:
        teacher, pipeline = self._who.required(), self._choices.pipeline()
        scene = self._comparing.scene(pipeline.arms)
        self._begin(lambda: Follow(teacher, pipeline, path, scene, plan))
        self._say("Recording." if path else "Watching, not recording.")

    def _compare(self, command: commands.CompareCommand) -> None:
        moves = isinstance(command, commands.PlaceBlock | commands.PutBlockBack)
        if moves and not isinstance(self._activity, Hold | Show):
            raise StudioError("Somebody teaches: press Stop first, then move the block")
        words = self._comparing.take(command, self._learning.lesson, self._choices.arms)
        if moves:
            self._begin(lambda: Hold(self._comparing.start_world(self._choices)))
        self._say(words)

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
        now = self._activity
        following = now if isinstance(now, Follow) else None
        newest = following.newest if following else None
        watching = now if isinstance(now, Follow | Calibrating) else None
        shown = watching or self._who.chosen
        show = now if isinstance(now, Show) else None
        seen = show.seen if show else None
        self.snapshot = Snapshot(
            mode=self._learning.mode(now.mode),
            message=self._telling.message,
            time=now.time,
            duration=now.duration,
            choices=self._choices,
            calibrated_with=self._calibrated_with if self._choices.calibration else "",
            calibrating=now.progress if isinstance(now, Calibrating) else None,
            source=self._who.status(),
            live=self._who.live(watching.teacher if watching else None),
            who=self._who.shown(now),
            skeleton=seen.skeleton if seen else shown.skeleton if shown else None,
            gate=newest.gate if newest else None,
            held=newest.held if newest else "",
            guarded=now.guarded,
            lag=newest.lag if newest else NO_LAG,
            alone=show is not None and show.is_alone and show.is_playing,
            world=seen.world if seen else now.world.state,
            entries=tuple(self._listed.entries),
            chosen=self._listed.index,
            collection=self._collection.status(),
            ghost=seen.ghost if seen else None,
            learning=self._learning.status,
            lesson=self._learning.lesson,
            reproduction=self._learning.reproduction,
            compare=self._comparing.status(show, self._learning, self._listed),
            export=self._exporting.status,
            recorded=len(following.samples) if following else 0,
            saved_as=self._taking.saved_as,
        )
