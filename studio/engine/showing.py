"""An activity: what is on the timeline, at the playhead.

The session's ticks are its clock. It stays after its end, so that people can go back in it.
"""

from studio.engine import commands
from studio.engine.films import Film, LessonFilm
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.snapshot import Mode
from studio.engine.timeline import Timeline
from studio.engine.world import World


class Show:
    """See the module.

    Parameters
    ----------
    film
        What is shown; it plays as soon as its beginning is there.
    before
        The timeline before this one, whose speed and loop stay.
    world
        The robot's, which is left to whatever comes next.
    """

    def __init__(self, film: Film, before: Timeline, world: World) -> None:
        self.film, self.world = film, world
        self.timeline = before.lasting(film.duration)
        self.is_through = False  # it has come to its end for the first time in this very tick
        self._was_through = False
        self._ticks = 0
        self._waits = True  # for the film to be ready
        self.time, self.duration = 0.0, film.duration  # [s] the playhead, and where it ends
        self.seen = film.at(0.0)  # what there is at the playhead

    def step(self) -> bool:
        """Let the playhead go on; there is always another tick."""
        self._ticks += 1
        self.film.advance()
        if self._waits and self.film.is_ready:
            self._waits, self.timeline = False, self.timeline.play(self._now)
        at, before = self.timeline.playhead(self._now), self.time
        ended = self.film.is_whole and (at >= self.duration or at < before)
        self.is_through = ended and not self._was_through
        self._was_through, self.time = self._was_through or ended, at
        self.seen = self.film.at(at)
        return True

    def steer(self, command: commands.TimelineCommand) -> None:
        """Move the playhead as asked; raise StudioError where a time or a speed is impossible."""
        now = self._now
        match command:
            case commands.TogglePlay():
                if self._waits:
                    self._waits = False
                else:
                    self.timeline = self.timeline.toggle(now)
            case commands.Scrub(position):
                self.timeline = self.timeline.scrub(position, now)
            case commands.StepBy(ticks):
                self.timeline, self._waits = self.timeline.step(ticks, now), False
            case _:
                self.timeline = tuned(self.timeline, command, now)
        self.time = self.timeline.playhead(now)  # brought there by people, not begun anew

    def pause(self) -> str:
        """Let it stand; return in words that it does, where it did not before."""
        was_playing = self.is_playing
        self._waits, self.timeline = False, self.timeline.pause(self._now)
        return "Stopped." if was_playing else ""

    def close(self) -> None:
        """Free what the film holds beside the robot's world."""
        self.film.close()

    @property
    def is_playing(self) -> bool:
        """Whether the playhead moves, or is about to."""
        return self._waits or self.timeline.is_playing(self._now)

    @property
    def is_alone(self) -> bool:
        """Whether it is what was learned."""
        return isinstance(self.film, LessonFilm)

    @property
    def guarded(self) -> str:
        """What the guard keeps apart."""
        return self.seen.guarded

    @property
    def mode(self) -> Mode:
        """What to call it: over or paused, nothing goes on."""
        return Mode.PLAYING if self.is_playing else Mode.IDLE

    @property
    def _now(self) -> float:
        return self._ticks * CONTROL_PERIOD


def tuned(timeline: Timeline, command: commands.TimelineCommand, now: float) -> Timeline:
    """Return a timeline with another speed or loop; other commands need something to be shown."""
    match command:
        case commands.SetSpeed(speed):
            return timeline.at_speed(speed, now)
        case commands.SetLoop(loops):
            return timeline.looping(loops, now)
        case _:
            return timeline
