"""Quaternions with w first: two roads to one rotation."""

import numpy as np
import viser.transforms
from scipy.spatial.transform import Rotation

from studio.panels.poses import quaternions, w_first


def test_quaternions_turn_as_the_matrices_do() -> None:
    rotations = Rotation.random(20, rng=np.random.default_rng(0))
    transforms = np.tile(np.eye(4), (20, 1, 1))
    transforms[:, :3, :3] = rotations.as_matrix()
    for wxyz, matrix in zip(quaternions(transforms), rotations.as_matrix(), strict=True):
        np.testing.assert_allclose(viser.transforms.SO3(wxyz).as_matrix(), matrix, atol=1e-12)


def test_w_comes_first() -> None:
    np.testing.assert_array_equal(w_first(np.array([1.0, 2.0, 3.0, 4.0])), (4.0, 1.0, 2.0, 3.0))
