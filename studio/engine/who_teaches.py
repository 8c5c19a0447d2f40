"""Who teaches: the puppet, the demonstrator, a person in a file, or a live stream; one of them."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from studio.engine.activity import Activity, Follow
from studio.engine.calibrating import Calibrating
from studio.engine.commands import source as asked
from studio.engine.errors import StudioError
from studio.engine.hand_strip import HandStrip
from studio.engine.live.source import LiveSource
from studio.engine.live.status import LiveStatus, in_short
from studio.engine.puppet import PuppetTeacher
from studio.engine.reading import Reading
from studio.engine.recording import Recording
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.scene import USUAL, Scene
from studio.engine.skeleton import SIDES, HandState
from studio.engine.snapshot import SourceStatus
from studio.engine.sources import SkeletonRecording
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.teachers import FileTeacher, LiveTeacher, Teacher
from studio.engine.who_status import PuppetStatus, WhoStatus

PUPPET_TAKEN = "Source: the puppet. In 2 Teach press Record; then sign, and drag its hand."


@dataclass(frozen=True, eq=False)
class NamedRecording:
    """A recording that was read, and its name for people."""

    recording: Recording
    name: str
    path: Path


class WhoTeaches:
    """See the module. What chooses returns in words what was chosen.

    Parameters
    ----------
    seed
        The demonstrator's.
    live
        Where live streams come in, if any are taken.
    """

    def __init__(self, seed: int, live: LiveSource | None) -> None:
        self.chosen: Teacher | None = None
        self._seed, self._take = seed, 0
        self._demonstrator: Teacher | None = None  # its newest take
        self._scene = USUAL  # what the demonstrator is to do
        self._live = None if live is None else LiveTeacher(live)
        self.puppet = PuppetTeacher()
        self._choices = 0  # made so far, of anything but files
        self._file: asked.UseFile | None = None  # that is the source
        self._bodies: tuple[tuple[str, int | None], ...] = ()  # in it
        self._reading, self._strip = Reading(), HandStrip()

    def take(self, command: asked.SourceCommand) -> str:
        """Do what is asked, and return in words what came of it.

        Raises
        ------
        StudioError
            Where there is no such source, or it is not the one that is chosen.
        """
        match command:
            case asked.UseFile() | asked.FollowBody() | asked.CancelReading():
                return self._take_file(command)
            case asked.UseDemonstrator() | asked.UseLive() | asked.UsePuppet():
                self._choices += 1
                return self._use(command)
            case _:
                self._move_puppet(command)
                return ""

    def tick(self, activity: Activity) -> str | NamedRecording:
        """Let a tick pass, beside what goes on; return what has been read, a source in words.

        Raises
        ------
        FileError
            Where a file that was to be read is of no use.
        """
        watched = activity.teacher if isinstance(activity, Follow | Calibrating) else None
        if self.chosen is self.puppet and watched is not self.puppet:
            self.puppet.idle()
        if isinstance(activity, Follow) and activity.newest is not None:
            self._strip.note(activity.newest.gate, activity.time, CONTROL_PERIOD)
        found = self._reading.poll()
        if found is None:
            return ""
        name = found.file.shown
        if isinstance(found.content, Recording):
            return NamedRecording(found.content, name, found.file.path)
        if found.number != self._choices:
            return f"{name} was read; something else was chosen meanwhile."
        return self._use_file(found.file, found.content)

    def use_demonstrator(self) -> str:
        """Choose the demonstrator's next take."""
        self._take += 1
        words = self.use_stream(demonstrate(self._seed, self._take, scene=self._scene))
        self._demonstrator = self.chosen
        return words

    def in_scene(self, scene: Scene) -> str:
        """Have the demonstrator do another scene's task; return in words what is to be done now.

        Raises
        ------
        StudioError
            Where it is who teaches, and does not know how.
        """
        before, self._scene = self._scene, scene
        if scene == before:
            return ""
        words = f"Scene {scene.name}: {scene.words}"
        if self._demonstrator is None or self.chosen is not self._demonstrator:
            return words
        self.chosen = self._demonstrator = None
        return f"{words} {self.use_demonstrator()}"

    def show_again(self) -> None:
        """Have the demonstrator show another take, if it is who teaches; others do so anyway.

        Raises
        ------
        StudioError
            Where nobody is chosen.
        """
        if self.required() is self._demonstrator:
            self.use_demonstrator()

    def use_stream(self, stream: SkeletonRecording) -> str:
        """Choose the person in a stream."""
        self._choose(FileTeacher(stream))
        hands = "" if stream.has_hand_states else ": it tells no hand states, so open the gate"
        return f"Source: {stream.path}, {stream.frames} frames{hands}"

    def use_live(self) -> str:
        """Choose whoever sends a live stream; raise StudioError where none is taken."""
        if self._live is None:
            raise StudioError("No live streams are taken here: start the studio with its listener")
        self._choose(self._live)
        return f"Source: the live stream. {in_short(self._live.live(is_followed=True))}"

    def required(self) -> Teacher:
        """Return who is chosen; raise StudioError where nobody is."""
        if self.chosen is None:
            raise StudioError(
                "Choose a source first: the puppet, a sample, a file of your own, a live stream, "
                "the demonstrator"
            )
        return self.chosen

    def status(self) -> SourceStatus | None:
        """Return what people should know of who is chosen."""
        return None if self.chosen is None else self.chosen.status()

    def live(self, watched: Teacher | None) -> LiveStatus | None:
        """Return how the live streams stand, while an activity watches ``watched``."""
        if self._live is None:
            return None
        return self._live.live(is_followed=watched is self._live)

    def shown(self, activity: Activity) -> WhoStatus:
        """Return what people see of who teaches, beside the source itself."""
        bodies, body = self._bodies, None if self._file is None else self._file.body
        if self._live is not None and self.chosen is self._live:
            bodies, body = self._live.bodies()
        return WhoStatus(
            reading=self._reading.status,
            puppet=_shown(self.puppet) if self.chosen is self.puppet else None,
            strip=self._strip.runs if isinstance(activity, Follow) else (),
            bodies=bodies,
            body=body,
            files=self._reading.files | ({self._file.path} if self._file else set()),
        )

    def close(self) -> None:
        """Give up what is being read."""
        self._reading.close()

    def _choose(self, teacher: Teacher) -> None:
        self.chosen, self._file, self._bodies = teacher, None, ()

    def _use(self, command: asked.UseDemonstrator | asked.UseLive | asked.UsePuppet) -> str:
        match command:
            case asked.UseDemonstrator():
                return self.use_demonstrator()
            case asked.UseLive():
                return self.use_live()
            case asked.UsePuppet():
                self._choose(self.puppet)
                return PUPPET_TAKEN

    def _take_file(self, command: asked.FileCommand) -> str:
        match command:
            case asked.UseFile():
                return self._read(command)
            case asked.FollowBody(body):
                if self._live is not None and self.chosen is self._live:
                    self._live.follow(body)
                    return "Following whom you chose." if body else "Following who is nearest."
                if self._file is None:
                    raise StudioError(
                        "Take a file or a live stream first: there you choose whom to follow"
                    )
                return self._read(replace(self._file, body=body))
            case asked.CancelReading():
                return self._reading.cancel()

    def _read(self, file: asked.UseFile) -> str:
        self._reading.read(file, self._choices)
        return f"Reading {file.shown}."

    def _use_file(self, file: asked.UseFile, stream: SkeletonRecording) -> str:
        words = self.use_stream(stream)
        self._file, self._bodies = file, tuple(stream.bodies.items())
        if len(self._bodies) > 1 and file.body is None:
            words += f"; of {len(self._bodies)} bodies in it the nearest is followed"
        return words

    def _move_puppet(self, command: asked.PuppetCommand) -> None:
        if self.chosen is not self.puppet:
            raise StudioError("Take the puppet first, in 1 Source: then it can be dragged")
        match command:
            case asked.DragHand(side, point):
                self.puppet.drag_hand(side, np.array(point))
            case asked.DragElbow(side, point):
                self.puppet.drag_elbow(side, np.array(point))
            case asked.ReleaseElbow(side):
                self.puppet.release_elbow(side)
            case asked.Sign(side, state):
                self.puppet.sign(side, state)
            case asked.PuppetHome():
                self.puppet.go_home()
                for each in SIDES:
                    self.puppet.sign(each, HandState.UNKNOWN)


def _shown(puppet: PuppetTeacher) -> PuppetStatus:
    now = puppet.memory
    return PuppetStatus(puppet.goals, now.left_sign, now.right_sign)
