"""Where a person seen by a sensor is put in the robot's world, and the way back.

World: the floor below the robot's base; x forward, y to the robot's left, z up. Somebody who faces
the sensor faces the way the robot does.
"""

from dataclasses import dataclass

import numpy as np

from studio.engine.skeleton import FloatArray, Joint, Skeleton

SPOT = (0.1, -1.15)  # [m] ahead and to the left of the robot's axis, where the page's camera looks
# The axes of a person who faces the sensor, in camera space: forward, left, up. A rotation.
WORLD_FROM_CAMERA = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


@dataclass(frozen=True, eq=False)
class Placement:
    """Where camera space lies in the world, for one person: ``world = R · camera + offset``."""

    offset: FloatArray  # (3,) [m]

    @classmethod
    def of(cls, skeleton: Skeleton) -> "Placement":
        """Put a person's hips over the spot beside the robot, and the lowest joint on the floor."""
        turned = skeleton.positions @ WORLD_FROM_CAMERA.T
        spot = SPOT - turned[Joint.SPINE_BASE, :2]
        return cls(np.array([spot[0], spot[1], -turned[:, 2].min()]))

    def place(self, positions: FloatArray) -> FloatArray:
        """Return points (..., 3) [m] of camera space in the world."""
        placed: FloatArray = positions @ WORLD_FROM_CAMERA.T + self.offset
        return placed

    def to_camera(self, points: FloatArray) -> FloatArray:
        """Return points (..., 3) [m] of the world in camera space; undoes `place`."""
        found: FloatArray = (points - self.offset) @ WORLD_FROM_CAMERA
        return found
