"""The simulated world: Baxter, a desk and building blocks, in pybullet without a window.

Physics runs at 240 Hz, eight whole steps to a control tick. Motors keep to the robot's effort
limits always, and to its velocity limits as far as that effort suffices: in random jumps of all
joints at once they were passed by 2 % in free air, by 15 % where an arm hit the desk.

Each shoulder's s1 carries a spring, as on the real robot, whose motors alone could not hold a
stretched arm (56 of their 50 N m). Rethink Robotics names those springs and publishes no figures,
so ours is a model: a passive torque of -38 N m · cos(s1), the factor that leaves the motor least
to do over all poses: 22 N m at most.
"""

import math
import tempfile
import threading
from collections.abc import Mapping
from typing import Self

import numpy as np
from numpy.typing import NDArray

from studio.engine.arms import sides_of
from studio.engine.camera import Camera
from studio.engine.errors import FileError, StudioError
from studio.engine.robot import (
    BASE_HEIGHT,
    CONTROL_RATE,
    JOINT_NAMES,
    load_robot,
    urdf_path,
    urdf_with_meshes,
    urdf_without_visuals,
)
from studio.engine.scene import Block, Desk, Scene, Triple
from studio.engine.servo import Servo
from studio.engine.silence import STDERR, STDOUT, silenced
from studio.engine.skeleton import SIDES
from studio.engine.world_state import BlockWatch, WorldState

with silenced(STDOUT), silenced(STDERR):
    import pybullet

__all__ = ["Block", "Desk", "Scene", "World", "WorldState"]

SUBSTEPS = 8  # physics steps in a control tick
GRAVITY = 9.81  # [m/s²]
SOLVER_ITERATIONS = 30  # pybullet's usual 50 cost a fifth more, and the task ends the same
S1_SPRING = 38.0  # [N m] at s1 = 0

# The share of a joint's error that its motor takes away in one physics step: half of pybullet's
# usual gain. A stiffer motor brakes harder than the effort limits allow, and overshoots.
POSITION_GAIN = 0.05
# The share of a target's own velocity that its motor is told beside the position. With it a joint
# that follows steadily is at its target when the tick ends: on the average over the tick it is
# half a tick's way short, and the gain makes of that what is missing here to 1.
FEED_FORWARD = 1.0 - POSITION_GAIN * SUBSTEPS / 2
# Of pictures: the floor, which is left out as it costs a third of the time, the desk, the task's
# block and others; each red, green, blue, alpha.
COLORS = ((1, 1, 1, 0), (0.74, 0.63, 0.5, 1), (0.96, 0.7, 0.16, 1), (0.5, 0.59, 0.66, 1))
LIGHT = {"lightDirection": (2.0, 1.0, 4.0), "lightAmbientCoeff": 0.7, "lightDiffuseCoeff": 0.5}
RENDERER = {"renderer": pybullet.ER_TINY_RENDERER, "flags": pybullet.ER_NO_SEGMENTATION_MASK}


class World:
    """A fresh world; the thread that makes it owns it. Same commands, same states, to the bit.

    Parameters
    ----------
    scene
        What stands around the robot, and which arms are taught.
    joint_positions
        Where joints start and are held [rad]; those not named are at zero.
    fingers
        Whether the hands have fingers: more joints, in m, which keep to their effort limit too.
    looks
        Whether pictures can be taken of it; Baxter's meshes take 2 s to read.

    Raises
    ------
    StudioError
        For joints that do not exist, or angles that are not finite or outside the limits; by all
        methods also when another thread calls, or after `close`.
    FileError
        Where the robot's description cannot be used.
    """

    def __init__(
        self,
        scene: Scene | None = None,
        joint_positions: Mapping[str, float] | None = None,
        fingers: bool = False,
        looks: bool = False,
    ) -> None:
        self.scene, self._looks = Scene() if scene is None else scene, looks
        self._robot = load_robot(fingers=True) if fingers else load_robot()
        self._owner = threading.get_ident()
        at_zero = np.zeros(len(self._robot.joint_names))
        self._targets = self._robot.retargeted(at_zero, joint_positions or {})  # [rad]
        self._servo = Servo(self._robot.limits.velocity)
        self._setpoint = self._servo.start(self._targets)
        self._watch, self._ticks = BlockWatch(), 0
        self._closed = False
        with silenced(STDOUT):
            self._client: int = pybullet.connect(pybullet.DIRECT)
        try:
            self._furnish()
            self._place_robot()
        except BaseException:
            self.close()
            raise
        self._state = self._observe(touched=False)

    @property
    def state(self) -> WorldState:
        """The world as the last tick left it."""
        self._require_owner()
        return self._state

    def apply(self, targets: Mapping[str, float]) -> None:
        """Set position targets [rad] of named joints; they hold until they are set anew.

        Raises
        ------
        StudioError
            For a joint that does not exist, and an angle that is not finite or outside the
            limits; then no target changes.
        """
        self._require_owner()
        self._targets = self._robot.retargeted(self._targets, targets)

    def step(self) -> WorldState:
        """Let one control tick of 1/30 s pass and return what it led to."""
        self._require_owner()
        self._drive()
        springs = [-S1_SPRING * math.cos(self._state.joint_positions[i]) for i in self._s1]
        motors = [self._motors[i] for i in self._s1]
        touched = self._watch.touched
        for _ in range(SUBSTEPS):
            pybullet.setJointMotorControlArray(
                self._body,
                motors,
                pybullet.TORQUE_CONTROL,  # beside the position motor, for one physics step
                forces=springs,
                physicsClientId=self._client,
            )
            pybullet.stepSimulation(physicsClientId=self._client)
            touched = touched or self._arm_touches_block()
        self._ticks += 1
        self._state = self._observe(touched)
        return self._state

    def show(self, state: WorldState) -> None:
        """Put joints and blocks where a state has them, without physics: for pictures of it."""
        self._require_owner()
        client = {"physicsClientId": self._client}
        joints = [*state.joint_positions.tolist(), *state.fingers.tolist()]
        for motor, angle in zip(self._motors, joints, strict=True):
            pybullet.resetJointState(self._body, motor, angle, **client)
        for block, pose in zip(self._blocks, state.block_poses.tolist(), strict=True):
            pybullet.resetBasePositionAndOrientation(block, pose[:3], pose[3:], **client)

    def picture(self, camera: Camera) -> NDArray[np.uint8]:
        """Return what a camera sees (height, width, 3): red, green, blue."""
        self._require_owner()
        width, height = camera.size
        found = pybullet.getCameraImage(
            width, height, *camera.matrices, **LIGHT, **RENDERER, physicsClientId=self._client
        )
        return np.reshape(np.array(found[2], np.uint8), (height, width, 4))[:, :, :3]

    def close(self) -> None:
        """Free the world's memory; may be called twice."""
        if not self._closed:
            self._require_owner()
            self._closed = True
            pybullet.disconnect(physicsClientId=self._client)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _require_owner(self) -> None:
        if self._closed:
            raise StudioError("this world is closed; make a new one")
        if threading.get_ident() != self._owner:
            raise StudioError("a world belongs to the thread that made it; call it from there")

    def _furnish(self) -> None:
        """Set up physics, the floor, the desk and the blocks."""
        client = {"physicsClientId": self._client}
        pybullet.setGravity(0.0, 0.0, -GRAVITY, **client)
        pybullet.setTimeStep(1.0 / (CONTROL_RATE * SUBSTEPS), **client)
        pybullet.setPhysicsEngineParameter(numSolverIterations=SOLVER_ITERATIONS, **client)
        floor = pybullet.createCollisionShape(pybullet.GEOM_PLANE, **client)
        pybullet.createMultiBody(0.0, floor, **client)
        desk = self.scene.placed_desk
        self._box(desk.size, desk.position, 0.0, desk.friction)  # no mass: it does not move
        self._blocks = [
            self._box(block.size, block.position, block.mass, block.friction)
            for block in self.scene.placed_blocks
        ]
        for body in range(2 + len(self._blocks)) if self._looks else ():
            color = COLORS[min(body, len(COLORS) - 1)]
            pybullet.changeVisualShape(body, -1, rgbaColor=color, **client)

    def _box(self, size: Triple, position: Triple, mass: float, friction: float) -> int:
        client = {"physicsClientId": self._client}
        half = [side / 2 for side in size]
        shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half, **client)
        body: int = pybullet.createMultiBody(mass, shape, basePosition=position, **client)
        sleeps = pybullet.ACTIVATION_STATE_ENABLE_SLEEPING  # else a block creeps by itself
        pybullet.changeDynamics(
            body, -1, lateralFriction=friction, activationState=sleeps, **client
        )
        return body

    def _place_robot(self) -> None:
        """Load the robot and put its joints where they start."""
        client = {"physicsClientId": self._client}
        fingers = len(self._robot.joint_names) > len(JOINT_NAMES)
        self._body = _load_robot(self._client, fingers, self._looks)
        found = [
            pybullet.getJointInfo(self._body, index, **client)
            for index in range(pybullet.getNumJoints(self._body, **client))
        ]
        motors = {info[1].decode(): info[0] for info in found}  # pybullet's order is its own
        self._motors = [motors[name] for name in self._robot.joint_names]
        self._s1 = [self._robot.joint_index(f"{side}_s1") for side in SIDES]
        prefixes = tuple(f"{side}_" for side in sides_of(self.scene.arms))
        self._arm_links = {info[0] for info in found if info[12].decode().startswith(prefixes)}
        # A last bound, which pybullet has for the whole robot only: its fastest joint's.
        arms = [name for side in SIDES for name in self._robot.arm_joints(side)]
        fastest = float(self._robot.limits_of(arms).velocity.max())
        pybullet.changeDynamics(self._body, -1, maxJointVelocity=fastest, **client)
        for motor, angle in zip(self._motors, self._targets.tolist(), strict=True):
            pybullet.resetJointState(self._body, motor, angle, **client)

    def _drive(self) -> None:
        """Tell the motors where to be when this tick ends."""
        self._setpoint = self._servo.step(self._setpoint, self._targets)
        velocities = FEED_FORWARD * self._setpoint.velocities
        limits = self._robot.limits
        for index, motor in enumerate(self._motors):
            # Not setJointMotorControlArray: that one ignores velocity limits.
            pybullet.setJointMotorControl2(
                self._body,
                motor,
                pybullet.POSITION_CONTROL,
                targetPosition=self._setpoint.positions[index],
                targetVelocity=velocities[index],
                positionGain=POSITION_GAIN,
                force=limits.effort[index],
                maxVelocity=limits.velocity[index],
                physicsClientId=self._client,
            )

    def _arm_touches_block(self) -> bool:
        contacts = pybullet.getContactPoints(
            bodyA=self._body, bodyB=self._blocks[0], physicsClientId=self._client
        )
        # [3] is the robot's link, [9] the normal force: pybullet also lists what is merely near.
        return any(contact[3] in self._arm_links and contact[9] > 0.0 for contact in contacts)

    def _observe(self, touched: bool) -> WorldState:
        client = {"physicsClientId": self._client}
        joints = pybullet.getJointStates(self._body, self._motors, **client)
        poses = np.array(
            [
                np.concatenate(pybullet.getBasePositionAndOrientation(block, **client))
                for block in self._blocks
            ]
        )
        velocity, spin = pybullet.getBaseVelocity(self._blocks[0], **client)
        speeds = math.hypot(*velocity), math.hypot(*spin)
        self._watch = self._watch.step(touched, poses[0], *speeds)
        moving = np.array([joint[:2] for joint in joints])
        return WorldState.of(self._ticks / CONTROL_RATE, moving, poses, self._watch)


def _load_robot(client: int, fingers: bool = False, looks: bool = False) -> int:
    """Load the robot, without its looks unless asked: pybullet reads meshes for 2 s."""
    with tempfile.NamedTemporaryFile(suffix=".urdf") as file, silenced(STDOUT):
        file.write(urdf_with_meshes(fingers) if looks else urdf_without_visuals(fingers))
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
