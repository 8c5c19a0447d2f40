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
import threading
from collections.abc import Mapping, Sequence
from typing import Self

import numpy as np
from numpy.typing import NDArray

from studio.engine.arms import sides_of
from studio.engine.camera import Camera
from studio.engine.errors import StudioError
from studio.engine.judge import NOBODY, Judge, Sight
from studio.engine.robot import CONTROL_RATE, load_robot
from studio.engine.scene import Block, Desk, Scene, Triple
from studio.engine.servo import Servo
from studio.engine.silence import STDERR, STDOUT, silenced
from studio.engine.skeleton import Side
from studio.engine.world_robot import AROUND_MEETS, DESK_MEETS, POSITION_GAIN, WorldRobot
from studio.engine.world_state import WorldState

with silenced(STDOUT), silenced(STDERR):
    import pybullet

__all__ = ["Block", "Desk", "Scene", "World", "WorldState"]

SUBSTEPS = 8  # physics steps in a control tick
GRAVITY = 9.81  # [m/s²]
SOLVER_ITERATIONS = 30  # leaves joints 0.1 mrad from where more would; 10 leave them 2 mrad

# The share of a target's own velocity that its motor is told beside the position. With it a joint
# that follows steadily is at its target when the tick ends: on the average over the tick it is
# half a tick's way short, and the gain makes of that what is missing here to 1.
FEED_FORWARD = 1.0 - POSITION_GAIN * SUBSTEPS / 2
# Of pictures: the floor, which is left out as it costs a third of the time, the desk, the task's
# block and others; each red, green, blue, alpha.
COLORS = ((1, 1, 1, 0), (0.74, 0.63, 0.5, 1), (0.96, 0.7, 0.16, 1), (0.5, 0.59, 0.66, 1))
ZONE_COLOR, PLATE = (0.35, 0.68, 0.52, 1), 0.001  # a zone's, and half its thickness [m]
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
        self._judge = Judge.of(self.scene)
        self._judged, self._ticks = self._judge.start(), 0
        self._closed = False
        with silenced(STDOUT):
            self._client: int = pybullet.connect(pybullet.DIRECT)
        try:
            self._furnish()
            self._baxter = WorldRobot(self._client, self._robot, looks)
            self._baxter.put(self._targets.tolist())
        except BaseException:
            self.close()
            raise
        self._state = self._observe([NOBODY] * len(self._judge.watched))

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
        self._setpoint = self._servo.step(self._setpoint, self._targets)
        self._baxter.drive(self._setpoint, FEED_FORWARD)
        springs = self._baxter.springs_at(self._state.joint_positions)
        asked = [i for i in range(len(self._judge.watched)) if self._judge.asks(self._judged, i)]
        touching = [NOBODY] * len(self._judge.watched)
        for _ in range(SUBSTEPS):
            self._baxter.press(springs)
            pybullet.stepSimulation(physicsClientId=self._client)
            for i in asked:
                touching[i] |= self._arms_that_touch(self._blocks[self._judge.watched[i]])
        self._ticks += 1
        self._state = self._observe(touching)
        return self._state

    def show(self, state: WorldState) -> None:
        """Put joints and blocks where a state has them, without physics: for pictures of it."""
        self._require_owner()
        client = {"physicsClientId": self._client}
        self._baxter.put([*state.joint_positions.tolist(), *state.fingers.tolist()])
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
        ground: int = pybullet.createMultiBody(0.0, floor, **client)
        pybullet.setCollisionFilterGroupMask(ground, -1, *AROUND_MEETS, **client)
        desk = self.scene.placed_desk
        top = self._box(desk.size, desk.position, 0.0, desk.friction)  # no mass: it does not move
        pybullet.setCollisionFilterGroupMask(top, -1, *DESK_MEETS, **client)
        self._blocks = [
            self._box(block.size, block.position, block.mass, block.friction)
            for block in self.scene.placed_blocks
        ]
        for body in range(2 + len(self._blocks)) if self._looks else ():
            color = COLORS[min(body, len(COLORS) - 1)]
            pybullet.changeVisualShape(body, -1, rgbaColor=color, **client)
        for zone in self.scene.placed_zones if self._looks else ():
            half, at = (*(side / 2 for side in zone.size), PLATE), (*zone.center, desk.top + PLATE)
            look = {"halfExtents": half, "rgbaColor": ZONE_COLOR}
            plate = pybullet.createVisualShape(pybullet.GEOM_BOX, **look, **client)
            pybullet.createMultiBody(0.0, -1, plate, at, **client)  # nothing collides with it

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

    def _arms_that_touch(self, block: int) -> frozenset[Side]:
        """Return the taught arms that touch a block, by pybullet's number of it."""
        taught = sides_of(self.scene.arms)
        return frozenset(side for side in taught if self._baxter.touches(side, block))

    def _observe(self, touching: Sequence[frozenset[Side]]) -> WorldState:
        client = {"physicsClientId": self._client}
        poses = np.array(
            [
                sum(pybullet.getBasePositionAndOrientation(block, **client), start=())
                for block in self._blocks
            ]
        )
        sights = []
        for number, arms in zip(self._judge.watched, touching, strict=True):
            velocity, spin = pybullet.getBaseVelocity(self._blocks[number], **client)
            sights.append(Sight(poses[number], math.hypot(*velocity), math.hypot(*spin), arms))
        self._judged, verdict = self._judge.step(self._judged, sights)
        return WorldState.of(self._ticks / CONTROL_RATE, self._baxter.measured(), poses, verdict)
