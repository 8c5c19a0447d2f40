"""A camera in the simulated world: where it looks from, and where it sees a point."""

import math
from dataclasses import dataclass

import numpy as np

from studio.engine.scene import Triple
from studio.engine.skeleton import FloatArray

_NEAR, _FAR = 0.1, 12.0  # [m] what is nearer or farther is not drawn
_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Camera:
    """A pinhole camera, upright; the frame is the scene's: the floor below the robot's base."""

    position: Triple = (2.9, 1.15, 1.95)  # [m]
    target: Triple = (0.35, 0.05, 0.92)  # [m] what is in the middle of the picture
    view_angle: float = 38.0  # [deg] from top to bottom
    size: tuple[int, int] = (480, 360)  # [px] width, height

    @property
    def view(self) -> FloatArray:
        """T_camera_scene (4, 4), the camera looking along its own -z with y up, as OpenGL's."""
        eye = np.array(self.position)
        back = eye - np.array(self.target)
        back /= np.linalg.norm(back)
        right = np.cross(_UP, back)
        right /= np.linalg.norm(right)
        rotation = np.stack([right, np.cross(back, right), back])
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = rotation, -rotation @ eye
        return matrix

    @property
    def projection(self) -> FloatArray:
        """The matrix (4, 4) from the camera's frame to clip space, as OpenGL's."""
        width, height = self.size
        scale = 1.0 / math.tan(math.radians(self.view_angle) / 2.0)
        depth = _NEAR - _FAR
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[1, 1] = scale * height / width, scale
        matrix[2, 2:] = (_FAR + _NEAR) / depth, 2.0 * _FAR * _NEAR / depth
        matrix[3, 2] = -1.0
        return matrix

    @property
    def matrices(self) -> tuple[list[float], list[float]]:
        """View and projection as OpenGL has them: 16 numbers each, column by column."""
        return self.view.T.ravel().tolist(), self.projection.T.ravel().tolist()

    def pixels(self, points: FloatArray) -> FloatArray:
        """Return where points (N, 3) [m] are in the picture (N, 2) [px], from its top left.

        They are points of the scene, taken to be before the camera.
        """
        clip = np.column_stack([points, np.ones(len(points))]) @ (self.projection @ self.view).T
        seen = clip[:, :2] / clip[:, 3:]
        width, height = self.size
        pixels: FloatArray = (seen * [1.0, -1.0] + 1.0) / 2.0 * [width, height]
        return pixels
