"""What is compared: the block's place, the lesson kept as B, the field, and all measures."""

from dataclasses import dataclass

from studio.engine import commands
from studio.engine.activity import Activity, Hold
from studio.engine.choices import Choices
from studio.engine.compare_status import Alone, CompareStatus, TimelineStatus, named
from studio.engine.demonstration import DemonstrationSet
from studio.engine.errors import StudioError
from studio.engine.export.material import Take
from studio.engine.field_picture import FieldView
from studio.engine.films import DemonstrationFilm, Film, LessonFilm, Solo
from studio.engine.learning import Learning
from studio.engine.listed import Listed
from studio.engine.measured import Measured, measure_demonstration, measure_performance
from studio.engine.performance import Performance, in_guards_words
from studio.engine.scene import Scene
from studio.engine.showing import Show, tuned
from studio.engine.task_words import task_words
from studio.engine.teaching import Lesson, Reproduction
from studio.engine.timeline import Timeline
from studio.engine.world import World


@dataclass(frozen=True, eq=False)
class _Done:
    """A performance that is over, and what it comes to."""

    lesson: Lesson
    scene: Scene
    performance: Performance


class Comparing:
    """See the module. What is asked for returns in words what came of it."""

    def __init__(self) -> None:
        self.timeline = Timeline()  # whose speed and loop the next show takes over
        self.kept: Lesson | None = None
        self._places: dict[int, tuple[float, float]] = {}  # [m] in the world, of moved blocks
        self._done: list[_Done] = []  # of the newest lesson and the kept one, oldest first
        self._field = FieldView()
        self._table: dict[tuple[object, ...], Measured] = {}  # by what is measured

    def take(
        self, command: commands.CompareCommand, lesson: Lesson | None, choices: Choices
    ) -> str:
        """Do what is asked, with what is learned now and how Baxter is taught.

        Raises
        ------
        StudioError
            Where it can't be done.
        """
        match command:
            case commands.PlaceBlock(x, y, block):
                placed = self.scene(choices).with_block_at(x, y, block)
                at_x, at_y, _ = placed.placed_blocks[block].position
                self._places[block] = (at_x, at_y)
                return "The block stands elsewhere now. Let Baxter do it alone, and watch."
            case commands.PutBlockBack():
                self._places = {}
                return "The block stands where it was taught again."
            case commands.KeepToCompare():
                return self._keep(lesson)
            case commands.ForgetKept():
                self.kept = None
                return "The second robot is gone."
            case commands.PlaceStart(index, u, v):
                self._field.place_start(index, u, v)
            case commands.ShowLeg(leg):
                self._field.show_leg(leg)
        return ""

    def asked(
        self,
        command: commands.TimelineCommand,
        activity: Activity,
        learning: Learning,
        listed: Listed,
    ) -> Film | None:
        """Return what is to be put on the timeline, if anything; else do what is asked with it.

        Raises
        ------
        StudioError
            Where there is nothing to play, or somebody teaches.
        """
        match command:
            case commands.PlayReproduction():
                return self._reproduction(learning, listed)
            case commands.PlayDemonstration(number):
                return DemonstrationFilm(listed.entry(number or listed.chosen).take)
            case commands.TogglePlay() if _is_outdated(activity, learning):
                return self._reproduction(learning, listed)
        if isinstance(activity, Show):
            activity.steer(command)
        elif not isinstance(command, commands.TogglePlay):
            self.timeline = tuned(self.timeline, command, 0.0)
        elif not isinstance(activity, Hold):
            raise StudioError("Somebody teaches: press Stop first")
        elif learning.lesson is None and listed.entries:
            return DemonstrationFilm(listed.entry(listed.chosen).take)
        else:
            return self._reproduction(learning, listed)
        return None

    def forget(self) -> None:
        """Forget all that belongs to other arms, joints or scenes."""
        self.kept, self._places, self._done = None, {}, []

    def start_world(self, choices: Choices) -> World:
        """Return a fresh world in which the robot waits, the block where it was put."""
        return choices.start_world(self.scene(choices))

    def scene(self, choices: Choices) -> Scene:
        """Return what stands around the robot, the blocks where they were put."""
        return self._moved(choices.placed_scene)

    def _moved(self, scene: Scene) -> Scene:
        for block, (x, y) in self._places.items():
            scene = scene.with_block_at(x, y, block)
        return scene

    def judge(self, film: Film, learning: Learning) -> str:
        """Take note of a film that is through; return in words what became of the block."""
        if not isinstance(film, LessonFilm):
            last = film.at(film.duration).world
            return task_words(film.scene).told(last.done, last.missing)
        for solo in film.solos:
            if solo.performance is not None:
                self._note(_Done(solo.lesson, solo.scene, solo.performance), film.lesson)
        first = film.solos[0].performance
        if first is not None:
            learning.judge(film.lesson, first)
        told = [_told(each, film.duration) for each in film.solos]
        return told[0] if len(told) == 1 else f"A: {told[0]} B: {told[1]}"

    def status(self, show: Show | None, learning: Learning, listed: Listed) -> CompareStatus:
        """Return what there is to be drawn."""
        timeline, lesson = show.timeline if show else self.timeline, learning.lesson
        self._learn_of_trial(lesson, learning.reproduction)
        film = show.film if show else None
        solos = film.solos if isinstance(film, LessonFilm) else ()
        return CompareStatus(
            timeline=TimelineStatus(
                title=show.film.title if show else "",
                motion=show.film.motion if show else 0.0,
                is_playing=show is not None and show.is_playing,
                speed=timeline.speed,
                loops=timeline.loops,
            ),
            playing=tuple(Alone(solo.lesson, solo.performance) for solo in solos),
            replayed=film.take if isinstance(film, DemonstrationFilm) else None,
            beside=show.seen.beside if show else None,
            kept=self.kept,
            moved=bool(self._places),
            table=self._measured(lesson, _ghost(listed)),
            field=self._field.look_at(lesson),
        )

    def _reproduction(self, learning: Learning, listed: Listed) -> LessonFilm:
        """Return what was learned, beside B if there is one; what is known is not simulated."""
        lesson = learning.lesson
        if lesson is None:
            raise StudioError("Train first: there is nothing learned to play")
        scene, lessons = self._moved(lesson.taught.scene), [lesson]
        if self.kept is not None and self.kept is not lesson:
            lessons.append(self.kept)
        solos = [Solo(each, scene, self._known(each, scene)) for each in lessons]
        if not all(solo.is_whole for solo in solos):
            learning.reproduction = None  # it comes when the playhead has come to the end
        return LessonFilm(solos, _ghost(listed))

    def _learn_of_trial(self, lesson: Lesson | None, found: Reproduction | None) -> None:
        """Take note of what a lesson came to in a trial, in which no block was moved."""
        if lesson is None or found is None:
            return
        if not any(each.performance is found.performance for each in self._done):
            self._note(_Done(lesson, lesson.taught.scene, found.performance), lesson)

    def _note(self, done: _Done, newest: Lesson) -> None:
        """Take note of what is over as the newest, and forget what nobody compares any more."""
        wanted = [
            each
            for each in self._done
            if any(each.lesson is lesson for lesson in (newest, self.kept))
            and each.performance is not done.performance
        ]
        self._done = [*wanted, done]

    def _keep(self, lesson: Lesson | None) -> str:
        if lesson is None:
            raise StudioError("Train first: there is nothing learned to keep")
        self.kept = lesson
        return f"Kept as B: {named(lesson)}. Learn something else, and let both do it."

    def _known(self, lesson: Lesson, scene: Scene) -> Performance | None:
        for each in self._done:
            if each.lesson is lesson and each.scene == scene:
                return each.performance
        return None

    def _measured(self, lesson: Lesson | None, chosen: Take | None) -> tuple[Measured, ...]:
        """Return the table's columns: what is new is measured, the rest was before."""
        if lesson is None:
            self._table = {}
            return ()
        taught, before = lesson.taught, self._table
        self._table = {}
        if chosen is not None and chosen.demonstration.joints == taught.joints:
            key = (taught, chosen.demonstration)
            self._table[key] = before.get(key) or measure_demonstration(chosen, taught)
        self._add("A", lesson, taught, before)
        if self.kept is not None and self.kept is not lesson:
            self._add("B", self.kept, taught, before)
        return tuple(self._table.values())

    def _add(
        self,
        letter: str,
        lesson: Lesson,
        taught: DemonstrationSet,
        before: dict[tuple[object, ...], Measured],
    ) -> None:
        """Measure the newest performance of a lesson."""
        done = [each.performance for each in self._done if each.lesson is lesson]
        if done:
            key = (letter, taught, done[-1])
            found = before.get(key)
            self._table[key] = found or measure_performance(named(lesson), letter, done[-1], taught)


def _told(solo: Solo, end: float) -> str:
    """Return in words what became of the block, and what kept the robot from what was asked."""
    last = solo.at(end)[0]
    words = task_words(solo.scene).told(last.done, last.missing)
    kept = "" if solo.performance is None else in_guards_words(solo.performance)
    return f"{words} {kept}" if kept else words


def _is_outdated(activity: Activity, learning: Learning) -> bool:
    """Tell whether what lies still on the timeline is what a network did before the newest one."""
    if not isinstance(activity, Show) or activity.is_playing:
        return False
    film, newest = activity.film, learning.lesson
    return isinstance(film, LessonFilm) and newest is not None and film.lesson is not newest


def _ghost(listed: Listed) -> Take | None:
    return listed.entry(listed.chosen).take if listed.entries else None
