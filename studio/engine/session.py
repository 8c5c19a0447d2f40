"""A session of the studio: one thread owns it, an inbox takes commands, ticks give snapshots.

It reads no clock: `tick` is one control period, whoever calls it and however fast. Only `post` and
`snapshot` may be used from other threads.
"""

import queue
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from studio.engine import commands
from studio.engine.activity import Activity, Follow, Hold, Perform, next_recording_path
from studio.engine.commands import Command
from studio.engine.demonstration import DemonstrationSet, demonstrations_of
from studio.engine.errors import FileError, NothingTaughtError, StudioError
from studio.engine.gate import GateMode
from studio.engine.mcap_file import is_mcap, read_recording
from studio.engine.measures import deviation
from studio.engine.performance import start_world
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording
from studio.engine.retarget import Mapping
from studio.engine.robot import load_robot
from studio.engine.skeleton import Side, Skeleton
from studio.engine.snapshot import Entry, Message, Mode, Snapshot, SourceStatus
from studio.engine.sources import SkeletonRecording, read_skeletons
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.teaching import Lesson, Reproduction, learn


class Session:
    """See the module; ``recordings`` is where new recordings go, ``seed`` the demonstrator's."""

    def __init__(self, recordings: Path, seed: int = 0) -> None:
        self._recordings, self._seed, self._take = recordings, seed, 0
        self._inbox: queue.SimpleQueue[Command] = queue.SimpleQueue()
        self._side: Side = "left"
        self._mapping: Mapping = "exact"
        self._gate: GateMode = "sequence"
        self._stream: SkeletonRecording | None = None
        self._entries: list[Entry] = []
        self._chosen = -1
        self._lesson: Lesson | None = None
        self._reproduction: Reproduction | None = None
        self._message = Message(0, "Ready: choose a source and record, or train on the samples.")
        self._saved_as = ""
        self._activity: Activity = Hold(start_world(self._side, self._mapping))
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

    def close(self) -> None:
        """End the session; what is being recorded is kept."""
        try:
            self._activity.close()
        finally:
            self._activity.world.close()

    def _attempt(self, work: Callable[[], None]) -> bool:
        """Do some work; an error in a file or a request becomes a message, the session lives."""
        try:
            work()
        except (StudioError, OSError) as error:
            self._say(str(error), is_error=True)
            return False
        return True

    def _step(self) -> None:
        if not self._activity.step():
            self._finish()

    def _take_command(self, command: Command) -> None:  # noqa: C901 - one case a command
        match command:
            case commands.Stop():
                self._finish(stopped=True)
            case commands.UseDemonstrator():
                self._take += 1
                self._use(demonstrate(self._seed, self._take))
            case commands.UseFile():
                self._use_file(command)
            case commands.Configure(side, mapping, gate):
                self._configure(side, mapping, gate)
            case commands.Watch():
                self._follow(None)
            case commands.Record():
                self._follow(next_recording_path(self._recordings))
            case commands.Remove(index):
                self._remove(index)
            case commands.Choose(index):
                self._chosen = self._known(index)
            case commands.Train(settings):
                self._lesson = learn(self._taught(), settings)
                self._reproduction = None
                self._say(f"Learned with {settings.neurons} neurons. Now let Baxter play it.")
            case commands.PlayReproduction():
                self._play_reproduction()
            case commands.PlayDemonstration():
                self._play_demonstration()

    def _use(self, stream: SkeletonRecording, name: str = "") -> None:
        self._stream = replace(stream, path=name) if name else stream
        hands = "" if stream.has_hand_states else ": it tells no hand states, so open the gate"
        self._say(f"Source: {self._stream.path}, {stream.frames} frames{hands}")

    def _use_file(self, command: commands.UseFile) -> None:
        try:
            if is_mcap(command.path):
                self._add(read_recording(command.path), command.shown)
            else:
                self._use(read_skeletons(command.path), command.shown)
        except FileError as error:  # names the copy; the user knows the file by its own name
            raise FileError(str(error).replace(str(command.path), command.shown)) from error

    def _configure(self, side: Side, mapping: Mapping, gate: GateMode) -> None:
        if isinstance(self._activity, Follow):
            raise StudioError("Stop first: arm, mapping and gate stay as they are while teaching")
        moved = (side, mapping) != (self._side, self._mapping)
        self._side, self._mapping, self._gate = side, mapping, gate
        if moved:
            self._lesson = self._reproduction = None
            self._begin(lambda: Hold(start_world(side, mapping)))

    def _follow(self, path: Path | None) -> None:
        stream = self._stream
        if stream is None:
            raise StudioError(
                "Choose a source first: a sample, a file of your own, the demonstrator"
            )
        pipeline = Pipeline.for_robot(load_robot(), self._side, self._mapping, self._gate)
        self._begin(lambda: Follow(stream, pipeline, path))
        self._say("Recording." if path else "Watching, not recording.")

    def _play_reproduction(self) -> None:
        lesson = self._lesson
        if lesson is None:
            raise StudioError("Train first: there is nothing learned to play")
        ghost = self._entries[self._chosen].demonstration if self._entries else None
        self._reproduction = None
        self._begin(lambda: Perform.lesson_alone(lesson, ghost))
        self._say("Baxter does it alone.")

    def _play_demonstration(self) -> None:
        shown = self._entries[self._known(self._chosen)].demonstration
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
        elif isinstance(ended, Perform) and stopped:
            self._say("Stopped.")
        elif isinstance(ended, Perform):
            self._judge(ended)

    def _keep(self, ended: Follow) -> None:
        if ended.writer is None:
            self._say("Stopped watching.")
        elif ended.samples:
            self._saved_as = str(ended.writer.path)
            self._add(ended.recording, ended.writer.path.stem)

    def _judge(self, ended: Perform) -> None:
        down = "The block is down." if ended.world.state.block_down else "The block stands."
        if ended.lesson is not None and ended.lesson is self._lesson:
            taught = ended.lesson.taught
            error = deviation(ended.performance, taught.mean, taught.joints)
            self._reproduction = Reproduction(ended.performance, error)
        self._say(down)

    def _add(self, recording: Recording, name: str) -> None:
        found = demonstrations_of(recording, name)
        down = recording.samples[-1].world.block_down
        self._entries += [Entry(each, down) for each in found]
        if found and self._chosen < 0:
            self._chosen = 0
        if found:
            self._say(recording.warning or f"Added {', '.join(each.name for each in found)}.")
        else:
            held = Counter(sample.held for sample in recording.samples if sample.held)
            why = held.most_common(1)[0][0] if held else "it ended too soon"
            self._say(f"{name}: nothing armed for a second or more: {why}", is_error=True)

    def _remove(self, index: int) -> None:
        removed = self._entries.pop(self._known(index)).demonstration
        self._chosen = min(self._chosen, len(self._entries) - 1)
        self._say(f"Took {removed.name} off the list; its file stays.")

    def _known(self, index: int) -> int:
        if not 0 <= index < len(self._entries):
            raise StudioError("There is no such demonstration on the list")
        return index

    def _taught(self) -> DemonstrationSet:
        """Return the listed demonstrations of the chosen arm and mapping."""
        chosen = (self._side, self._mapping)
        listed = [entry.demonstration for entry in self._entries]
        fitting = [each for each in listed if (each.side, each.mapping) == chosen]
        if not fitting:
            raise NothingTaughtError(
                f"No demonstration by the {self._side} arm with the {self._mapping} mapping: "
                "record one first"
            )
        return DemonstrationSet.of(fitting)

    def _say(self, text: str, is_error: bool = False) -> None:
        self._message = Message(self._message.number + 1, text, is_error)

    def _draw(self) -> Snapshot:
        now = self._activity
        following = now if isinstance(now, Follow) else None
        newest = following.samples[-1] if following and following.samples else None
        return Snapshot(
            mode=_mode(now),
            message=self._message,
            time=now.time,
            duration=now.duration,
            side=self._side,
            mapping=self._mapping,
            gate_mode=self._gate,
            source=None if self._stream is None else SourceStatus.of(self._stream),
            skeleton=following.skeleton if following else _first(self._stream),
            gate=newest.gate if newest else None,
            held=newest.held if newest else "",
            alone=isinstance(now, Perform) and now.lesson is not None,
            world=now.world.state,
            entries=tuple(self._entries),
            chosen=self._chosen,
            ghost=now.ghost if isinstance(now, Perform) else None,
            lesson=self._lesson,
            reproduction=self._reproduction,
            recorded=len(following.samples) if following and following.writer else 0,
            saved_as=self._saved_as,
        )


def _first(stream: SkeletonRecording | None) -> Skeleton | None:
    return stream[0] if stream else None


def _mode(activity: Activity) -> Mode:
    match activity:
        case Perform():
            return Mode.PLAYING
        case Follow() if activity.writer is not None:
            return Mode.RECORDING
        case Follow():
            armed = activity.samples and activity.samples[-1].gate.armed
            return Mode.ARMED if armed else Mode.WATCHING
        case _:
            return Mode.IDLE
