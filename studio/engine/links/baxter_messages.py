"""Baxter's own messages, built and read: pure functions, so that no network is needed to test them.

Topics, types and numbers are those of Rethink Robotics' SDK (baxter_core_msgs: JointCommand,
AssemblyState; its wiki: "Arm Control Modes", "Robot State and E-Stop", "API Reference"). Whatever a
network brings is looked at before it is believed.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from studio.engine.robot import ARM_JOINTS, JOINT_NAMES
from studio.engine.skeleton import Side

JOINT_STATES = ("/robot/joint_states", "sensor_msgs/JointState")
ROBOT_STATE = ("/robot/state", "baxter_core_msgs/AssemblyState")
ENABLE = ("/robot/set_super_enable", "std_msgs/Bool")
RESET = ("/robot/set_super_reset", "std_msgs/Empty")
_COMMAND = ("/robot/limb/{side}/joint_command", "baxter_core_msgs/JointCommand")
_SPEED = ("/robot/limb/{side}/set_speed_ratio", "std_msgs/Float64")

POSITION_MODE = 1
MOST_JOINTS = 256  # in one message: Baxter tells seventeen, grippers a few more
FARTHEST = 2 * math.pi  # [rad]; no joint of Baxter's turns that far, whatever a message says

_PRESSED, _UNKNOWN, _RELEASED = 1, 2, 3  # AssemblyState.estop_button
_SOURCES = {3: "a joint's fault", 4: "its own computer, which missed a heartbeat"}


@dataclass(frozen=True)
class JointReading:
    """What one message tells of joints that the studio knows."""

    positions: Mapping[str, float]  # [rad] by name; NaN where it is no angle
    stamp: float | None  # [s] by the robot's clock


@dataclass(frozen=True)
class Assembly:
    """What one message tells of the robot as a whole."""

    enabled: bool
    stop: str  # in words; nothing where none holds it
    resets: bool  # whether enabling may end it
    fault: str


def command_topic(side: Side) -> tuple[str, str]:
    """Return where a limb takes commands, and the type."""
    return _COMMAND[0].format(side=side), _COMMAND[1]


def speed_topic(side: Side) -> tuple[str, str]:
    """Return where a limb takes its speed ratio, and the type."""
    return _SPEED[0].format(side=side), _SPEED[1]


def joint_command(side: Side, targets: Mapping[str, float]) -> dict[str, object] | None:
    """Return the command [rad] of one limb, each angle beside its name; None without all seven.

    Baxter's position mode takes any joints of a limb; a limb of which some joints were told and
    others not would hold those where they happen to be.
    """
    names = [f"{side}_{joint}" for joint in ARM_JOINTS]
    if not all(name in targets for name in names):
        return None
    angles = [float(targets[name]) for name in names]
    if not all(math.isfinite(angle) for angle in angles):
        return None
    return {"mode": POSITION_MODE, "names": names, "command": angles}


def joint_reading(message: object) -> JointReading | None:
    """Return what a sensor_msgs/JointState tells, in any order; None where it makes no sense."""
    if not isinstance(message, Mapping):
        return None
    names, angles = message.get("name"), message.get("position")
    if not isinstance(names, list) or not isinstance(angles, list):
        return None
    if (
        len(names) != len(angles)
        or len(names) > MOST_JOINTS
        or len({*map(str, names)}) < len(names)
    ):
        return None
    told = {
        name: _angle(value)
        for name, value in zip(names, angles, strict=True)
        if name in JOINT_NAMES
    }
    return JointReading(told, _stamp(message.get("header")))


def assembly(message: object) -> Assembly | None:
    """Return what a baxter_core_msgs/AssemblyState tells; None where it makes no sense."""
    if not isinstance(message, Mapping):
        return None
    flags = [message.get(name) for name in ("enabled", "stopped", "error")]
    if not all(isinstance(flag, bool) for flag in flags):
        return None
    enabled, stopped, error = flags
    button, source = message.get("estop_button", 0), message.get("estop_source", 0)
    stop, resets = _stop(bool(stopped), button, source)
    fault = "It tells of an error in a component." if error else ""
    return Assembly(bool(enabled), stop, resets, fault)


def _stop(stopped: bool, button: object, source: object) -> tuple[str, bool]:
    """Return which stop holds the robot, in words, and whether enabling may end it."""
    if button == _PRESSED:
        return "The e-stop is pressed: make it safe, then turn the red button to release it.", False
    if not stopped and button != _RELEASED:
        return "", False
    if button == _RELEASED:
        return "The e-stop is released, and not reset: enabling resets it.", True
    if source in _SOURCES:
        return f"It was stopped by {_SOURCES[source]}: enabling resets it.", True
    return "It was stopped by a program: enabling resets it.", True


def _angle(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return math.nan
    return float(value) if abs(value) <= FARTHEST else math.nan  # nor does NaN pass


def _stamp(header: object) -> float | None:
    """Return a std_msgs/Header's time [s]; zero is how ROS says none."""
    stamp = header.get("stamp") if isinstance(header, Mapping) else None
    if not isinstance(stamp, Mapping):
        return None
    whole = stamp.get("secs", stamp.get("sec"))
    rest = stamp.get("nsecs", stamp.get("nanosec", 0))
    if isinstance(whole, bool) or not isinstance(whole, int) or not isinstance(rest, int):
        return None
    return float(whole) + 1e-9 * rest if whole else None
