"""What the robot's hands do beside its arms: wrists and grippers, each an option, off by default.

The network learns the arms, as the paper's does; a motion that is played brings its hands along, by
the time in it (`HandTrack`), the grip as it was learned (`learned_hands.py`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from studio.engine.arm import ARM_FILTER, ArmStages
from studio.engine.arms import Arms, sides_of
from studio.engine.engage import LONG_UNSEEN, Engage, EngageMemory, Joints, Move
from studio.engine.fingers import fingers_of
from studio.engine.gripper import GripMemory, Gripper
from studio.engine.retarget import Angles
from studio.engine.robot import CONTROL_PERIOD, Robot
from studio.engine.skeleton import FloatArray, Skeleton
from studio.engine.smooth import OneEuroMemory
from studio.engine.wrist import (
    AT_REST,
    WRIST_JOINTS,
    Wrist,
    WristAngles,
    WristMode,
    turning_alike,
)

# Baxter's wrists could turn at 4. Over nine recordings a level hand's tilt is 11° at the 95th
# percentile with 1.5 rad/s, as the arm's joints have, 3.5° with 2.5, and 3.3° with 3 and with 4.
WRIST_SPEED = 2.5  # [rad/s] at most


@dataclass(frozen=True)
class HandOptions:
    """What the hands are to do."""

    gripper: bool = False  # fingers on both hands; the person's right hand works those of each arm
    wrist: WristMode = "zero"

    def wrist_joints(self, arms: Arms) -> tuple[str, ...]:
        """Return the wrists' joints that take commands, as ``left_w0``; none if at zero."""
        joints = () if self.wrist == "zero" else WRIST_JOINTS
        return tuple(f"{side}_{joint}" for side in sides_of(arms) for joint in joints)


PLAIN = HandOptions()


@dataclass(frozen=True)
class HandCommand:
    """What the hands are told in one tick."""

    wrist: tuple[float, ...] = ()  # (W,) [rad] as `HandOptions.wrist_joints`
    closed: bool | None = None  # the grippers; None without fingers

    def targets(self, arms: Arms, options: HandOptions) -> dict[str, float]:
        """Return the targets of all joints that this means, by name."""
        found = dict(zip(options.wrist_joints(arms), self.wrist, strict=True))
        for side in sides_of(arms) if self.closed is not None else ():
            found |= fingers_of(side, bool(self.closed))
        return found


STILL = HandCommand()


@dataclass(frozen=True)
class WristMemory:
    """All that is kept of one wrist."""

    sent: WristAngles = AT_REST
    pointing: OneEuroMemory | None = None  # where the person's hand points
    seen_at: float | None = None  # [s] the tick in which that was last seen
    engaged: EngageMemory | None = None  # None while it has nothing to follow


@dataclass(frozen=True)
class HandsMemory:
    """All that is kept of the hands from one tick to the next."""

    wrists: tuple[WristMemory, ...]  # one an arm; none while they are at zero
    grip: GripMemory = field(default_factory=GripMemory)

    @property
    def wrist(self) -> tuple[float, ...]:
        """What was sent to the wrists (W,) [rad]."""
        return tuple(angle for each in self.wrists for angle in each.sent)


@dataclass(frozen=True)
class Hands:
    """Settings of the hands' stages, for the arms that are driven."""

    options: HandOptions
    wrists: tuple[Wrist, ...]  # one an arm; none while they are at zero
    gripper: Gripper = field(default_factory=Gripper)
    engage: Engage = field(default_factory=Engage)

    @classmethod
    def for_robot(cls, robot: Robot, arms: Arms, options: HandOptions) -> "Hands":
        """Return the stages of the hands of ``arms``."""
        sides = () if options.wrist == "zero" else sides_of(arms)
        return cls(options, tuple(Wrist.for_robot(robot, side) for side in sides))

    def start(self) -> HandsMemory:
        """Return the memory of hands that are open, their wrists at zero."""
        return HandsMemory((WristMemory(),) * len(self.wrists))

    def of_another(self, memory: HandsMemory) -> HandsMemory:
        """Return what still holds when somebody else is seen: where the hands are."""
        wrists = tuple(WristMemory(each.sent) for each in memory.wrists)
        return HandsMemory(wrists, GripMemory(closed=memory.grip.closed))

    def see(
        self,
        memory: HandsMemory,
        stages: Sequence[ArmStages],
        skeleton: Skeleton | None,
        armed: bool,
        time: float,
        is_repeated: bool = False,
    ) -> HandsMemory:
        """Take note of the newest frame; ``stages`` say whose hand each arm follows.

        A repeated picture is a sight of the hands, but no news of where they point.
        """
        if self.options.gripper:
            memory = replace(memory, grip=self.gripper.step(memory.grip, skeleton, armed, time))
        if self.options.wrist != "follow" or skeleton is None:
            return memory
        wrists = tuple(
            _seen(before, each, skeleton, time, is_repeated)
            for before, each in zip(memory.wrists, stages, strict=True)
        )
        return replace(memory, wrists=wrists)

    def moves(
        self, memory: HandsMemory, arms: Sequence[Angles], engaged: Sequence[Move], time: float
    ) -> list[Move]:
        """Return where each wrist goes when the arms go to ``arms``, as softly as these.

        A wrist engages with its arm, ``engaged``, and anew where its person's hand was long unseen.
        """
        moves = []
        for i, before in enumerate(memory.wrists):
            wanted, arm = self._wanted(i, before, arms[i], time), engaged[i].engaged
            if wanted is None or arm is None:
                moves.append(Move(None, None, before.sent))
                continue
            since = before.engaged
            if since is not None and since.since < arm.since:
                since = None
            now, target = self.engage.step(since, before.sent, wanted, time, CONTROL_PERIOD)
            moves.append(Move(now, wanted, target))
        return moves

    def moved(
        self, memory: HandsMemory, sent: Joints, engaged: Sequence[EngageMemory | None]
    ) -> HandsMemory:
        """Return the memory after ``sent`` (W,) [rad]."""
        wrists = [
            replace(before, sent=(sent[3 * i], sent[3 * i + 1], sent[3 * i + 2]), engaged=now)
            for i, (before, now) in enumerate(zip(memory.wrists, engaged, strict=True))
        ]
        return replace(memory, wrists=tuple(wrists))

    def _wanted(
        self, index: int, memory: WristMemory, arm: Angles, time: float
    ) -> WristAngles | None:
        """Return where a wrist belongs when its arm is at ``arm``; None where that is not known."""
        wrist = self.wrists[index]
        if self.options.wrist == "level":
            return wrist.level(arm, memory.sent)
        pointing, seen_at = memory.pointing, memory.seen_at
        if pointing is None or seen_at is None or time - seen_at > LONG_UNSEEN:
            return None
        return wrist.follow(arm, pointing.direction, memory.sent)

    def command(self, memory: HandsMemory) -> HandCommand:
        """Return what the hands are told."""
        closed = memory.grip.closed if self.options.gripper else None
        return HandCommand(memory.wrist, closed)


@dataclass(frozen=True, eq=False)
class HandTrack:
    """What hands did over a motion, by the time in it."""

    options: HandOptions
    times: FloatArray  # (N,) [s], rising from 0
    wrist: FloatArray  # (N, W) [rad]
    closed: NDArray[np.bool_]  # (N,) the grippers

    @classmethod
    def of(
        cls, options: HandOptions, times: FloatArray, commands: Sequence[HandCommand]
    ) -> "HandTrack":
        """Return the track of commands (N) given at ``times`` (N,) [s]."""
        wrist = np.array([each.wrist for each in commands])
        return cls(options, times, wrist, np.array([bool(each.closed) for each in commands]))

    @classmethod
    def mean(cls, tracks: Sequence["HandTrack"], duration: float, rows: int) -> "HandTrack":
        """Return the mean of tracks of one kind in ``rows`` even steps; grips by majority.

        Of the triples that turn a hand alike each track's nearest to the first one's counts, so
        that the mean lies between what the hands did. It may pass a limit by a little.
        """
        shares = np.linspace(0.0, 1.0, rows)
        found = [[each.at(share * float(each.times[-1])) for share in shares] for each in tracks]
        wrists = np.array([[command.wrist for command in each] for each in found])
        for one in range(0, wrists.shape[-1], 3):
            mine = wrists[..., one : one + 3]
            wrists[..., one : one + 3] = turning_alike(mine, mine[0])
        wrist = wrists.mean(axis=0)
        closed = np.mean([[bool(command.closed) for command in each] for each in found], axis=0)
        return cls(tracks[0].options, duration * shares, wrist, closed > 0.5)

    def at(self, time: float) -> HandCommand:
        """Return what the hands are told at ``time`` [s]: wrists are interpolated, grips hold."""
        wrist = tuple(float(np.interp(time, self.times, column)) for column in self.wrist.T)
        last = max(int(np.searchsorted(self.times, time, side="right")) - 1, 0)
        return HandCommand(wrist, bool(self.closed[last]) if self.options.gripper else None)


def _seen(
    before: WristMemory, stages: ArmStages, skeleton: Skeleton, time: float, is_repeated: bool
) -> WristMemory:
    """Return the memory after a frame; as it was where the hand is not tracked."""
    pointing = stages.pointing(skeleton)
    if pointing is None:
        return before
    if is_repeated and before.pointing is not None:
        return replace(before, seen_at=time)
    memory, _ = ARM_FILTER.step(before.pointing, pointing, skeleton.time)
    return replace(before, pointing=memory, seen_at=time)
