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
from studio.engine.activity import (
    LONGEST_RECORDING,
    Activity,
    Follow,
    Hold,
    Perform,
    next_recording_path,
)
from studio.engine.calibrating import INVITATION, Calibrating
from studio.engine.calibration import in_words
from studio.engine.choices import Choices
from studio.engine.commands import Command
from studio.engine.errors import FileError, StudioError
from studio.engine.faults import Faults
from studio.engine.listed import Listed, why_nothing_armed
from studio.engine.live.source import LiveSource
from studio.engine.mcap_file import is_recording, read_recording
from studio.engine.measures import deviation
from studio.engine.performance import in_guards_words
from studio.engine.pipeline import NO_LAG
from studio.engine.recording import Recording
from studio.engine.snapshot import Message, Snapshot
from studio.engine.sources import read_skeletons
from studio.engine.teaching import Lesson, Reproduction, learn
from studio.engine.who_teaches import WhoTeaches


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
    """

    def __init__(self, recordings: Path, seed: int = 0, live: LiveSource | None = None) -> None:
        self._recordings = recordings
        self._inbox: queue.SimpleQueue[Command] = queue.SimpleQueue()
        self._choices, self._calibrated_with = Choices(), ""
        self._who = WhoTeaches(seed, live)
        self._listed = Listed()
        self._faults = Faults()
        self._lesson: Lesson | None = None
        self._reproduction: Reproduction | None = None
        self._message = Message(0, "Ready: choose a source and record, or train on the samples.")
        self._saved_as = ""
        self._activity: Activity = Hold(self._choices.start_world())
        self.snapshot = self._draw()

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
        self.snapshot = self._draw()
        return self.snapshot

    @property
    def awaited(self) -> threading.Event | None:
        """What is set when a frame has come that should not wait for its tick."""
        return self._activity.teacher.fresh if isinstance(self._activity, Follow) else None

    def close(self) -> None:
        """End the session; what is being recorded is kept."""
        try:
            self._activity.close()
        finally:
            self._activity.world.close()

    def _attempt(self, work: Callable[[], None]) -> bool:
        """Do some work; an error becomes a message, the session lives."""
        try:
            work()
        except (StudioError, OSError) as error:  # in a file or a request
            self._say(str(error), is_error=True)
            return False
        except Exception as fault:  # of ours: whatever was half done, the robot stops
            self._attempt(self._hold)
            self._say(self._faults.in_words(fault), is_error=True)
            return False
        return True

    def _step(self) -> None:
        if not self._activity.step():
            self._finish()

    def _take_command(self, command: Command) -> None:  # noqa: C901, PLR0912 - one case a command
        match command:
            case commands.Stop():
                self._finish(stopped=True)
            case commands.UseDemonstrator():
                self._say(self._who.use_demonstrator())
            case commands.UseFile():
                self._use_file(command)
            case commands.UseLive():
                self._say(self._who.use_live())
            case commands.Configure():
                self._configure(command.choices)
            case commands.Calibrate():
                self._calibrate()
            case commands.ForgetCalibration():
                self._choices = replace(self._choices, calibration=None)
                self._say("Calibration forgotten.")
            case commands.Watch():
                self._follow(None)
            case commands.Record():
                self._follow(next_recording_path(self._recordings))
            case commands.Remove(index):
                removed = self._listed.remove(index)
                self._say(f"Took {removed.name} off the list; its file stays.")
            case commands.Choose(index):
                self._listed.choose(index)
            case commands.Train(settings):
                chosen = self._choices
                self._lesson = learn(self._listed.taught(chosen.arms, chosen.mapping), settings)
                self._reproduction = None
                self._say(f"Learned with {settings.neurons} neurons. Now let Baxter play it.")
            case commands.PlayReproduction():
                self._play_reproduction()
            case commands.PlayDemonstration():
                self._play_demonstration()

    def _use_file(self, command: commands.UseFile) -> None:
        try:
            if is_recording(command.path):
                self._add(read_recording(command.path), command.shown)
            else:
                self._say(self._who.use_stream(read_skeletons(command.path), command.shown))
        except FileError as error:  # names the copy; the user knows the file by its own name
            raise FileError(str(error).replace(str(command.path), command.shown)) from error

    def _configure(self, chosen: Choices) -> None:
        if isinstance(self._activity, Follow):
            raise StudioError("Stop first: what was chosen stays as it is while teaching")
        before = self._choices
        self._choices = replace(chosen, calibration=before.calibration)
        if chosen.joints != before.joints:
            self._lesson = self._reproduction = None
        if not chosen.starts_as(before):
            self._begin(lambda: Hold(chosen.start_world()))

    def _calibrate(self) -> None:
        teacher = self._who.required()
        self._finish(stopped=True)
        self._activity = Calibrating(teacher, self._activity.world)
        self._say(INVITATION)

    def _follow(self, path: Path | None) -> None:
        teacher, pipeline = self._who.required(), self._choices.pipeline()
        self._begin(lambda: Follow(teacher, pipeline, path))
        self._say("Recording." if path else "Watching, not recording.")

    def _play_reproduction(self) -> None:
        lesson = self._lesson
        if lesson is None:
            raise StudioError("Train first: there is nothing learned to play")
        ghost = self._listed.at(self._listed.chosen) if self._listed.entries else None
        self._reproduction = None
        self._begin(lambda: Perform.lesson_alone(lesson, ghost))
        self._say("Baxter does it alone.")

    def _play_demonstration(self) -> None:
        shown = self._listed.at(self._listed.chosen)
        self._begin(lambda: Perform.replay(shown))
        self._say(f"Replaying {shown.name}.")

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
            self._keep(ended)
        elif stopped and not isinstance(ended, Hold):
            self._say("Stopped.")
        elif isinstance(ended, Calibrating):
            self._take_calibration(ended)
        elif isinstance(ended, Perform):
            self._judge(ended)

    def _keep(self, ended: Follow) -> None:
        if ended.writer is None:
            self._say("Stopped watching.")
        elif ended.samples:
            self._saved_as = str(ended.writer.path)
            self._add(ended.recording, ended.writer.path.stem)
            if ended.is_full:
                self._say(
                    f"{self._message.text} {LONGEST_RECORDING // 60} minutes are the longest."
                )

    def _take_calibration(self, ended: Calibrating) -> None:
        if ended.found is None:
            raise StudioError(f"{ended.refusal}. Press Calibrate to try again")
        self._choices = replace(self._choices, calibration=ended.found)
        self._calibrated_with = ended.teacher.path
        self._say(f"Calibrated for what is taught next: {in_words(ended.found)}.")

    def _judge(self, ended: Perform) -> None:
        down = "The block is down." if ended.world.state.block_down else "The block stands."
        if ended.lesson is not None and ended.lesson is self._lesson:
            taught = ended.lesson.taught
            error = deviation(ended.performance, taught.mean, taught.joints, taught.hands)
            self._reproduction = Reproduction(ended.performance, error)
        self._say(f"{down} {in_guards_words(ended.performance)}".strip())

    def _add(self, recording: Recording, name: str) -> None:
        found = self._listed.add(recording, name)
        if found:
            self._say(recording.warning or f"Added {', '.join(each.name for each in found)}.")
        else:
            self._say(why_nothing_armed(recording, name), is_error=True)

    def _say(self, text: str, is_error: bool = False) -> None:
        self._message = Message(self._message.number + 1, text, is_error)

    def _draw(self) -> Snapshot:
        now = self._activity
        following = now if isinstance(now, Follow) else None
        newest = following.newest if following else None
        watching = now if isinstance(now, Follow | Calibrating) else None
        shown = watching or self._who.chosen
        return Snapshot(
            mode=now.mode,
            message=self._message,
            time=now.time,
            duration=now.duration,
            choices=self._choices,
            calibrated_with=self._calibrated_with if self._choices.calibration else "",
            calibrating=now.progress if isinstance(now, Calibrating) else None,
            source=self._who.status(),
            live=self._who.live(watching.teacher if watching else None),
            skeleton=shown.skeleton if shown else None,
            gate=newest.gate if newest else None,
            held=newest.held if newest else "",
            guarded=now.guarded,
            guarded_ticks=now.guarded_ticks if isinstance(now, Perform) else 0,
            lag=newest.lag if newest else NO_LAG,
            alone=isinstance(now, Perform) and now.lesson is not None,
            world=now.world.state,
            entries=tuple(self._listed.entries),
            chosen=self._listed.chosen,
            ghost=now.ghost if isinstance(now, Perform) else None,
            lesson=self._lesson,
            reproduction=self._reproduction,
            recorded=len(following.samples) if following and following.writer else 0,
            saved_as=self._saved_as,
        )
