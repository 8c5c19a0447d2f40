"""Poses as viser takes them: quaternions with w first, positions beside them."""

import numpy as np
from scipy.spatial.transform import Rotation

from studio.engine.skeleton import FloatArray


def quaternions(transforms: FloatArray) -> FloatArray:
    """Return the rotations of transforms (N, 4, 4) as quaternions (N, 4), w x y z."""
    return w_first(Rotation.from_matrix(transforms[:, :3, :3]).as_quat())


def w_first(xyzw: FloatArray) -> FloatArray:
    """Return quaternions (..., 4) x y z w, as the engine has them, as w x y z."""
    turned: FloatArray = np.roll(xyzw, 1, axis=-1)
    return turned
