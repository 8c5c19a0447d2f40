import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from studio.engine.skeleton import FloatArray
from studio.engine.world_state import REST_SPEED, REST_SPIN, REST_TICKS, BlockWatch, tilt_of


def pose(tilt: float, heading: float = 0.0, yaw: float = 0.0) -> FloatArray:
    """Return the pose (7,) of a block that turned by ``yaw`` and leans towards ``heading``."""
    axis = np.array([-math.sin(heading), math.cos(heading), 0.0])
    lean = Rotation.from_rotvec(tilt * axis) * Rotation.from_euler("z", yaw)
    return np.concatenate([[0.8, 0.2, 0.8], lean.as_quat()])


@settings(deadline=None, derandomize=True)
@given(st.floats(0, math.pi), st.floats(-4, 4), st.floats(-4, 4))
def test_tilt_counts_from_the_upright_whatever_the_heading(
    tilt: float, heading: float, yaw: float
) -> None:
    assert tilt_of(pose(tilt, heading, yaw)) == pytest.approx(tilt, abs=1e-6)


def watched(
    *, touched: bool, degrees: float, speed: float = 0.0, spin: float = 0.0, ticks: int = REST_TICKS
) -> BlockWatch:
    watch = BlockWatch()
    for _ in range(ticks):
        watch = watch.step(touched, pose(math.radians(degrees)), speed, spin)
    return watch


def test_down_takes_touch_and_tilt_and_rest() -> None:
    assert watched(touched=True, degrees=61).down
    assert watched(touched=True, degrees=180).down
    assert not watched(touched=False, degrees=61).down
    assert not watched(touched=True, degrees=59).down
    assert not watched(touched=True, degrees=61, ticks=REST_TICKS - 1).down
    assert watched(touched=True, degrees=61, speed=REST_SPEED, spin=REST_SPIN).down
    assert not watched(touched=True, degrees=61, speed=1.01 * REST_SPEED).down
    assert not watched(touched=True, degrees=61, spin=1.01 * REST_SPIN).down


def test_a_touch_is_remembered_and_a_movement_counts_anew() -> None:
    watch = watched(touched=True, degrees=90).step(False, pose(math.pi / 2), 0.0, 0.0)
    assert watch.touched
    assert watch.down
    moved = watch.step(False, pose(math.pi / 2), 1.0, 0.0)
    assert moved.touched
    assert not moved.down
    assert moved.slow_ticks == 0


def test_what_fell_untouched_is_not_pushed_down_by_a_later_touch() -> None:
    lying, upright = pose(math.pi / 2), pose(0.0)
    watch = BlockWatch()
    for _ in range(REST_TICKS):
        watch = watch.step(False, lying, 0.0, 0.0)
    watch = watch.step(True, lying, 0.0, 0.0)
    assert watch.touched
    assert not watch.down
    for seen in (upright, lying):
        for _ in range(REST_TICKS):
            watch = watch.step(False, seen, 0.0, 0.0)
    assert watch.down  # set upright, and fallen again
