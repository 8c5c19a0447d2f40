"""An activity: a program says where joints go, through the limits and guard of every playback.

It is a dead man's switch: without news for `HOLD_AFTER` the robot stands where it is, after
`END_AFTER` nobody drives it any more. Whoever comes back is followed softly, as at the beginning;
but not after a Stop, which a program that just goes on sending may not have noticed.
"""

import math

import numpy as np

from studio.engine.activity import Activity, Hold
from studio.engine.arms import driven_joints, in_words
from studio.engine.choices import Choices
from studio.engine.commands import BeginDriving, DriveCommand, SetJointTarget, Stop
from studio.engine.engage import ARRIVED_WITHIN, EngageMemory, largest
from studio.engine.errors import StudioError
from studio.engine.hands import HandCommand
from studio.engine.performance import joint_columns, send
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.showing import Show
from studio.engine.snapshot import DrivenStatus, Mode
from studio.engine.softly import as_joints, softly
from studio.engine.world import World

HOLD_AFTER = CONTROL_RATE // 2  # ticks without news: half a second
END_AFTER = 2 * CONTROL_RATE  # ticks
SILENT = "The program that drove Baxter has sent nothing for 2 s: Baxter holds still."


class Driven:
    """See the module.

    Parameters
    ----------
    world
        Where the robot stands; it is taken over from the activity before.
    choices
        Say which joints are driven: those of the arms that are taught, and wrists if they turn.
    first
        Where to go.

    Raises
    ------
    StudioError
        Where a joint is none of those; also by `take`.
    """

    mode, duration = Mode.DRIVEN, 0.0

    def __init__(self, world: World, choices: Choices, first: SetJointTarget) -> None:
        self.world, self.time, self.guarded = world, 0.0, ""
        self._choices, self._pipeline = choices, choices.pipeline()
        arms = driven_joints(choices.arms)
        self._arms, self._joints = len(arms), (*arms, *choices.hands.wrist_joints(choices.arms))
        limits = self._pipeline.limits
        measured = world.state.joint_positions[joint_columns(self._joints)]
        self._sent = np.clip(measured, limits.lower, limits.upper)
        self._wanted = self._sent.copy()
        self._closed: bool | None = False if choices.hands.gripper else None
        self._memory: EngageMemory | None = None
        self._silent = 0  # ticks
        self.take(first)

    def take(self, command: SetJointTarget) -> None:
        """Go there from now on; joints that are not named stay with their last targets."""
        wanted = self._wanted.copy()
        for joint, angle in command.targets.items():
            if joint not in self._joints:
                raise StudioError(
                    f"{joint!r:.40} cannot be driven: {in_words(self._choices.arms)} taught means "
                    f"{', '.join(self._joints)}; Configure changes that"
                )
            if not math.isfinite(angle):
                raise StudioError(f"{joint}: an angle is finite, not {angle}")
            wanted[self._joints.index(joint)] = angle
        if command.closed is not None and self._closed is None:
            raise StudioError("there are no fingers to close: Configure the hands with a gripper")
        self._closed = self._closed if command.closed is None else command.closed
        self._wanted = np.clip(wanted, self._pipeline.limits.lower, self._pipeline.limits.upper)
        self._silent = 0

    def step(self) -> bool:
        """Go on for one tick; return False once nobody has driven for long."""
        self._silent += 1
        if self._silent > END_AFTER:
            return False
        if self._silent > HOLD_AFTER:
            self._wanted, self._memory = self._sent.copy(), None
        self._memory, command = softly(
            self._pipeline, self._memory, self._sent, self._wanted, self.time
        )
        self._sent, self.guarded = command.sent, command.guarded
        hands = HandCommand(tuple(self._sent[self._arms :].tolist()), self._closed)
        options = self._choices.hands
        send(self.world, self._choices.arms, self._sent[: self._arms], options, hands)
        self.world.step()
        self.time += CONTROL_PERIOD
        return True

    def close(self) -> None:
        """Nothing to keep."""

    @property
    def status(self) -> DrivenStatus:
        """How it stands."""
        gap = largest(as_joints(self._sent), as_joints(self._wanted))
        return DrivenStatus(
            joints=self._joints,
            follows=self._memory is not None and self._memory.released,
            arrived=gap < ARRIVED_WITHIN,
            holds=self._silent > HOLD_AFTER,
        )


def driven(activity: Activity, choices: Choices, command: SetJointTarget) -> Driven | None:
    """Return what goes on after ``command``: the same, news taken in, or a new one in its world.

    Raises
    ------
    StudioError
        Where somebody teaches or something plays, or a joint cannot be driven.
    """
    if isinstance(activity, Driven):
        activity.take(command)
        return activity
    if not command.targets and command.closed is None:
        return None
    _require_free(activity)
    return Driven(activity.world, choices, command)


class Driving:
    """Whether a program's targets count: after a Stop, by whomever, only once it begins anew."""

    def __init__(self) -> None:
        self.is_stopped = False

    def hear(self, command: object) -> None:
        """Note a Stop."""
        self.is_stopped = self.is_stopped or isinstance(command, Stop)

    def take(self, activity: Activity, choices: Choices, command: DriveCommand) -> Driven | None:
        """Return what goes on after ``command``, if anything else: nothing for a stopped program.

        Raises
        ------
        StudioError
            As `driven` does, and where there is nothing to begin.
        """
        if isinstance(command, BeginDriving):
            if not isinstance(activity, Driven):
                _require_free(activity)
            self.is_stopped = False
            return None
        return None if self.is_stopped else driven(activity, choices, command)


def _require_free(activity: Activity) -> None:
    is_free = isinstance(activity, Hold) or (isinstance(activity, Show) and not activity.is_playing)
    if not is_free:
        raise StudioError("Somebody teaches, or something plays: Stop first, then drive the joints")
