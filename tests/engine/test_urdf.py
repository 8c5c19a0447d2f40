from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from studio.engine.errors import FileError
from studio.engine.urdf import Box, Cylinder, Mesh, Sphere, read_urdf, transform

ANGLE = st.floats(-7, 7)
LINK = '<link name="a"><visual><origin xyz="1 2 3"/><geometry>{}</geometry>{}</visual></link>'


def _write(folder: Path, body: str) -> Path:
    path = folder / "thing.urdf"
    path.write_text(f'<robot name="thing">{body}</robot>')
    return path


@settings(deadline=None, derandomize=True)
@given(ANGLE, ANGLE, ANGLE)
def test_roll_pitch_yaw_are_scipys_fixed_axes(roll: float, pitch: float, yaw: float) -> None:
    T = transform(np.array([1.0, 2.0, 3.0]), np.array([roll, pitch, yaw]))
    expected = Rotation.from_euler("xyz", [roll, pitch, yaw]).as_matrix()
    np.testing.assert_allclose(T[:3, :3], expected, atol=1e-12)
    np.testing.assert_array_equal(T[:, 3], [1.0, 2.0, 3.0, 1.0])
    np.testing.assert_array_equal(T[3, :3], 0.0)


@pytest.mark.parametrize(
    ("xml", "shape"),
    [
        ('<box size="1 2 3"/>', Box((1.0, 2.0, 3.0))),
        ('<cylinder radius="1" length="2"/>', Cylinder(1.0, 2.0)),
        ('<sphere radius="1"/>', Sphere(1.0)),
        ('<mesh filename="package://a/b.dae"/>', Mesh("package://a/b.dae")),
    ],
)
def test_each_shape_is_read(tmp_path: Path, xml: str, shape: object) -> None:
    (visual,) = read_urdf(_write(tmp_path, LINK.format(xml, ""))).links[0].visuals
    assert visual.shape == shape
    np.testing.assert_array_equal(visual.T_link_shape[:3, 3], [1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (LINK.format('<capsule radius="1" length="2"/>', ""), "capsule"),
        (LINK.format('<box size="1 2"/>', ""), "not a URDF file of the studio's"),
        (LINK.format('<box size="1 2 x"/>', ""), "'x'"),
        (LINK.format('<sphere radius="1"/>', '<material name="red"/>'), "red"),
        ('<joint name="j" type="continuous"/>', "continuous"),
        ('<joint name="j" type="fixed"/>', "without <parent>"),
        ('<material name="red"/>', "without <color>"),
        ("<link", "cannot be read as XML"),
    ],
)
def test_what_is_not_understood_is_refused_by_name(tmp_path: Path, body: str, said: str) -> None:
    path = _write(tmp_path, body)
    with pytest.raises(FileError, match=said) as caught:
        read_urdf(path)
    assert str(path) in str(caught.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"gone\.urdf"):
        read_urdf(tmp_path / "gone.urdf")
