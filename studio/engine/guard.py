"""The collision guard: no command brings the robot nearer to itself, pedestal or desk than it may.

Where a command would end near something (`body.MARGINS`), the approach is slowed: in each moment by
no more than the rest of the way to the margin over 0.2 s, so that it ends there softly: a velocity
damper, as in Faverjon and Tournassoud, "A local based approach for path planning of manipulators
with a high number of degrees of freedom", ICRA 1987. First the whole step is shortened, which keeps
the path; then each joint whose own rest of the way leads no nearer may go it, from the hand to the
shoulder, so that an arm slides along a desk. A step that brings no pair nearer passes as it is:
the guard never traps.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from studio.engine.arms import Arms, driven_joints, resting_body
from studio.engine.body import may_rest
from studio.engine.clearance import Clearance, Indices, Pairs
from studio.engine.fingers import OPEN
from studio.engine.limits import Command
from studio.engine.robot import Robot
from studio.engine.scene import USUAL, Scene
from studio.engine.skeleton import FloatArray

SOFTNESS = 0.2  # [s] in which an approach would cover the rest of the way to its margin
AT_MARGIN = 0.005  # [m] from the margin on: the arm has stopped, as far as one can see
# Distances change almost linearly within a step; what they bend is caught by trying less.
_SHARES = np.array([[1.0], [0.97], [0.9], [0.7], [0.4], [0.0]])
_LIKELY = 2  # of them, of which one does in most cases
_LAST_BITS = 1e-9  # [m] more than they come to
_ROUNDING = 1e-12  # [m]: an arm that slides along a margin is not held by the last bits


@dataclass(frozen=True, eq=False)
class Guarded:
    """What may be sent, and what stood in the way of more."""

    sent: FloatArray  # (D,) [rad]
    reason: str = ""  # left forearm is 2 cm from the desk: stopped
    pair: tuple[str, str] | None = None
    distance: float = np.inf  # [m] of that pair, at ``sent``
    stopped: bool = False  # it is at its margin, as far as one can see


@dataclass(frozen=True, eq=False)
class Guard:
    """Keeps what D joints move apart from the rest; build it by `of`, `step` does the work."""

    clearance: Clearance
    columns: list[int]  # (D,) of the driven joints among all
    rest: FloatArray  # (15,) [rad] where all other joints are, and its fingers if it has any

    @classmethod
    def for_robot(
        cls, robot: Robot, arms: Arms, wrists: Sequence[str] = (), scene: Scene | None = None
    ) -> "Guard":
        """Return the guard of the taught ``arms``, in the usual scene unless given one.

        ``wrists`` are joints that are driven beside theirs. Fingers count as open, where they
        need most room.
        """
        rest = resting_body(arms)
        fingers = np.full(len(robot.joint_names) - len(rest), OPEN)
        joints = (*driven_joints(arms), *wrists)
        placed = (scene or USUAL).taught_by(arms)
        return cls.of(robot, placed, np.concatenate([rest, fingers]), joints)

    @classmethod
    def of(cls, robot: Robot, scene: Scene, rest: FloatArray, joints: Sequence[str]) -> "Guard":
        """Return the guard of the named joints while all others stay at ``rest`` (15,) [rad]."""
        columns = [robot.joint_index(name) for name in joints]
        return cls(Clearance.of(robot, scene, rest, columns), columns, rest)

    def keep(self, sent_before: FloatArray, command: Command, elapsed: float) -> Command:
        """Return a command inside the limits as what may be sent; see `step`."""
        guarded = self.step(sent_before, command.sent, elapsed)
        if guarded.pair is None:
            return command
        one, other = guarded.pair
        rests = guarded.stopped and may_rest(one, other)
        return replace(
            command,
            sent=guarded.sent,
            guarded=guarded.reason,
            stopped=guarded.stopped,
            resting=f"{one} rests beside the {other}" if rests else "",
        )

    def step(self, sent_before: FloatArray, command: FloatArray, elapsed: float) -> Guarded:
        """Return what may be sent (D,) [rad] in place of ``command`` (D,), after ``sent_before``.

        Both lie inside the position limits, which are convex, and so does the result; it is no
        further from ``sent_before`` than the command in any joint, so velocity limits hold too.
        ``elapsed`` [s] is the time between the two.
        """
        if not np.any(command != sent_before):
            return Guarded(command)
        lines = self.clearance.lines_of(np.array([sent_before, command]))
        which = self._that_bite(lines, elapsed)
        if len(which):
            pairs = self.clearance.pairs.chosen(which)
            before, after = self.clearance.distances(lines, pairs)
            if np.any(after < _floor(before, pairs, elapsed)):
                return self._held(sent_before, command, lines, elapsed)
        return Guarded(command)

    def _that_bite(self, lines: FloatArray, elapsed: float) -> Indices:
        """Return all pairs that may be below their floor after the step between two sets of lines.

        Where the floor is `_floor`, and a pair was at most its travel further apart before, it is
        not below as soon as it is this far apart now.
        """
        pairs, travels = self.clearance.pairs, self.clearance.travels(lines[0], lines[1])
        left = max(1.0 - elapsed / SOFTNESS, 0.0)  # of the room, after the step
        slow = pairs.stop + left * (pairs.slow - pairs.stop)
        most = pairs.stop + max(SOFTNESS / elapsed - 1.0, 0.0) * travels
        return self.clearance.within(lines[1], np.minimum(slow, most))

    def _held(
        self, sent_before: FloatArray, command: FloatArray, lines: FloatArray, elapsed: float
    ) -> Guarded:
        """Return what may be sent of a command that brings something too near.

        ``lines`` (2, C, 4, 2) are the capsules before and after it.
        """
        pairs, before, after, floor = self._near(lines, command - sent_before, elapsed)
        share = _share(before, after, floor)
        sent, now = self._best(sent_before, share * (command - sent_before), command, pairs, floor)
        worst = int(np.argmin(np.where(after < floor, now - floor, np.inf)))
        one, other = self.clearance.names(pairs, worst)
        distance = float(now[worst])
        stopped = bool(distance <= pairs.stop[worst] + AT_MARGIN)
        words = _words(one, other, distance, stopped)
        return Guarded(sent, words, (one, other), distance, stopped)

    def _near(
        self, lines: FloatArray, turns: FloatArray, elapsed: float
    ) -> tuple[Pairs, FloatArray, FloatArray, FloatArray]:
        """Return all pairs that a part of the step may bring below their floors.

        With them, how far each is apart before and after the whole step, and its floor. To come
        below that needs a way of more than the room before the margin, times elapsed / `SOFTNESS`.
        """
        pairs, travels = self.clearance.pairs, self.clearance.may_travel(turns)
        most = pairs.stop + (1.0 + SOFTNESS / elapsed) * travels
        reach = np.minimum(pairs.slow + travels, most)
        which = self.clearance.within(lines[0], reach)
        before, after = self.clearance.distances(lines, pairs.chosen(which))
        floor = _floor(before, pairs.chosen(which), elapsed)
        kept = np.flatnonzero(before - travels[which] < floor + _LAST_BITS)
        return pairs.chosen(which[kept]), before[kept], after[kept], floor[kept]

    def _best(
        self,
        sent: FloatArray,
        way: FloatArray,
        command: FloatArray,
        pairs: Pairs,
        floor: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """Return the furthest that may be sent, and how far the pairs are apart there.

        First as much of ``way`` as leads nowhere too near; from there on those joints go to the
        command that lead no nearer.
        """
        points = sent + _SHARES * way
        # Mostly one of the first will do, so what may follow on them is looked at, too, at once.
        alone = [_each_alone(point, command) for point in points[:_LIKELY]]
        apart = self._distances(np.concatenate([points[:_LIKELY], *alone]), pairs)
        kept = np.flatnonzero(np.all(apart[:_LIKELY] >= floor, axis=1))
        if len(kept):
            best, count = int(kept[0]), len(sent)
            each = apart[_LIKELY + best * count :][:count]
            return self._slid(points[best], apart[best], alone[best], each, pairs, floor)
        apart = self._distances(points, pairs)
        kept = np.all(apart >= floor, axis=1)
        kept[-1] = True  # to stay is always allowed
        best = int(np.argmax(kept))
        one = _each_alone(points[best], command)
        each = self._distances(one, pairs)
        return self._slid(points[best], apart[best], one, each, pairs, floor)

    def _slid(
        self,
        sent: FloatArray,
        now: FloatArray,
        alone: FloatArray,
        each: FloatArray,
        pairs: Pairs,
        floor: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """Bring those joints on to the command that lead no nearer; return the distances, too.

        ``now`` (P,) and ``each`` (D, P) are they at ``sent`` (D,), and where each joint is brought
        on ``alone`` (D, D).
        """
        free = np.flatnonzero(np.all(each >= floor, axis=1))
        if len(free) > 1:
            together = sent.copy()
            together[free] = alone[free, free]
            now = self._distances(together, pairs)
            if np.all(now >= floor):
                return together, now
        # Each alone would do, all together not: then the one next to the hand, which moves least.
        return (alone[free[-1]], each[free[-1]]) if len(free) else (sent, now)

    def _distances(self, driven: FloatArray, pairs: Pairs) -> FloatArray:
        return self.clearance.distances(self.clearance.lines_of(driven), pairs)


def _each_alone(found: FloatArray, command: FloatArray) -> FloatArray:
    """Return ``found`` (D,) D times, each time with another joint where the command has it."""
    alone = np.empty((len(found), len(found)))
    alone[...] = found
    alone.flat[:: len(found) + 1] = command
    return alone


def _floor(before: FloatArray, pairs: Pairs, elapsed: float) -> FloatArray:
    """Return how near (P,) [m] each pair may be after ``elapsed`` [s].

    Outside its margin it may come nearer softly, inside it no nearer than it is.
    """
    room = np.maximum(np.minimum(before, pairs.slow) - pairs.stop, 0.0)
    nearest = pairs.stop + room * max(1.0 - elapsed / SOFTNESS, 0.0)
    floor: FloatArray = np.minimum(before, nearest) - _ROUNDING
    return floor


def _share(before: FloatArray, after: FloatArray, floor: FloatArray) -> float:
    """Return the share of a step after which the first pair is down on its floor."""
    bites = after < floor
    return float(((before - floor)[bites] / (before - after)[bites]).min())


def _words(one: str, other: str, distance: float, stopped: bool) -> str:
    centimeters = max(round(100 * distance), 0)
    what = "stopped" if stopped else "slowed"
    return f"{one} is {centimeters} cm from the {other}: {what}"
