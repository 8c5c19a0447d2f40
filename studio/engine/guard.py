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
from studio.engine.clearance import Clearance, Pairs
from studio.engine.fingers import OPEN
from studio.engine.limits import Command
from studio.engine.robot import Robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray

SOFTNESS = 0.2  # [s] in which an approach would cover the rest of the way to its margin
AT_MARGIN = 0.005  # [m] from the margin on: the arm has stopped, as far as one can see
# Distances change almost linearly within a step; what they bend is caught by trying less.
_SHARES = np.array([[1.0], [0.97], [0.9], [0.7], [0.4], [0.0]])
_BENT = 1.2  # times the ways that each joint's step makes alone: more than all make together
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
    def for_robot(cls, robot: Robot, arms: Arms, wrists: Sequence[str] = ()) -> "Guard":
        """Return the guard of the taught ``arms`` in the studio's own scene.

        ``wrists`` are joints that are driven beside theirs. Fingers count as open, where they
        need most room.
        """
        rest = resting_body(arms)
        fingers = np.full(len(robot.joint_names) - len(rest), OPEN)
        joints = (*driven_joints(arms), *wrists)
        return cls.of(robot, Scene(arms=arms), np.concatenate([rest, fingers]), joints)

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
        lines = self._lines(np.stack([sent_before, command]))
        pairs = self._that_may_bite(lines[0], self.clearance.travels(lines[0], lines[1]), elapsed)
        before, after = self.clearance.distances(lines, pairs)
        if np.all(after >= _floor(before, pairs, elapsed)):
            return Guarded(command)
        return self._held(sent_before, command, elapsed)

    def _that_may_bite(self, lines: FloatArray, travels: FloatArray, elapsed: float) -> Pairs:
        """Return all pairs that may come below their floor if they move no more than ``travels``.

        That needs a way of more than the room before the margin, times elapsed / `SOFTNESS`.
        """
        pairs = self.clearance.pairs
        most = pairs.stop + (1.0 + SOFTNESS / elapsed) * travels
        return self.clearance.within(lines, np.minimum(pairs.slow + travels, most))

    def _held(self, sent_before: FloatArray, command: FloatArray, elapsed: float) -> Guarded:
        """Return what may be sent of a command that brings something too near."""
        alone = np.where(np.eye(len(command), dtype=bool), command, sent_before)
        lines = self._lines(np.vstack([sent_before, command, alone]))
        together, *each = self.clearance.travels(lines[0], lines[1:])
        travels = np.maximum(together, _BENT * np.sum(each, axis=0))
        pairs = self._that_may_bite(lines[0], travels, elapsed)
        before, after = self.clearance.distances(lines[:2], pairs)
        floor = _floor(before, pairs, elapsed)
        share = _share(before, after, floor)
        shortened = self._shortened(sent_before, share * (command - sent_before), pairs, floor)
        sent, now = self._slid(shortened, command, pairs, floor)
        worst = int(np.argmin(np.where(after < floor, now - floor, np.inf)))
        one, other = self.clearance.names(pairs, worst)
        distance = float(now[worst])
        stopped = bool(distance <= pairs.stop[worst] + AT_MARGIN)
        words = _words(one, other, distance, stopped)
        return Guarded(sent, words, (one, other), distance, stopped)

    def _shortened(
        self, sent: FloatArray, way: FloatArray, pairs: Pairs, floor: FloatArray
    ) -> FloatArray:
        """Return where the whole of ``way`` leads, or less of it where that is too near."""
        points = sent + _SHARES * way
        kept = np.all(self._distances(points, pairs) >= floor, axis=1)
        kept[-1:] = True  # to stay is always allowed
        found: FloatArray = points[int(np.argmax(kept))]
        return found

    def _slid(
        self, sent: FloatArray, command: FloatArray, pairs: Pairs, floor: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Bring those joints on to the command that lead no nearer; return the distances, too."""
        alone = np.where(np.eye(len(sent), dtype=bool), command, sent)
        apart = self._distances(alone, pairs)
        free = np.all(apart >= floor, axis=1)
        together: FloatArray = np.where(free, command, sent)
        now = self._distances(together, pairs)
        if np.all(now >= floor) or not free.any():
            return together, now
        # Each alone would do, all together not: then the one next to the hand, which moves least.
        last = int(np.flatnonzero(free)[-1])
        return alone[last], apart[last]

    def _lines(self, driven: FloatArray) -> FloatArray:
        return self.clearance.lines(self._body(driven))

    def _distances(self, driven: FloatArray, pairs: Pairs) -> FloatArray:
        return self.clearance.distances(self._lines(driven), pairs)

    def _body(self, driven: FloatArray) -> FloatArray:
        """Return all angles (..., 15) [rad] for those of the driven joints (..., D)."""
        body = np.empty((*driven.shape[:-1], len(self.rest)))
        body[...] = self.rest
        body[..., self.columns] = driven
        return body


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
