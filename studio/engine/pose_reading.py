"""A pose read off: the person's six angles, Baxter's joints, and what a mapping makes of it."""

from collections.abc import Mapping as Table
from dataclasses import dataclass

import numpy as np

from studio.engine.arm import as_ours
from studio.engine.arms import sides_of
from studio.engine.choices import Choices
from studio.engine.human import Held, HumanArmAngles, arm_vectors, human_arm_angles
from studio.engine.retarget import DRIVEN_JOINTS, MAPPINGS, Angles, Mapping, solve_arm
from studio.engine.robot import load_robot
from studio.engine.skeleton import FloatArray, Side, Skeleton
from studio.engine.vectors import Vector, angle_between

# Which of Baxter's joints turns as which of the person's angles does (the paper's Section II-E).
COUNTERPARTS = {
    "shoulder_yaw": "s0",
    "shoulder_pitch": "s1",
    "shoulder_roll": "e0",
    "elbow_pitch": "e1",
    "elbow_roll": "w0",
    "hand_yaw": "w1",
}


@dataclass(frozen=True)
class ArmReading:
    """One of Baxter's arms and the person's that it follows."""

    robots: Side
    persons: Side
    angles: HumanArmAngles  # [rad]
    joints: Table[str, float]  # [rad] Baxter's, measured, by the names of the person's angles
    # [rad] between the person's forearm and the one that a mapping would give Baxter in this pose,
    # its limits aside; nothing where the arm is not seen
    errors: Table[Mapping, float]


def read_pose(
    skeleton: Skeleton, choices: Choices, joint_positions: FloatArray
) -> tuple[ArmReading, ...]:
    """Return the reading of each driven arm; ``joint_positions`` are Baxter's (15,) [rad]."""
    robot = load_robot()
    readings = []
    for side, persons in zip(sides_of(choices.arms), choices.persons_sides, strict=True):
        joints = {
            angle: float(joint_positions[robot.joint_index(f"{side}_{joint}")])
            for angle, joint in COUNTERPARTS.items()
        }
        angles = human_arm_angles(skeleton, persons)
        errors = _forearm_errors(skeleton, persons, side, choices)
        readings.append(ArmReading(side, persons, angles, joints, errors))
    return tuple(readings)


def _forearm_errors(
    skeleton: Skeleton, persons: Side, side: Side, choices: Choices
) -> dict[Mapping, float]:
    seen = arm_vectors(skeleton, persons)
    if isinstance(seen, Held):
        return {}
    upper_arm, forearm = (
        as_ours(seen.torso.from_camera(bone), choices.mirrored, choices.calibration)
        for bone in (seen.upper_arm, seen.forearm)
    )
    return {
        mapping: angle_between(
            robots_forearm(solve_arm(upper_arm, forearm, side, mapping), side), forearm
        )
        for mapping in MAPPINGS
    }


def robots_forearm(angles: Angles, side: Side) -> Vector:
    """Return the line from Baxter's elbow (e1) to its wrist (w1) in the base's frame [m]."""
    robot = load_robot()
    body = np.zeros(len(robot.joint_names))
    body[[robot.joint_index(f"{side}_{joint}") for joint in DRIVEN_JOINTS]] = angles
    poses = [
        robot.forward_kinematics(f"{side}_{link}", body)
        for link in ("lower_elbow", "lower_forearm")
    ]
    x, y, z = (poses[1][:3, 3] - poses[0][:3, 3]).tolist()
    return (x, y, z)
