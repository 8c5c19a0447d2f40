"""One arm of the robot: from what is seen of the person's to the angles that it should take.

see (human) -> calibrate, mirror -> smooth -> arm angles (retarget) -> reach. Between frames, and
while the arm is not seen, its directions are carried on for a moment and then held.
"""

from dataclasses import dataclass, replace

from studio.engine.calibration import Calibration
from studio.engine.human import ArmVectors, Held, arm_vectors, torso_frame
from studio.engine.reach import Reach, ReachMemory
from studio.engine.retarget import Angles
from studio.engine.skeleton import Side, Skeleton, other_side
from studio.engine.smooth import OneEuro, OneEuroMemory
from studio.engine.vectors import Vector
from studio.engine.wrist import hand_direction

# Tried on real recordings: jitter a third of the raw mapping's, 50 ms of lag.
TORSO_FILTER = OneEuro(min_cutoff=1.5, beta=1.0)
ARM_FILTER = OneEuro(min_cutoff=1.5, beta=0.7)
# Of news about a bone with an inferred end, half is let through. In the real recordings that tell
# tracking, short runs of inferred joints are 2 to 25 mm from where the tracked frames around them
# say; holding is at 2 to 31 mm, the middle of both at 2 to 18 mm. Runs of a second and more are too
# long to hold, and shake twice as much as tracked ones.
INFERRED_TRUST = 0.5


@dataclass(frozen=True)
class ArmMemory:
    """All that is kept of one arm from one tick to the next."""

    left: OneEuroMemory | None = None  # the torso's axes
    up: OneEuroMemory | None = None
    upper_arm: OneEuroMemory | None = None  # in the torso's frame
    forearm: OneEuroMemory | None = None
    reach: ReachMemory | None = None
    wanted: Angles | None = None  # [rad]; None before the arm was first seen
    seen_at: float | None = None  # [s] the tick of the last new picture of it
    sighted_at: float | None = None  # [s] the same, pictures that are repeated included
    refusal: str = ""  # why the newest frame's arm was refused


@dataclass(frozen=True)
class ArmStages:
    """Settings of the stages before the engagement; `step` does the work."""

    reach: Reach
    mirrored: bool = False
    calibration: Calibration | None = None
    torso_filter: OneEuro = TORSO_FILTER
    arm_filter: OneEuro = ARM_FILTER

    @property
    def persons_side(self) -> Side:
        """The person's arm that this one follows: the same, or in a mirror the other."""
        return other_side(self.reach.side) if self.mirrored else self.reach.side

    def step(
        self, memory: ArmMemory, skeleton: Skeleton | None, time: float, is_repeated: bool = False
    ) -> ArmMemory:
        """Bring the wanted angles up to date at ``time`` [s] with the newest frame, if any.

        A repeated picture, as some recorders write, is a sight of the person but no news.
        """
        if is_repeated and not memory.refusal:
            return replace(self._carry_on(memory, time), sighted_at=time)
        if skeleton is None or is_repeated:
            return self._carry_on(memory, time)
        seen = arm_vectors(skeleton, self.persons_side)
        if isinstance(seen, Held):
            return self._carry_on(replace(memory, refusal=seen.reason), time)
        return self._see(memory, seen, skeleton.time, time)

    def _see(self, memory: ArmMemory, seen: ArmVectors, stamp: float, time: float) -> ArmMemory:
        left_memory, left = self.torso_filter.step(memory.left, seen.torso.y, stamp)
        up_memory, up = self.torso_filter.step(memory.up, seen.torso.z, stamp)
        torso = torso_frame(left, up) or seen.torso
        upper_memory, upper_arm = self.arm_filter.step(
            memory.upper_arm,
            self._as_ours(torso.from_camera(seen.upper_arm)),
            stamp,
            INFERRED_TRUST if seen.upper_arm_inferred else 1.0,
        )
        fore_memory, forearm = self.arm_filter.step(
            memory.forearm,
            self._as_ours(torso.from_camera(seen.forearm)),
            stamp,
            INFERRED_TRUST if seen.forearm_inferred else 1.0,
        )
        reach, wanted = self.reach.step(memory.reach, upper_arm, forearm, time)
        return ArmMemory(
            left_memory, up_memory, upper_memory, fore_memory, reach, wanted, time, time
        )

    def _carry_on(self, memory: ArmMemory, time: float) -> ArmMemory:
        """Extrapolate for a moment, so that one missing frame is no stop; then hold."""
        if memory.upper_arm is None or memory.forearm is None or memory.seen_at is None:
            return memory
        unseen = time - memory.seen_at
        upper_arm = self.arm_filter.ahead(memory.upper_arm, unseen)
        forearm = self.arm_filter.ahead(memory.forearm, unseen)
        reach, wanted = self.reach.step(memory.reach, upper_arm, forearm, time)
        return replace(memory, reach=reach, wanted=wanted)

    def bones(self, skeleton: Skeleton) -> tuple[Vector, Vector] | Held:
        """Return upper arm and forearm of one frame as this arm should take them, unfiltered."""
        seen = arm_vectors(skeleton, self.persons_side)
        if isinstance(seen, Held):
            return seen
        upper_arm, forearm = (seen.torso.from_camera(b) for b in (seen.upper_arm, seen.forearm))
        return self._as_ours(upper_arm), self._as_ours(forearm)

    def pointing(self, skeleton: Skeleton) -> Vector | None:
        """Return where this arm's hand should point, in the base's frame; None where unknown."""
        seen = arm_vectors(skeleton, self.persons_side)
        if isinstance(seen, Held):
            return None
        direction = hand_direction(skeleton, self.persons_side, seen.torso)
        return None if direction is None else self._as_ours(direction)

    def _as_ours(self, direction: Vector) -> Vector:
        return as_ours(direction, self.mirrored, self.calibration)


def as_ours(direction: Vector, mirrored: bool, calibration: Calibration | None) -> Vector:
    """Return a direction of the person's arm, in the torso's frame, as the robot's should take it.

    The lean of the torso is taken away first, and then left and right are exchanged, if asked for.
    """
    if calibration is not None:
        direction = calibration.correct(direction)
    return (direction[0], -direction[1], direction[2]) if mirrored else direction
