"""What the session wants of a robot at this moment: where to be, and whether to send it."""

from dataclasses import dataclass

from studio.engine.activity import Activity, Follow
from studio.engine.arms import Arms, driven_joints, sides_of
from studio.engine.choices import Choices
from studio.engine.robot import JOINT_NAMES
from studio.engine.scene import Scene
from studio.engine.showing import Show
from studio.engine.skeleton import FloatArray
from studio.engine.snapshot import Mode

NOTHING_GOES_ON = "nobody teaches and nothing plays"
GATE_CLOSED = "the gate is closed"
PAUSED = "paused"
TOO_FAST = "played at {speed:g} times real time: a robot goes along at 1 or less, set the speed"


@dataclass(frozen=True, eq=False)
class Wanted:
    """See the module."""

    positions: FloatArray  # (15,) [rad] where the robot on the page is told to be
    permitted: bool  # the gate is armed, or a motion plays
    why_not: str  # what is missing for that, in words
    arms: Arms  # that are driven
    scene: Scene  # what the guard keeps them away from
    gripper: bool = False  # whether the guard has to count with fingers
    driven: bool = False  # by a program's targets, which are for no other robot


def wanted_of(activity: Activity, choices: Choices) -> Wanted:
    """Return what an activity wants after its tick; only the armed gate and playing permit it."""
    positions, why_not = activity.world.state.joint_positions, NOTHING_GOES_ON
    if isinstance(activity, Follow):
        positions, why_not = _followed(activity, positions), _why_not_follow(activity)
    elif isinstance(activity, Show):
        positions, why_not = activity.seen.world.joint_positions, _why_not_play(activity)
    gripper = choices.hands.gripper
    scene = activity.world.scene
    driven = activity.mode is Mode.DRIVEN
    return Wanted(positions, not why_not, why_not, choices.arms, scene, gripper, driven)


def _followed(activity: Follow, measured: FloatArray) -> FloatArray:
    """Return what was sent in the newest tick, the driven arms' other joints as they are told."""
    newest, info = activity.newest, activity.info
    if newest is None:
        return measured
    names = driven_joints(info.arms)
    told = {f"{side}_{wrist}": 0.0 for side in sides_of(info.arms) for wrist in ("w0", "w1", "w2")}
    told |= dict(zip(names, newest.sent[: len(names)].tolist(), strict=True))
    wrists = info.hands.wrist_joints(info.arms)
    told |= dict(zip(wrists, newest.hands.wrist, strict=False))
    positions = measured.copy()
    positions[[JOINT_NAMES.index(name) for name in told]] = list(told.values())
    return positions


def _why_not_follow(activity: Follow) -> str:
    newest = activity.newest
    if newest is None or not newest.gate.armed:
        return GATE_CLOSED
    return ""


def _why_not_play(activity: Show) -> str:
    if not activity.is_playing or not activity.film.is_ready:
        return PAUSED
    speed = activity.timeline.speed
    return TOO_FAST.format(speed=speed) if speed > 1.0 else ""
