"""Baxter in pybullet: its bodies, its motors, and what they measure.

It is three bodies there: the torso with the head, and each arm on a root of its own that stands
where the torso does. As the torso never moves, the arms cannot feel each other through it, so this
is the same robot; but an impulse at one joint is worked out for the joints of its arm alone, and a
tick costs three quarters of what it costs in one piece. The bodies do not collide with each other,
nor would the links of one: to keep them apart is the guard's work.
"""

import math
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from studio.engine.errors import FileError
from studio.engine.limbs import limbs_of
from studio.engine.robot import (
    BASE_HEIGHT,
    JOINT_NAMES,
    Robot,
    urdf_path,
    urdf_with_meshes,
    urdf_without_visuals,
)
from studio.engine.servo import Setpoint
from studio.engine.silence import STDERR, STDOUT, silenced
from studio.engine.skeleton import SIDES, FloatArray, Side

with silenced(STDOUT), silenced(STDERR):
    import pybullet

S1_SPRING = 38.0  # [N m] at s1 = 0, see studio.engine.world

# The share of a joint's error that its motor takes away in one physics step: half of pybullet's
# usual gain. A stiffer motor brakes harder than the effort limits allow, and overshoots.
POSITION_GAIN = 0.05
# What collides with what, as pybullet has it: a group, and the groups that one meets. Blocks meet
# everything. What moves of the robot meets blocks and the desk; it cannot reach the floor, above
# which a hand stays 0.2 m. Its torso and the floor meet only blocks.
BLOCKS, DESK, ARMS, AROUND = 1, 2, 64, 128
ARMS_MEET, DESK_MEETS, AROUND_MEETS = (ARMS, BLOCKS | DESK), (DESK, BLOCKS | ARMS), (AROUND, BLOCKS)


@dataclass(frozen=True)
class Motor:
    """A joint that is driven, as pybullet numbers it."""

    body: int
    joint: int
    effort: float  # [N m] at most
    speed: float  # [rad/s] at most


class WorldRobot:
    """Baxter in one of pybullet's worlds, its joints in the order of ``robot.joint_names``.

    Raises
    ------
    FileError
        Where its description cannot be used.
    """

    def __init__(self, client: int, robot: Robot, looks: bool) -> None:
        self._client = client
        bodies = load_bodies(client, len(robot.joint_names) > len(JOINT_NAMES), looks)
        joints = [
            (body, pybullet.getJointInfo(body, number, physicsClientId=client))
            for body in bodies
            for number in range(pybullet.getNumJoints(body, physicsClientId=client))
        ]
        found = {info[1].decode(): (body, info[0]) for body, info in joints}
        limits = zip(robot.limits.effort.tolist(), robot.limits.velocity.tolist(), strict=True)
        self._motors = [
            Motor(*found[name], *limit)
            for name, limit in zip(robot.joint_names, limits, strict=True)
        ]
        self._told: list[tuple[float, float] | None] = [None] * len(self._motors)
        self._springs = [(robot.joint_index(f"{side}_s1"), *found[f"{side}_s1"]) for side in SIDES]
        self._arms = {side: found[f"{side}_s1"][0] for side in SIDES}
        self._asked = _by_body(self._motors)
        self._place = np.argsort([column for _, _, columns in self._asked for column in columns])
        arms = [name for side in SIDES for name in robot.arm_joints(side)]
        self._prepare(bodies, float(robot.limits_of(arms).velocity.max()))

    def put(self, positions: Sequence[float]) -> None:
        """Put the joints at ``positions`` (N,) [rad], at rest and without physics."""
        for motor, angle in zip(self._motors, positions, strict=True):
            pybullet.resetJointState(motor.body, motor.joint, angle, physicsClientId=self._client)

    def drive(self, setpoint: Setpoint, feed_forward: float) -> None:
        """Tell the motors a setpoint; of its velocities the share ``feed_forward``.

        A motor goes on with what it was told last, so only news are told.
        """
        velocities = (feed_forward * setpoint.velocities).tolist()
        news = zip(setpoint.positions.tolist(), velocities, strict=True)
        for index, told in enumerate(news):
            if told == self._told[index]:
                continue
            self._told[index] = told
            motor = self._motors[index]
            # Not setJointMotorControlArray: that one ignores velocity limits.
            pybullet.setJointMotorControl2(
                motor.body,
                motor.joint,
                pybullet.POSITION_CONTROL,
                targetPosition=told[0],
                targetVelocity=told[1],
                positionGain=POSITION_GAIN,
                force=motor.effort,
                maxVelocity=motor.speed,
                physicsClientId=self._client,
            )

    def springs_at(self, positions: FloatArray) -> list[tuple[int, int, float]]:
        """Return body, joint and torque [N m] of the springs for joints at ``positions`` (N,)."""
        return [
            (body, joint, -S1_SPRING * math.cos(positions[index]))
            for index, body, joint in self._springs
        ]

    def press(self, springs: list[tuple[int, int, float]]) -> None:
        """Let springs work in the next physics step, beside the motors."""
        for body, joint, torque in springs:
            pybullet.setJointMotorControl2(
                body,
                joint,
                pybullet.TORQUE_CONTROL,
                force=torque,
                physicsClientId=self._client,
            )

    def measured(self) -> FloatArray:
        """Return all joints (N, 2): position [rad] and velocity [rad/s]."""
        rows = [
            state[:2]
            for body, joints, _ in self._asked
            for state in pybullet.getJointStates(body, joints, physicsClientId=self._client)
        ]
        return np.array(rows)[self._place]

    def touches(self, side: Side, block: int) -> bool:
        """Tell whether an arm pressed on a block in the last physics step."""
        contacts = pybullet.getContactPoints(self._arms[side], block, physicsClientId=self._client)
        # [9] is the normal force: pybullet also lists what is merely near.
        return any(contact[9] > 0.0 for contact in contacts)

    def _prepare(self, bodies: Sequence[int], fastest: float) -> None:
        """Keep the bodies apart, and bound their joints' speeds [rad/s] once more.

        pybullet has that last bound for a body as a whole only: its fastest joint's.
        """
        client = {"physicsClientId": self._client}
        for body in bodies:
            pybullet.changeDynamics(body, -1, maxJointVelocity=fastest, **client)
            for link in range(-1, pybullet.getNumJoints(body, **client)):
                meets = ARMS_MEET if link >= 0 else AROUND_MEETS
                pybullet.setCollisionFilterGroupMask(body, link, *meets, **client)


def load_bodies(client: int, fingers: bool, looks: bool) -> list[int]:
    """Load the robot's bodies, without looks unless asked: pybullet reads meshes for 2 s.

    Raises
    ------
    FileError
        Where pybullet cannot read the description.
    """
    return [_load(client, limb) for limb in _limbs(fingers, looks)]


@cache
def _limbs(fingers: bool, looks: bool) -> list[bytes]:
    """Return the descriptions of the bodies; to parse and write XML takes as long as to load it."""
    return limbs_of(urdf_with_meshes(fingers) if looks else urdf_without_visuals(fingers))


def _load(client: int, description: bytes) -> int:
    # A name of its own: pybullet keeps what it once read from a file.
    with tempfile.NamedTemporaryFile(suffix=".urdf") as file, silenced(STDOUT):
        file.write(description)
        file.flush()
        try:
            body: int = pybullet.loadURDF(
                file.name,
                basePosition=(0.0, 0.0, BASE_HEIGHT),
                useFixedBase=True,
                flags=pybullet.URDF_USE_INERTIA_FROM_FILE,  # else it goes by the shapes
                physicsClientId=client,
            )
        except pybullet.error as error:
            raise FileError(f"{urdf_path()}: pybullet cannot load it; reinstall") from error
    return body


def _by_body(motors: Sequence[Motor]) -> list[tuple[int, list[int], list[int]]]:
    """Return for each body its joints and their columns among all."""
    found: dict[int, tuple[list[int], list[int]]] = {}
    for column, motor in enumerate(motors):
        joints, columns = found.setdefault(motor.body, ([], []))
        joints.append(motor.joint)
        columns.append(column)
    return [(body, *rest) for body, rest in found.items()]
