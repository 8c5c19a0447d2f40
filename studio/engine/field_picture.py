"""A learned field as people can see it: in the plane of the demonstrations, with rollouts.

A field lives in the space of all learned joints. Its plane goes through the goal, along the two
directions in which the demonstrations spread most; arrows are the field on that plane, and rollouts
begin on it and are seen from straight above it. Beside the stable field stands the plain one of the
paper's Eq. 5, taught the same leg with as many neurons. Who learned the single plain field sees it
alone, taught the whole motion: its goal is where the demonstrations end.
"""

from dataclasses import dataclass, replace

import numpy as np

from studio.engine.demonstration import SAMPLES
from studio.engine.errors import StudioError
from studio.engine.field_motion import Demonstrations, OnePlainField, PushAndReturn, legs_of
from studio.engine.field_motion import split_where_time_restarts as split
from studio.engine.skeleton import FloatArray
from studio.engine.teaching import INDEX_TIME, Lesson
from studio.rbf import PlainField, StableField

LEGS = ("there", "back")
ACROSS, ALONG = 13, 7  # arrows
STEPS = 60  # of a rollout,
LONGEST = 2.5  # which lasts so many times as long as its leg took
ROOM = 0.12  # of the demonstrations' spread along a direction, around them
LEAST = 0.25  # [rad] to either side of the goal or the demonstrations, where they spread little
_NO_FIELD = "No field is shown: train a field in 3 Learn"
STARTS = ((0.0, 0.0), (0.1, 0.7), (0.35, -0.7))  # shares of the way to the goal, and of the width


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane in the space of the learned joints."""

    goal: FloatArray  # (D,) [rad]
    axes: FloatArray  # (2, D), orthonormal
    low: FloatArray  # (2,) [rad] the corner of what is shown
    high: FloatArray  # (2,) [rad] the opposite one

    @classmethod
    def through(cls, goal: FloatArray, rows: FloatArray) -> "Plane":
        """Return the plane through ``goal`` along which rows (n, D) spread most."""
        spread = np.linalg.svd(rows - goal, full_matrices=False)[2]
        axes = np.zeros((2, len(goal)))
        axes[: min(2, len(spread))] = spread[:2]  # a single joint's plane has one direction
        places = np.vstack([(rows - goal) @ axes.T, np.zeros((1, 2))])
        low, high = places.min(axis=0), places.max(axis=0)
        room = np.maximum(ROOM * (high - low), LEAST)
        return cls(goal, axes, low - room, high + room)

    def lift(self, places: FloatArray) -> FloatArray:
        """Return the joints (..., D) [rad] of places (..., 2) [rad] on the plane."""
        lifted: FloatArray = self.goal + places @ self.axes
        return lifted

    def drop(self, joints: FloatArray) -> FloatArray:
        """Return where joints (..., D) [rad] are seen on the plane (..., 2) [rad]."""
        dropped: FloatArray = (joints - self.goal) @ self.axes.T
        return dropped

    def kept(self, place: FloatArray) -> FloatArray:
        """Return the nearest place that is shown."""
        return np.clip(place, self.low, self.high)


@dataclass(frozen=True, eq=False)
class Rollouts:
    """Where one start leads, seen on the plane [rad]."""

    start: FloatArray  # (2,)
    stable: FloatArray | None  # (61, 2)
    plain: FloatArray  # (61, 2)


@dataclass(frozen=True, eq=False)
class FieldPicture:
    """One leg of a lesson, to be drawn."""

    lesson: Lesson
    leg: int  # of `legs`
    legs: int
    plane: Plane
    demonstrations: tuple[FloatArray, ...]  # (T, 2) [rad] each
    places: FloatArray  # (A, 2) [rad] of arrows
    stable: FloatArray | None  # (A, 2) [rad a sample of the 142] the stable field's arrows
    plain: FloatArray  # (A, 2) the plain one's
    rollouts: tuple[Rollouts, ...]

    @property
    def missed(self) -> float:
        """How far [rad] from the goal the plain field's rollouts end, at the most."""
        ends = [np.linalg.norm(each.plain[-1]) for each in self.rollouts]
        return float(max(ends))


@dataclass(frozen=True, eq=False)
class _Fields:
    """What was learned of one leg."""

    goal: FloatArray  # (D,) [rad]
    plain: PlainField
    stable: StableField | None


class FieldView:
    """Draws the picture of a lesson's fields, anew where something has changed."""

    def __init__(self) -> None:
        self.picture: FieldPicture | None = None
        self._leg = 0
        self._fields: _Fields | None = None
        self._step = 1.0

    def look_at(self, lesson: Lesson | None) -> FieldPicture | None:
        """Return the picture of a lesson's fields, or None where it has none."""
        model = None if lesson is None else lesson.model
        if lesson is None or not isinstance(model, PushAndReturn | OnePlainField):
            self.picture = None
        elif self.picture is None or self.picture.lesson is not lesson:
            self._draw(lesson, model)
        return self.picture

    def show_leg(self, leg: int) -> None:
        """Show another leg; raise StudioError where there is none."""
        picture = self._required()
        if not 0 <= leg < picture.legs:
            raise StudioError("This motion has no such leg")
        self._leg, self.picture = leg, None

    def place_start(self, index: int, u: float, v: float) -> None:
        """Let a rollout begin elsewhere; raise StudioError where there is no such rollout."""
        picture = self._required()
        if not (0 <= index < len(picture.rollouts) and np.isfinite([u, v]).all()):
            raise StudioError("There is no such start point")
        start = picture.plane.kept(np.array([u, v]))
        rollouts = list(picture.rollouts)
        (rollouts[index],) = self._rolled_out(picture.plane, start[np.newaxis])
        self.picture = replace(picture, rollouts=tuple(rollouts))

    def _required(self) -> FieldPicture:
        if self.picture is None:
            raise StudioError(_NO_FIELD)
        return self.picture

    def _draw(self, lesson: Lesson, model: PushAndReturn | OnePlainField) -> None:
        legs = len(model.fields) if isinstance(model, PushAndReturn) else 1
        self._leg = min(self._leg, legs - 1)
        leg, fields = _learned(lesson, model, self._leg)
        stable, self._fields = fields.stable, fields
        self._step = LONGEST * max(times[-1] - times[0] for times, _ in leg) / STEPS
        plane = Plane.through(fields.goal, np.concatenate([rows for _, rows in leg]))
        shown = tuple(plane.drop(rows) for _, rows in leg)
        places = _grid(plane)
        joints = plane.lift(places)
        begun = np.mean([rows[0] for rows in shown], axis=0)
        self.picture = FieldPicture(
            lesson=lesson,
            leg=self._leg,
            legs=legs,
            plane=plane,
            demonstrations=shown,
            places=places,
            stable=None if stable is None else stable.velocity(joints) @ plane.axes.T,
            plain=fields.plain.velocity(joints) @ plane.axes.T,
            rollouts=self._rolled_out(plane, _starts(plane, begun)),
        )

    def _rolled_out(self, plane: Plane, starts: FloatArray) -> tuple[Rollouts, ...]:
        """Return where starts (n, 2) [rad] lead; all at once, which takes a third of the time."""
        if self._fields is None:
            raise StudioError(_NO_FIELD)
        begin, stable = plane.lift(starts), self._fields.stable
        plain = plane.drop(self._fields.plain.rollout(begin, self._step, STEPS))
        held = None if stable is None else plane.drop(stable.rollout(begin, self._step, STEPS))
        return tuple(
            Rollouts(start, None if held is None else held[:, n], plain[:, n])
            for n, start in enumerate(starts)
        )


def _learned(
    lesson: Lesson, model: PushAndReturn | OnePlainField, leg: int
) -> tuple[Demonstrations, "_Fields"]:
    """Return one leg as the lesson's learner had it, and what it made of that."""
    count = len(lesson.taught.rows)
    taught = split(np.tile(INDEX_TIME, count), lesson.taught.rows.reshape(count * SAMPLES, -1))
    if isinstance(model, OnePlainField):
        goal = np.mean([rows[-1] for _, rows in taught], axis=0)
        return taught, _Fields(goal, model.field, None)
    shown, stable = legs_of(taught)[leg], model.fields[leg]
    plain = PlainField(lesson.settings.neurons).fit(shown)
    return shown, _Fields(stable.goal_, plain, stable)


def _grid(plane: Plane) -> FloatArray:
    """Return places (A, 2) [rad] spread evenly, not on the edge."""
    spaces = (plane.high - plane.low) / (ACROSS, ALONG)
    across, along = (
        low + space * (np.arange(count) + 0.5)
        for low, space, count in zip(plane.low, spaces, (ACROSS, ALONG), strict=True)
    )
    return np.stack(np.meshgrid(across, along), axis=-1).reshape(-1, 2)


def _starts(plane: Plane, begun: FloatArray) -> FloatArray:
    """Return where rollouts begin (n, 2) [rad]: with the demonstrations, and to their sides."""
    half = 0.5 * (plane.high[1] - plane.low[1])
    starts = [begun * (1.0 - along) + np.array([0.0, aside * half]) for along, aside in STARTS]
    return plane.kept(np.stack(starts))
