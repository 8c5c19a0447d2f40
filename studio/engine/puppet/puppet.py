"""The puppet's state: where its hands are dragged to, how they get there, and what they sign.

A dragged hand follows like a critically damped spring in the arm's angles, whose pull is cut so
that no hand is ever faster than a person's: a drag that jumps becomes a brisk reach. One `tick` is
one control period, and nothing here is random.
"""

from dataclasses import dataclass, replace

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.puppet.arm import (
    EASY_SWIVEL,
    LEVERS,
    ArmPoints,
    arm_points,
    reaching,
    swivel_towards,
)
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.skeleton import (
    JOINT_COUNT,
    SIDES,
    FloatArray,
    Hand,
    HandState,
    Joint,
    Side,
    Skeleton,
    all_tracked,
)
from studio.engine.standing import DISTANCE, SENSOR_TO_HIP, TRUNK

SIGNS = (HandState.LASSO, HandState.OPEN, HandState.CLOSED, HandState.UNKNOWN)  # the last is none
BODY_ID = "puppet"
_READY_HAND = np.array([0.38, 0.20, -0.20])  # [m] from the left shoulder: before the block, beside
_PARTS = ("elbow", "wrist", "hand", "hand_tip", "thumb")
_MIRROR = np.array([1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class ArmMotion:
    """An arm on its way: angles (4,) as in `studio.engine.puppet.arm`."""

    angles: FloatArray  # [rad]
    speed: FloatArray  # [m/s], of the angles times `LEVERS`
    goal: FloatArray  # [rad]

    @classmethod
    def at_rest(cls, angles: FloatArray) -> "ArmMotion":
        """Return an arm that stays where it is."""
        return cls(angles, np.zeros(4), angles)


@dataclass(frozen=True, eq=False)
class PuppetMemory:
    """All that a puppet is at a moment."""

    left: ArmMotion
    right: ArmMotion
    left_sign: HandState = HandState.UNKNOWN
    right_sign: HandState = HandState.UNKNOWN

    def arm(self, side: Side) -> ArmMotion:
        """Return the arm of that side."""
        return self.left if side == "left" else self.right

    def sign(self, side: Side) -> HandState:
        """Return what the hand of that side shows."""
        return self.left_sign if side == "left" else self.right_sign


@dataclass(frozen=True)
class Puppet:
    """Settings. Points are (3,) [m] in camera space, as a skeleton's.

    Raises
    ------
    StudioError
        Where a setting is not positive, or too quick for a tick.
    """

    hand_speed: float = 1.2  # [m/s] at most, that of a brisk reach; an elbow's is below 1.5 times
    quickness: float = 12.0  # [1/s] of the spring: a hand dragged steadily is 2 / quickness behind

    def __post_init__(self) -> None:
        if not (0.0 < self.hand_speed < np.inf and 0.0 < self.quickness * CONTROL_PERIOD <= 1.0):
            raise StudioError(
                "a puppet's hand speed is above 0 m/s and its quickness from 0 to "
                f"{1.0 / CONTROL_PERIOD:.0f} 1/s, not {self.hand_speed} and {self.quickness}"
            )

    def start(self) -> PuppetMemory:
        """Return a puppet that holds both hands before it, ready to push, and signs nothing."""
        ready = ArmMotion.at_rest(reaching(_READY_HAND, EASY_SWIVEL))
        return PuppetMemory(ready, ready)

    def drag_hand(self, memory: PuppetMemory, side: Side, point: FloatArray) -> PuppetMemory:
        """Let a hand go to a point, or as near as the arm reaches; the elbow keeps its swivel.

        Raises StudioError where the point is not three finite numbers; so does `drag_elbow`.
        """
        arm = memory.arm(side)
        goal = reaching(_from_shoulder(point, side), float(arm.goal[3]))
        return _with_arm(memory, side, replace(arm, goal=goal))

    def drag_elbow(self, memory: PuppetMemory, side: Side, point: FloatArray) -> PuppetMemory:
        """Let an elbow swing towards a point, about the line from shoulder to hand."""
        arm = memory.arm(side)
        swivel = swivel_towards(arm.goal, _from_shoulder(point, side))
        return _with_arm(memory, side, replace(arm, goal=np.append(arm.goal[:3], swivel)))

    def release_elbow(self, memory: PuppetMemory, side: Side) -> PuppetMemory:
        """Let an elbow go back to where it hangs easily."""
        arm = memory.arm(side)
        return _with_arm(memory, side, replace(arm, goal=np.append(arm.goal[:3], EASY_SWIVEL)))

    def go_home(self, memory: PuppetMemory) -> PuppetMemory:
        """Let both arms go back to where they started, at their own speed; signs stay."""
        home = self.start()
        for side in SIDES:
            arm = replace(memory.arm(side), goal=home.arm(side).goal)
            memory = _with_arm(memory, side, arm)
        return memory

    def sign(self, memory: PuppetMemory, side: Side, state: HandState) -> PuppetMemory:
        """Let a hand show a sign until the next one; raise StudioError unless it is in `SIGNS`."""
        if state not in SIGNS:
            known = ", ".join(sign.value for sign in SIGNS)
            raise StudioError(f"a puppet's hand shows {known}, not {state!r}")
        if side == "left":
            return replace(memory, left_sign=state)
        return replace(memory, right_sign=state)

    def tick(self, memory: PuppetMemory) -> PuppetMemory:
        """Let one control period pass."""
        return replace(memory, left=self._moved(memory.left), right=self._moved(memory.right))

    def skeleton(self, memory: PuppetMemory, time: float) -> Skeleton:
        """Return the puppet as a sensor would see it at ``time`` [s], without any noise."""
        points = np.zeros((JOINT_COUNT, 3))
        for joint, place in TRUNK.items():
            points[joint] = place
        for side in SIDES:
            shoulder = points[Joint.of("shoulder", side)]
            for part, offset in zip(_PARTS, _parts(memory.arm(side).angles, side), strict=True):
                points[Joint.of(part, side)] = shoulder + offset
        left, right = Hand(memory.left_sign), Hand(memory.right_sign)
        return Skeleton(time, _into_camera(points), all_tracked(), left, right, BODY_ID)

    def goals(self, memory: PuppetMemory) -> dict[Joint, FloatArray]:
        """Return where hands and elbows (3,) [m] are going, for the handles that drag them."""
        goals: dict[Joint, FloatArray] = {}
        for side in SIDES:
            elbow, _, hand, _, _ = _parts(memory.arm(side).goal, side)
            shoulder = np.array(TRUNK[Joint.of("shoulder", side)])
            goals[Joint.of("hand", side)] = _into_camera(shoulder + hand)
            goals[Joint.of("elbow", side)] = _into_camera(shoulder + elbow)
        return goals

    def _moved(self, arm: ArmMotion) -> ArmMotion:
        """Move an arm by the exact solution of a critically damped spring over one period.

        With the pull cut to that of a gap of 2 v / ω, a speed of at most v stays at most v. Such a
        spring never swings past a goal that it was always pulled to, nor past a limit that none of
        its goals is beyond: what is allowed is convex, so that the angles stay in it by themselves.
        """
        rate, span = self.quickness, CONTROL_PERIOD
        gap = (arm.goal - arm.angles) * LEVERS
        length = float(np.linalg.norm(gap))
        longest = 2.0 * self.hand_speed / rate
        pull = gap * (longest / length) if length > longest else gap
        decay = float(np.exp(-rate * span))
        lead = arm.speed - rate * pull
        moved = pull - decay * (pull - span * lead)
        speed = decay * (arm.speed - rate * span * lead)
        return ArmMotion(arm.angles + moved / LEVERS, speed, arm.goal)


def _parts(angles: FloatArray, side: Side) -> tuple[FloatArray, ...]:
    """Return elbow, wrist, hand, tip and thumb (3,) [m] from that side's shoulder."""
    at: ArmPoints = arm_points(angles)
    points = (at.elbow, at.wrist, at.hand, at.tip, at.thumb)
    return points if side == "left" else tuple(point * _MIRROR for point in points)


def _with_arm(memory: PuppetMemory, side: Side, arm: ArmMotion) -> PuppetMemory:
    return replace(memory, left=arm) if side == "left" else replace(memory, right=arm)


def _into_camera(points: FloatArray) -> FloatArray:
    """Return points (..., 3) [m] of the torso's frame in camera space."""
    forward, left, up = points[..., 0], points[..., 1], points[..., 2]
    return np.stack([-left, SENSOR_TO_HIP + up, DISTANCE - forward], axis=-1)


def _from_shoulder(point: FloatArray, side: Side) -> FloatArray:
    """Return a point (3,) [m] of camera space from a shoulder, as if that were the left one."""
    at = np.asarray(point, dtype=float)
    if at.shape != (3,) or not np.isfinite(at).all():
        raise StudioError(f"a puppet is dragged to three finite numbers, not to {point!r}")
    torso = np.array([DISTANCE - at[2], -at[0], at[1] - SENSOR_TO_HIP])
    offset: FloatArray = torso - TRUNK[Joint.of("shoulder", side)]
    return offset if side == "left" else offset * _MIRROR
